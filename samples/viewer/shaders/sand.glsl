// Sand: colour and small slopes, from grains of 2 mm to lumps of a metre. What a pixel cannot show is left out, not aliased.
struct Surface {
    vec3 albedo;
    vec3 slope; // of small shapes, along x, y, z
};

// Crests that wind makes, 13 cm apart: on dry sand that does not slide, here and there.
vec2 wind_ripples(vec3 place, vec2 slope, float pixel, float dry) {
    float wave = 0.13;
    vec2 sum = vec2(0.0), across = vec2(0.92, 0.39);
    float seen = resolved(wave, pixel) * dry;
    WHERE (seen > 0.0) {
        vec2 bend = noise_slopes(place.xy / 2.7).yz;
        float phase = 6.2831853 * (dot(place.xy, across) / wave + 1.1 * dot(bend, vec2(0.4, 0.9)));
        float patchy = smoothstep(-0.2, 0.5, noise_slopes(place.xy / 3.9).x) * clamp(1.0 - 2.2 * length(slope), 0.0, 1.0);
        sum = across * ((sin(phase) + 0.35 * sin(2.0 * phase + 0.6)) * 0.10 * seen * patchy);
    }
    return sum;
}

// damp, soaked: 0 ... 1.
Surface sand_at(vec3 place, vec2 slope, float pixel, float damp, float soaked) {
    Surface s;
    vec3 damp_sand = mix(F.sand_dry.rgb, F.sand_wet.rgb, 0.55);
    s.albedo = mix(mix(F.sand_dry.rgb, damp_sand, damp), F.sand_wet.rgb, soaked);
    s.slope = vec3(0.0);
    WHERE (drawn(GRAIN)) {
        vec4 lumps = rough(place, max(1.3, 2.0 * F.domain.x), 0.92, 0.0, pixel), grit = rough(place, 0.012, 0.9, 0.0, pixel);
        s.slope = lumps.yzw * (mix(0.09, 0.05, soaked) * (1.0 + 0.8 * damp * (1.0 - soaked))) + grit.yzw * (0.20 * (1.0 - 0.5 * soaked));
        s.albedo *= 1.0 + 0.14 * lumps.x + 0.28 * grit.x;
        // Layers of darker grains show where sand is damp.
        float mineral = smoothstep(0.35, 0.75, noise_slopes(vec2(place.x / 5.0, place.z * 9.0 + place.y / 1.7)).x);
        s.albedo *= mix(vec3(1.0), vec3(0.82, 0.82, 0.86), 0.5 * mineral * damp);
    }
    WHERE (drawn(WIND_RIPPLES)) s.slope.xy += wind_ripples(place, slope, pixel, 1.0 - damp);
    return s;
}

// Grains that mirror the sun towards the eye: a random normal per grain, grains of 2 mm or as large as a pixel, fewer per pixel there.
float glitter_on(vec3 place, vec3 normal, vec3 halfway, float pixel) {
    float grain_size = 0.002, size = grain_size * exp2(max(ceil(log2(pixel / grain_size)), 0.0));
    uvec3 k = uvec3(ivec3(floor(place / size)));
    uint h = hash_of(k.xy + k.z * 7919u);
    vec3 grain = vec3(unit_of(h), unit_of(h * 747796405u + 1u), unit_of(h * 2891336453u + 7u)) * 2.0 - 1.0;
    float facing = dot(normalize(normal + 0.9 * grain), halfway);
    return smoothstep(0.994, 1.0, facing) * min(1.0, 10.0 * grain_size * grain_size / (pixel * pixel));
}
