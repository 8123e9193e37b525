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
        c.back[n] = xy - velocity * (phase - 0.5) * period + vec2(37.3, 71.9) * float(n) * F.domain.x;
        c.weight[n] = 1.0 - abs(2.0 * phase - 1.0);
    }
    return c;
}

vec2 ripple_slopes(Carried c, float speed, float pixel) {
    float wave = 2.2 * F.domain.x;
    float strength = F.water_glow.w * (0.012 + 0.05 * smoothstep(0.0, 4.0, speed / sqrt(wave)));
    vec2 drift = vec2(0.35, 0.22) * F.horizon.w * sqrt(wave), sum = vec2(0.0);
    float coarse = resolved(wave, pixel), fine = resolved(0.37 * wave, pixel);
    for (int n = 0; n < 2; ++n) {
        vec2 p = c.back[n];
        WHERE (coarse > 0.0) sum += c.weight[n] * coarse * noise_slopes((p + drift) / wave).yz;
        WHERE (fine > 0.0) sum += c.weight[n] * 0.6 * fine * noise_slopes((p - 0.7 * drift) / (0.37 * wave)).yz;
    }
    return strength * sum;
}

// Share of the surface under bubbles: patches that the flow carries, broken up where foam is thin.
float foam_cover(Carried c, float foam, float depth, float pixel) {
    foam *= smoothstep(0.08, 0.3, depth / F.domain.x); // a film does not foam
    float size = 1.4 * F.domain.x, cover = 0.0;
    WHERE (foam > 0.02) {
        float pattern = 0.0;
        for (int n = 0; n < 2; ++n) { // turned octaves: value noise alone would show its grid
            vec2 p = mat2(0.80, 0.60, -0.60, 0.80) * c.back[n], q = mat2(0.34, -0.94, 0.94, 0.34) * c.back[n];
            pattern += c.weight[n] * noise_slopes(p / size).x;
            WHERE (resolved(0.31 * size, pixel) > 0.0)
                pattern += c.weight[n] * 0.7 * resolved(0.31 * size, pixel) * noise_slopes(q / (0.31 * size)).x;
            WHERE (resolved(0.09 * size, pixel) > 0.0)
                pattern += c.weight[n] * 0.7 * resolved(0.09 * size, pixel) * noise_slopes(p / (0.09 * size)).x;
        }
        cover = smoothstep(0.02, 0.12, foam) * (0.25 + 0.65 * foam) * smoothstep(0.75 - 0.65 * foam, 1.6 - 0.65 * foam, 0.6 + 0.4 * pattern);
    }
    return 0.7 * cover;
}
