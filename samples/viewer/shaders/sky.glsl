// Sky, haze, and light of the sky on a surface.
float clouds_in(vec3 along) {
    vec2 p = along.xy / (along.z + 0.12) * 1.3 + vec2(3.1, 1.7) + 0.004 * F.horizon.w;
    float sum = 0.0, share = 0.5;
    for (int n = 0; n < 5; ++n) {
        sum += share * noise_slopes(p + 0.3 * sum).x;
        p = mat2(0.8, 0.6, -0.6, 0.8) * p * 2.1 + 4.0;
        share *= 0.52;
    }
    return smoothstep(0.05, 0.60, sum) * smoothstep(0.02, 0.25, along.z);
}

vec3 sky_in(vec3 along) {
    float up = clamp(along.z, 0.0, 1.0);
    vec3 sky = mix(F.horizon.rgb, F.zenith.rgb, 1.0 - pow(1.0 - up, 3.5));
    WHERE (drawn(CLOUDS) && along.z > 0.02) sky = mix(sky, 0.40 * F.sunlight.rgb + 0.10, 0.75 * clouds_in(along));
    float to_sun = clamp(dot(along, F.sun.xyz), 0.0, 1.0);
    return sky + F.sunlight.rgb * (0.03 * pow(to_sun, 12.0) + 0.12 * pow(to_sun, 160.0));
}
vec3 sun_disc(vec3 along) { return F.sunlight.rgb * 20.0 * smoothstep(0.9993, 0.9997, dot(along, F.sun.xyz)); }

// What the air between the eye and a place so far away [m] leaves of its colour: at twelve lengths of the block two thirds are gone.
vec3 through_air(vec3 colour, vec3 along, float away) {
    float lengths = away / (12.0 * max(F.domain.y, F.domain.z));
    float left = drawn(HAZE) ? exp(-pow(lengths, 1.3)) : 1.0;
    return mix(sky_in(normalize(vec3(along.xy, 0.02))), colour, left);
}

// Light of sky and surroundings on a surface of this normal, per unit of albedo.
vec3 ambient_on(vec3 normal, float open) {
    vec3 above = 0.5 * (F.zenith.rgb + F.horizon.rgb);
    vec3 below = 0.35 * F.plinth.rgb * (F.sunlight.rgb * F.sun.z * 0.4 + above);
    return F.zenith.w * mix(below, above, 0.5 + 0.5 * normal.z) * open;
}
