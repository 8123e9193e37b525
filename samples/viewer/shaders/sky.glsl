// Sky without clouds, and light of the sky on a surface.
vec3 sky_in(vec3 along) {
    float up = clamp(along.z, 0.0, 1.0);
    vec3 sky = mix(F.horizon.rgb, F.zenith.rgb, 1.0 - pow(1.0 - up, 3.5));
    float to_sun = clamp(dot(along, F.sun.xyz), 0.0, 1.0);
    return sky + F.sunlight.rgb * (0.03 * pow(to_sun, 12.0) + 0.12 * pow(to_sun, 160.0));
}
vec3 sun_disc(vec3 along) { return F.sunlight.rgb * 20.0 * smoothstep(0.9993, 0.9997, dot(along, F.sun.xyz)); }

// Light of sky and surroundings on a surface of this normal, per unit of albedo.
vec3 ambient_on(vec3 normal, float open) {
    vec3 above = 0.5 * (F.zenith.rgb + F.horizon.rgb);
    vec3 below = 0.35 * F.plinth.rgb * (F.sunlight.rgb * F.sun.z * 0.4 + above);
    return F.zenith.w * mix(below, above, 0.5 + 0.5 * normal.z) * open;
}
