// Water: colour by the way of the light through it, sky and sun in its mirror, foam and ripples that the flow carries. It is drawn twice.
// First the light behind it is dimmed, each colour by its own share, then the water's own light is added: no copy of the screen is needed.
#include "WadiLight.hlsl"
#include "WadiFields.hlsl"
#include "WadiNoise.hlsl"

float4 _Absorption, _Glow, _FoamColour;
float _Clarity, _Ripples, _Roughness, _FoamAmount, _FoamSize, _ShoreFoam;

struct Varyings
{
    float4 pos : SV_POSITION;
    float2 at : TEXCOORD0;
    float3 world : TEXCOORD1;
};

struct Water
{
    float3 normal;  // of the scene, ripples on it
    float3 view;    // from the water to the eye
    float3 through; // share of the bed's light that comes through, by colours
    float fresnel;  // share that is mirrored
    float foam;     // share that foam hides
    float cover;    // 0 at the shore ... 1
};

Varyings WaterVertex(Vertex v)
{
    Varyings o;
    o.pos = UnityObjectToClipPos(v.vertex);
    o.at = v.vertex.xz;
    o.world = mul(unity_ObjectToWorld, v.vertex).xyz;
    return o;
}

// Patterns that the flow carries: two copies, each carried for a while and then, unseen, set back.
static const float Period = 2.0;

float2 Carried(float2 at, float2 velocity, int copy, out float weight)
{
    float phase = frac(_Time.y / Period + 0.5 * float(copy));
    weight = 1.0 - abs(2.0 * phase - 1.0);
    return at - velocity * (phase - 0.5) * Period + float2(37.3, 71.9) * float(copy) * DETAIL;
}

float2 RippleSlopes(float2 at, float2 velocity, float pixel)
{
    float wave = 4.4 * DETAIL;
    float strength = _Ripples * (0.016 + 0.05 * smoothstep(0.0, 4.0, length(velocity) / sqrt(wave)));
    float2 drift = float2(0.35, 0.22) * _Time.y * sqrt(wave), sum = 0.0;
    float coarse = Resolved(wave, pixel), fine = Resolved(0.37 * wave, pixel), finest = Resolved(0.14 * wave, pixel);
    for (int n = 0; n < 2; ++n)
    {
        float weight;
        float2 p = Carried(at, velocity, n, weight);
        sum += weight * coarse * NoiseSlopes(mul(Turned, p + drift) / wave).yz;
        sum += weight * 0.6 * fine * NoiseSlopes(mul(TurnedMore, p - 0.7 * drift) / (0.37 * wave)).yz;
        if (finest > 0.0) sum += weight * 0.35 * finest * NoiseSlopes(mul(Turned, p + 0.5 * drift) / (0.14 * wave)).yz;
    }
    return strength * sum;
}

// Share of the surface under bubbles: patches that the flow carries, broken up where foam is thin.
float FoamCover(float2 at, float2 velocity, float foam, float pixel)
{
    if (foam <= 0.02) return 0.0;
    float size = _FoamSize * DETAIL, pattern = 0.0;
    for (int n = 0; n < 2; ++n)
    {
        float weight;
        float2 p = Carried(at, velocity, n, weight);
        pattern += weight * NoiseSlopes(mul(Turned, p) / size).x;
        pattern += weight * 0.7 * Resolved(0.31 * size, pixel) * NoiseSlopes(mul(TurnedMore, p) / (0.31 * size)).x;
        pattern += weight * 0.7 * Resolved(0.09 * size, pixel) * NoiseSlopes(mul(Turned, p) / (0.09 * size)).x;
    }
    return smoothstep(0.02, 0.12, foam) * (0.25 + 0.65 * foam) * smoothstep(0.75 - 0.65 * foam, 1.6 - 0.65 * foam, 0.6 + 0.4 * pattern);
}

Water WaterAt(Varyings i)
{
    float2 at = i.at;
    float pixel = max(length(ddx(at)), length(ddy(at)));
    Surfaces s = SurfacesAt(at);
    float depth = s.level - s.ground;
    clip(depth);
    float2 velocity = BilinearAt(_WadiFlow, at).rg;
    float2 slope = s.levelSlope + RippleSlopes(at, velocity, pixel) * smoothstep(0.0, 0.5 * DETAIL, depth);
    Water w;
    w.normal = UnityObjectToWorldNormal(NormalOf(slope));
    w.view = normalize(_WorldSpaceCameraPos - i.world);
    w.cover = smoothstep(0.0, 3.0 * Film(), depth);
    float path = depth / max(dot(w.view, UnityObjectToWorldNormal(float3(0.0, 1.0, 0.0))), 0.05);
    float down = min(path, 2.0 * depth + 0.5 * path);
    w.through = exp(-_Absorption.rgb * (path + 0.35 * down) / (_Clarity * DETAIL));
    float edge = _ShoreFoam > 0.0 ? 0.6 * (1.0 - smoothstep(0.0, _ShoreFoam * CELL_SIZE, depth)) * smoothstep(0.0, 0.6, length(velocity)) : 0.0;
    float thick = smoothstep(0.08, 0.3, s.depth / CELL_SIZE); // a film does not foam
    w.foam = Shown(min(_FoamAmount * FoamCover(at, velocity, max(s.foam * thick, edge), pixel), 1.0)).x;
    w.fresnel = 0.02 + 0.98 * pow(1.0 - saturate(dot(w.normal, w.view)), 5.0);
    return w;
}

// To multiply what lies behind.
float4 DimFragment(Varyings i) : SV_Target
{
    Water w = WaterAt(i);
    return float4(lerp(float3(1.0, 1.0, 1.0), Shown(w.through * (1.0 - w.fresnel)) * (1.0 - w.foam), w.cover), 1.0);
}

// The sun's picture on small waves, after Trowbridge and Reitz.
float Glint(Water w, float3 toSun)
{
    float a = max(_Roughness * _Roughness, 0.002), toNormal = saturate(dot(w.normal, normalize(toSun + w.view)));
    float around = toNormal * toNormal * (a * a - 1.0) + 1.0;
    return 0.25 * w.fresnel * a * a / max(around * around, 1e-7) * saturate(dot(w.normal, toSun) * 8.0);
}

// To add to it.
float4 LightFragment(Varyings i) : SV_Target
{
    Water w = WaterAt(i);
    float3 toSun = ToSun(), sun = SUN_COLOUR;
    float3 own = lerp(_Glow.rgb * Shown(1.0 - w.through), _FoamColour.rgb, w.foam);
    float3 mirrored = w.fresnel * SkyMirrored(reflect(-w.view, w.normal), _Roughness) + min(Glint(w, toSun), 8.0) * sun;
    float3 light = own * (max(dot(w.normal, toSun), 0.0) * sun + SkyLight(w.normal)) + mirrored * (1.0 - w.foam);
    return float4(light * w.cover, 0.0);
}
