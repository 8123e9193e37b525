// Rock and sand: sand from dry to soaked, rock where none lies, cliffs where rock is steep.
#include "WadiLight.hlsl"
#include "WadiFields.hlsl"
#include "WadiNoise.hlsl"

float4 _SandDry, _SandWet, _Rock, _Cliff;
float _SandCover, _DampFrom, _SoakedFrom, _Ripples, _Glitter, _CliffBelow, _CliffAbove, _Strata, _Hollows, _Caustics;

static const float Around = 6.2831853;

struct Varyings
{
    float4 pos : SV_POSITION;
    float3 place : TEXCOORD0; // x, y: metres to the east and north; z: elevation
    float3 world : TEXCOORD1;
    float openSky : TEXCOORD2;
    WADI_SHADOW_COORDS(3)
};

// Share of the sky that a cell sees, from the horizon in eight directions.
float SkyShare(float2 place, float ground)
{
    float share = 0.0;
    float2 q = ClampedCell(place);
    for (int n = 0; n < 8; ++n)
    {
        float angle = Around * (float(n) + 0.25) / 8.0, slope = 0.0;
        float2 along = float2(cos(angle), sin(angle));
        for (float reach = 1.5; reach < 16.0; reach *= 2.0)
        {
            float4 there = _WadiSurface.Load(Inside(int2(round(q + along * reach))));
            slope = max(slope, (there.r - there.g - ground) / (reach * CELL_SIZE));
        }
        share += 1.0 / (1.0 + slope * slope);
    }
    return share / 8.0;
}

Varyings GroundVertex(Vertex v)
{
    Varyings o;
    o.pos = UnityObjectToClipPos(v.vertex);
    o.place = v.vertex.xzy;
    o.world = mul(unity_ObjectToWorld, v.vertex).xyz;
    o.openSky = lerp(1.0, SkyShare(v.vertex.xz, v.vertex.y), _Hollows);
    WADI_TRANSFER_SHADOW(o)
    return o;
}

// Wind ripples and grains, as slopes to add to those of the ground.
float2 SandRelief(float2 at, float2 slope, float pixel, float dry)
{
    float2 sum = 0.0;
    float wave = 0.45 * DETAIL;
    float seen = Resolved(wave, pixel) * dry * _Ripples;
    if (seen > 0.0)
    {
        float2 q = at / wave + 1.6 * NoiseSlopes(at / (wave * 9.0)).yz;
        float steep = saturate(1.0 - 1.2 * length(slope)); // they do not stand on slopes that slide
        float patchy = 0.55 + 0.45 * NoiseSlopes(mul(Turned, at) / (wave * 23.0)).x;
        sum += float2(0.92, 0.39) * (cos(Around * dot(q, float2(0.92, 0.39))) * 0.15 * seen * steep * patchy);
    }
    float lumps = 2.1 * DETAIL;
    sum += NoiseSlopes(mul(Turned, at) / lumps).yz * (0.035 * Resolved(lumps, pixel));
    float grains = 0.16 * DETAIL;
    seen = Resolved(grains, pixel);
    if (seen > 0.0) sum += NoiseSlopes(at / grains).yz * (0.10 * seen);
    return sum;
}

float2 RockRelief(float2 at, float ground, float pixel)
{
    float2 sum = 0.0;
    float size = 4.3 * DETAIL;
    for (int octave = 0; octave < 4; ++octave)
    {
        float2x2 turn = octave % 2 == 0 ? Turned : TurnedMore;
        float seen = Resolved(size, pixel);
        if (seen > 0.0) sum += mul(NoiseSlopes(mul(turn, at) / size + ground / size * 0.4).yz, turn) * (0.085 * seen);
        size *= 0.41;
    }
    return sum;
}

float3 RockColour(float2 at, float ground, float upward, float pixel)
{
    float layer = 1.4 * DETAIL;
    float bands = Resolved(layer, pixel) * NoiseSlopes(float2(ground / layer, (at.x + at.y) * 0.02 / layer)).x;
    bands += 0.5 * Resolved(0.3 * layer, pixel) * NoiseSlopes(float2(ground / (0.3 * layer), (at.x - at.y) * 0.03 / layer)).x;
    float spots = NoiseSlopes(mul(Turned, at) / (7.0 * DETAIL)).x + 0.6 * NoiseSlopes(mul(TurnedMore, at) / (2.3 * DETAIL)).x;
    spots += 0.8 * Resolved(0.7 * DETAIL, pixel) * NoiseSlopes(mul(Turned, at) / (0.7 * DETAIL)).x;
    float3 cliff = _Cliff.rgb * Shown(1.0 + _Strata * bands), rock = _Rock.rgb * Shown(1.0 + 0.12 * spots);
    return lerp(cliff, rock, smoothstep(_CliffBelow, _CliffAbove, upward));
}

// Bright lines where waves gather the sun, on beds under shallow water.
float CausticLight(float2 at, float depth, float pixel)
{
    float wave = 3.0 * DETAIL;
    float seen = Resolved(wave, pixel);
    if (seen <= 0.0) return 0.0;
    float sum = 0.0;
    for (int n = 0; n < 2; ++n)
    {
        float2 drift = (n == 0 ? float2(0.31, 0.17) : float2(-0.23, 0.29)) * _Time.y * sqrt(wave);
        float2 p = mul(n == 0 ? Turned : TurnedMore, at + drift) / wave;
        p += 0.35 * NoiseSlopes(p * 1.7 + 3.1).yz;
        float ridge = 1.0 - abs(NoiseSlopes(p).x);
        sum += ridge * ridge * ridge * ridge;
    }
    float shallow = smoothstep(0.0, 0.6 * DETAIL, depth) * exp(-depth / (9.0 * DETAIL));
    return seen * shallow * (sum - 0.35);
}

// Grains that mirror the light towards the eye: a normal of its own per grain, grains as large as a pixel at least.
float GlitterOf(float3 place, float3 normal, float3 halfway, float pixel)
{
    float size = exp2(ceil(log2(max(pixel, 0.01 * DETAIL))));
    int3 k = int3(floor(place / size));
    uint h = HashOf(uint2(k.xy) + uint(k.z) * 7919u);
    float3 grain = float3(UnitOf(h), UnitOf(h * 747796405u + 1u), UnitOf(h * 2891336453u + 7u)) * 2.0 - 1.0;
    return smoothstep(0.994, 1.0, dot(normalize(normal + 0.9 * grain), halfway));
}

float4 GroundFragment(Varyings i) : SV_Target
{
    float2 at = i.place.xy;
    float2 dx = ddx(at), dy = ddy(at);
    float pixel = max(length(dx), length(dy));
    Surfaces s = SurfacesAt(at);
    float sand = BilinearAt(_WadiSand, at).r;
    float3 flatNormal = NormalOf(s.groundSlope);
    float drowned = smoothstep(0.0, 3.0 * Film(), s.level - s.ground);
    float cover = smoothstep(0.3 * _SandCover * CELL_SIZE, _SandCover * CELL_SIZE, sand);
    float damp = lerp(smoothstep(0.0, _DampFrom, s.saturation), 1.0, drowned);
    float soaked = lerp(smoothstep(min(_DampFrom + 0.03, _SoakedFrom - 0.01), _SoakedFrom, s.saturation), 1.0, drowned);
    float dry = (1.0 - damp) * cover;

    float2 relief = 0.0;
    if (cover > 0.0) relief += SandRelief(at, s.groundSlope, pixel, dry + 0.25 * drowned * cover) * cover * (1.0 - 0.5 * soaked);
    if (cover < 1.0) relief += RockRelief(at, s.ground, pixel) * (1.0 - cover);
    float3 normal = UnityObjectToWorldNormal(normalize(flatNormal - float3(relief.x, 0.0, relief.y) * flatNormal.y));

    float3 dampSand = lerp(_SandDry.rgb, _SandWet.rgb, 0.62);
    float3 albedo = lerp(lerp(_SandDry.rgb, dampSand, damp), _SandWet.rgb, soaked);
    albedo *= Shown(1.0 + 0.05 * NoiseSlopes(at / (2.3 * DETAIL)).x + 0.05 * NoiseSlopes(mul(Turned, at) / (11.0 * DETAIL)).x);
    if (cover < 1.0)
    {
        float3 bare = RockColour(at, s.ground, flatNormal.y, pixel) * Shown(lerp(1.0, 0.62, max(drowned, 0.7 * damp)));
        albedo = lerp(bare, albedo, cover);
    }
    albedo *= Shown(1.0 + _Caustics * drowned * CausticLight(at, s.level - s.ground, pixel));

    // Dry sand scatters between its grains: the terminator is sharper and the lit side flatter than Lambert's.
    float3 toSun = ToSun(), up = UnityObjectToWorldNormal(float3(0.0, 1.0, 0.0));
    float lambert = max(dot(normal, toSun), 0.0);
    float grainy = saturate(1.9 * dot(normalize(normal - 0.55 * dot(normal, up) * up), toSun));
    float3 halfway = normalize(toSun + normalize(_WorldSpaceCameraPos - i.world));
    float along = max(dot(normal, halfway), 0.0), sheen = soaked * cover * (1.0 - drowned);
    float mirror = 0.05 * dry * pow(along, 24.0) + 0.25 * sheen * pow(along, 90.0);
    if (_Glitter > 0.0 && dry > 0.0)
    {
        float fine = min(length(dx), length(dy));
        float near = 1.0 - smoothstep(0.1 * DETAIL, 0.5 * DETAIL, fine);
        mirror += _Glitter * dry * lambert * 0.5 * near * GlitterOf(float3(at, s.ground), normal, halfway, fine);
    }
    float3 sun = SUN_COLOUR * WADI_SHADOW(i) * lerp(1.0, i.openSky, 0.1);
    return float4(albedo * (lerp(lambert, grainy, 0.4 * dry) * sun + SkyLight(normal) * i.openSky) + mirror * sun, 1.0);
}
