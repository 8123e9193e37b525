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
        if (coarse > 0.0) sum += c.weight[n] * coarse * noise_slopes((p + drift) / wave).yz;
        if (fine > 0.0) sum += c.weight[n] * 0.6 * fine * noise_slopes((p - 0.7 * drift) / (0.37 * wave)).yz;
    }
    return strength * sum;
}

// Share of the surface under bubbles.
float foam_cover(Carried c, float foam, float pixel) {
    if (foam <= 0.02) return 0.0;
    float size = 1.5 * F.domain.x, pattern = 0.0;
    for (int n = 0; n < 2; ++n)
        pattern += c.weight[n] * (noise_slopes(c.back[n] / size).x + 0.6 * noise_slopes(c.back[n] / (0.3 * size)).x * resolved(0.3 * size, pixel));
    return 0.85 * smoothstep(0.45 - 0.55 * foam, 1.15 - 0.55 * foam, 0.5 + 0.45 * pattern);
}
