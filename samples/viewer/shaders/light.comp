#version 450
#extension GL_GOOGLE_include_directive : require
// Sun and sky that reach each cell, from the horizon that the height field makes in a direction: on a height field that is
// the whole answer, smooth in the height of the sun and free of the acne of shadow maps.
#include "frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 19, rgba16f) writeonly uniform image2D to_light;

// Greatest slope [m per m] towards `direction`, to `reach` cells away; each step is longer than the last by `growth`.
float horizon_slope(vec2 c, float height, vec2 direction, float reach, float growth) {
    float slope = -1e3;
    vec2 last = vec2(F.grid.xy - 1);
    for (float d = 1.0; d < reach; d += max(1.0, growth * d)) {
        vec2 p = c + direction * d;
        if (any(lessThan(p, vec2(0.0))) || any(greaterThan(p, last))) break;
        float h = textureLod(heights, (p + 0.5) / vec2(F.grid.xy), 0.0).x;
        slope = max(slope, (h - height) / (d * F.domain.x));
    }
    return slope;
}

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(c, F.grid.xy))) return;
    float height = texelFetch(heights, c, 0).x;

    float run = max(length(F.sun.xy), 1e-4);
    float sun_slope = F.sun.z / run;
    float reach = min((summit() - height) / (sun_slope * F.domain.x), 2.0 * float(F.grid.x + F.grid.y)) + 2.0;
    float sun = smoothstep(-F.sun.w, F.sun.w, sun_slope - horizon_slope(vec2(c), height, F.sun.xy / run, reach, 0.04));

    float sky = 0.0;
    int sectors = F.march_steps.w;
    for (int n = 0; n < sectors; ++n) {
        float angle = 6.2831853 * (float(n) + 0.25) / float(sectors);
        float slope = max(horizon_slope(vec2(c), height, vec2(cos(angle), sin(angle)), 48.0, 0.6), 0.0);
        sky += 1.0 / (1.0 + slope * slope); // 1 - sin^2: the share of this sector's light that falls on level ground
    }
    imageStore(to_light, c, vec4(sun, sky / float(sectors), 0.0, 0.0));
}
