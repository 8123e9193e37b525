// Light that ground sends to the eye: rock, and sand from dry to soaked.
#include "sand.glsl"
#include "rock.glsl"

struct Ground {
    vec3 place, normal; // normal of the height field
    vec3 to_eye;
    float pixel;    // size of a pixel there [m]
    float sand;     // depth [m]
    float pores;    // saturation, 0.5 = full
    float wet;      // 1 where water is or has just been, less the longer it is away
    float sun, sky; // light that arrives, 0 ... 1
    float drowned;  // 1 under water
};

vec3 shade_ground(Ground g) {
    float cover = smoothstep(0.3 * F.rock.w, F.rock.w, g.sand);
    float wet = drawn(WETNESS) ? g.wet : 0.0, film = smoothstep(0.5, 1.0, wet); // what has just run dry mirrors
    float pores = max(drawn(WET_SAND) ? g.pores : 0.0, 0.45 * wet), drowned = drawn(WET_SAND) ? g.drowned : 0.0;
    float damp = mix(smoothstep(0.0, 0.22, pores), 1.0, drowned), soaked = mix(smoothstep(0.25, 0.48, pores), 1.0, drowned);
    float dry = (1.0 - damp) * cover;

    vec2 slope = -g.normal.xy / max(g.normal.z, 0.05);
    Surface sand = Surface(vec3(0.0), vec3(0.0)), rock = sand;
    WHERE (cover > 0.0) sand = sand_at(g.place, slope, g.pixel, damp, soaked);
    WHERE (cover < 1.0) {
        rock = rock_at(g.place, g.normal, g.pixel);
        rock.albedo *= mix(1.0, 0.6, max(g.drowned, damp));
    }
    vec3 albedo = mix(rock.albedo, sand.albedo, cover), small = mix(rock.slope, sand.slope, cover);
    vec3 n = normalize(g.normal - (small - dot(small, g.normal) * g.normal));

    float lambert = max(dot(n, F.sun.xyz), 0.0);
    // Dry sand scatters between its grains: the terminator is sharper and the lit side flatter than Lambert's.
    float grainy = clamp(1.9 * dot(normalize(n * vec3(1.0, 1.0, 0.45)), F.sun.xyz), 0.0, 1.0);
    float diffuse = mix(lambert, grainy, 0.4 * dry);
    vec3 sun = F.sunlight.rgb * g.sun;
    vec3 seen = albedo * (sun * diffuse + ambient_on(n, g.sky));
    seen += albedo * albedo * sun * (0.25 * (1.0 - g.sky)); // light from lit neighbours warms hollows

    float grazing = pow(1.0 - clamp(dot(g.normal, g.to_eye), 0.0, 1.0), 4.0);
    seen += F.horizon.rgb * albedo * (grazing * F.sand_wet.w * dry * g.sky);
    vec3 halfway = normalize(F.sun.xyz + g.to_eye);
    float along = max(dot(n, halfway), 0.0);
    seen += sun * albedo * (0.50 * dry * pow(along, 9.0));
    // A film of water on soaked sand or wet rock reflects like water.
    float sheen = (soaked * cover + 0.6 * film * (1.0 - cover)) * (1.0 - g.drowned);
    WHERE (sheen > 0.0) {
        float fresnel = 0.02 + 0.98 * pow(1.0 - clamp(dot(n, g.to_eye), 0.0, 1.0), 5.0);
        seen = mix(seen, sky_in(reflect(-g.to_eye, n)), sheen * 0.6 * fresnel * g.sky);
        seen += sun * (sheen * 0.35 * pow(along, 90.0));
    }
    WHERE (drawn(GLITTER) && F.sand_dry.w > 0.0 && dry > 0.0)
        seen += sun * (F.sand_dry.w * dry * lambert * glitter_on(g.place, g.normal, halfway, g.pixel));
    return seen;
}

Ground ground_at(vec3 place, vec3 to_eye, float pixel) {
    vec2 uv = texture_of(place.xy);
    vec2 slope = textureLod(slopes, uv, 0.0).xy;
    vec4 lit = textureLod(light, uv, 0.0);
    Ground g;
    g.place = place;
    g.normal = normalize(vec3(-slope, 1.0));
    g.to_eye = to_eye;
    g.pixel = pixel;
    g.sand = heights_at(place.xy).w;
    vec4 state = textureLod(matter, uv, 0.0);
    g.pores = state.x;
    g.wet = state.z;
    g.sun = drawn(SHADOWS) ? lit.x : 1.0;
    g.sky = lit.y;
    g.drowned = 0.0;
    return g;
}
