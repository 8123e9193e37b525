// Ripples and foam that the flow carries: two copies of a pattern, each carried for a while and then, unseen, set back.
struct Carried {
    vec2 back[2];    // where the pattern came from [m]
    float weight[2];
};
Carried carried_at(vec2 xy, vec2 velocity) {
    float period = 2.0;
    Carried c;
    for (int n = 0; n < 2; ++n) {
        float phase = fract(F.horizon.w / period + 0.5 * float(n));
        c.back[n] = xy - (drawn(FLOW_MAP) ? velocity : vec2(0.0)) * ((phase - 0.5) * period) + vec2(37.3, 71.9) * float(n);
        c.weight[n] = 1.0 - abs(2.0 * phase - 1.0);
    }
    return c;
}

vec2 ripple_slopes(Carried c, float speed, float pixel) {
    float wave = max(0.55, 0.4 * F.domain.x); // [m]
    float strength = F.water_glow.w * (0.012 + 0.05 * smoothstep(0.0, 4.0, speed / sqrt(wave)));
    vec2 drift = vec2(0.35, 0.22) * F.horizon.w * sqrt(wave), sum = vec2(0.0);
    float coarse = resolved(wave, pixel), fine = resolved(0.37 * wave, pixel);
    for (int n = 0; n < 2 && drawn(SMALL_WAVES); ++n) {
        vec2 p = c.back[n];
        WHERE (coarse > 0.0) sum += c.weight[n] * coarse * noise_slopes((p + drift) / wave).yz;
        WHERE (fine > 0.0) sum += c.weight[n] * 0.6 * fine * noise_slopes((p - 0.7 * drift) / (0.37 * wave)).yz;
    }
    return strength * sum;
}

// Share of the surface under bubbles: a net that the flow carries, whose meshes of 62, 21 and 7 cm close as there is more foam.
float foam_cover(Carried c, float foam, float depth, float pixel) {
    if (F.features.y == 0) foam *= smoothstep(0.0, 0.04, depth); // a film does not foam
    float cover = 0.0, tone = 0.0, scale = max(1.0, 1.5 * F.domain.x);
    WHERE (drawn(FOAM) && foam > 0.01) {
        float net = 0.0;
        vec3 mesh = vec3(0.62, 0.21, 0.07) * scale, seen = vec3(resolved(mesh.x, pixel), resolved(mesh.y, pixel), resolved(mesh.z, pixel));
        for (int n = 0; n < 2; ++n) {
            vec4 bend = noise_in_space(vec3(c.back[n] / (0.9 * scale), 0.0)), ruffle = noise_in_space(vec3(c.back[n] / (0.23 * scale), 4.0));
            vec2 p = c.back[n] + scale * (0.22 * bend.yz + 0.05 * ruffle.yz);
            vec3 wall = vec3(0.4);
            WHERE (seen.x > 0.0) wall.x = mix(0.4, 1.0 - smoothstep(0.0, 0.30, from_cell_wall(p / mesh.x)), seen.x);
            WHERE (seen.y > 0.0) wall.y = mix(0.4, 1.0 - smoothstep(0.0, 0.36, from_cell_wall(p / mesh.y + 9.0)), seen.y);
            WHERE (seen.z > 0.0) wall.z = mix(0.4, 1.0 - smoothstep(0.0, 0.42, from_cell_wall(p / mesh.z)), seen.z);
            float patchy = noise_slopes(c.back[n] / (4.0 * scale)).x;
            net += c.weight[n] * (0.22 * patchy + dot(wall, vec3(0.46, 0.30, 0.16)) + 0.40 * bend.x + 0.12 * ruffle.x);
        }
        tone = clamp(0.55 + 0.9 * (net - 0.35), 0.0, 1.0);
        float amount = 0.86 * pow(clamp(1.25 * foam, 0.0, 1.0), 0.75); // a full cover has small holes, too
        cover = smoothstep(0.92 - 0.95 * amount, 1.22 - 0.95 * amount, net + 0.22);
    }
    return cover * (0.50 + 0.46 * tone);
}

// Sunlight that waves gather into a net on the bed below so much water [m]: 1 on average.
float caustics_at(vec2 xy, float down, float pixel) {
    float seen = resolved(0.5, pixel) * smoothstep(0.02, 0.25, down) * exp(-0.5 * down), light = 1.0;
    WHERE (drawn(CAUSTICS) && seen > 0.0) {
        float time = F.horizon.w;
        vec2 p = xy + 0.20 * noise_in_space(vec3(xy / 1.1, 0.35 * time)).yz;
        float one = clamp(1.5 * from_cell_wall(p / 0.75 + 0.11 * time), 0.0, 1.0);
        float other = clamp(1.5 * from_cell_wall(mat2(0.8, 0.6, -0.6, 0.8) * p / 0.47 - 0.13 * time), 0.0, 1.0);
        light = mix(1.0, 0.72 + 0.75 * (pow(1.0 - one, 3.0) + pow(1.0 - other, 3.0)), seen);
    }
    return light;
}

// What silt takes from light on a metre of its way through water so deep, as grains of 0.08 mm do: 1.5 m2 of shadow per 0.21 kg of them.
vec3 mud_in(float silt, float depth) {
    return drawn(MUD) ? vec3(4.8, 7.0, 10.9) * (silt / max(depth, 3.0 * F.water.w)) : vec3(0.0);
}
