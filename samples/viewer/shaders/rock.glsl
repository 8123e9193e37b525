// Rock: beds of unequal height and tone that show on cliffs, cracks on level ground.
Surface rock_at(vec3 place, vec3 normal, float pixel) {
    Surface s;
    s.albedo = F.rock.rgb;
    s.slope = vec3(0.0);
    WHERE (drawn(ROCK)) {
        float scale = max(1.0, 2.0 * F.domain.x); // maps of large cells show mountains, not stones
        vec4 lumps = rough(place, 3.4 * scale, 0.85, 0.8, pixel);
        float cliff = 1.0 - smoothstep(0.60, 0.90, normal.z);
        float beds = (place.z + 0.12 * scale * lumps.x) / (0.34 * scale), bed = beds + 0.7 * noise_slopes(vec2(0.2 * beds, 3.0)).x, within = fract(bed);
        float ledge = smoothstep(0.0, 0.12, within) * smoothstep(1.0, 0.80, within), tone = unit_of(hash_of(uvec2(ivec2(int(floor(bed)), 7))));
        float seen = resolved(0.34 * scale, pixel);
        s.slope = lumps.yzw * mix(0.14, 0.24, cliff);
        s.albedo *= mix(vec3(0.85, 0.82, 0.79), vec3(1.12, 1.08, 1.04), mix(0.5, tone, cliff * seen)) * (1.0 + mix(0.16, 0.32, cliff) * lumps.x);
        s.albedo *= mix(1.0, mix(0.66, 1.0, ledge), cliff * seen);
        float iron = smoothstep(-0.3, 0.6, noise_in_space(place / (11.0 * scale)).x + 0.35 * lumps.x);
        s.albedo *= mix(vec3(0.92, 0.93, 0.96), vec3(1.12, 0.98, 0.82), iron);
        float broken = (1.0 - cliff) * resolved(0.4 * scale, pixel) * smoothstep(-0.1, 0.6, noise_slopes(place.xy / (6.0 * scale)).x);
        WHERE (broken > 0.0) {
            float crack = from_cell_wall(place.xy / (1.7 * scale) + 0.16 * lumps.yz);
            s.albedo *= mix(1.0, 0.74 + 0.26 * smoothstep(0.0, 0.07, crack), broken);
        }
    }
    return s;
}
