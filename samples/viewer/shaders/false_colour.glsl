// Quantities as colours, arrows and lines drawn on the ground.
vec3 ramp(float x) {
    x = clamp(x, 0.0, 1.0);
    vec3 a = vec3(0.05, 0.03, 0.30), b = vec3(0.05, 0.30, 0.62), c = vec3(0.10, 0.60, 0.42), d = vec3(0.85, 0.72, 0.12), e = vec3(0.80, 0.10, 0.05);
    float y = 4.0 * x;
    return y < 1.0 ? mix(a, b, y) : y < 2.0 ? mix(b, c, y - 1.0) : y < 3.0 ? mix(c, d, y - 2.0) : mix(d, e, y - 3.0);
}

// The numbers are those of the list in look.cpp.
float quantity_at(int view, vec2 xy) {
    vec2 uv = texture_of(xy);
    vec4 h = heights_at(xy), m = textureLod(matter, uv, 0.0), v = textureLod(flow, uv, 0.0);
    float depth = max(h.y - h.x, 0.0);
    if (view == 1) return depth;
    if (view == 2) return depth > 0.0 ? length(v.xy) : 0.0;
    if (view == 3) return m.x;
    if (view == 4) return depth > 0.0 ? length(v.xy) / sqrt(9.81 * max(depth, 1e-3)) : 0.0;
    if (view == 5) return h.w;
    if (view == 6) return length(v.zw);
    if (view == 7) return m.y;
    if (view == 8) return max(h.x, h.y);
    if (view == 9) return textureLod(light, uv, 0.0).y;
    if (view == 10) return length(textureLod(slopes, uv, 0.0).xy);
    return h.z;
}

float stroke(vec2 xy, vec2 a, vec2 b, float half_width, float pixel) {
    vec2 d = b - a, p = xy - a;
    float along = clamp(dot(p, d) / max(dot(d, d), 1e-12), 0.0, 1.0);
    return 1.0 - smoothstep(half_width - 0.7 * pixel, half_width + 0.7 * pixel, length(p - d * along));
}

// Arrows of the water's velocity, where there is water, else of the sand's.
float arrow_cover(vec2 xy, float pixel) {
    float spacing = F.range.z;
    vec2 middle = (floor(xy / spacing) + 0.5) * spacing;
    vec4 v = textureLod(flow, texture_of(middle), 0.0), h = heights_at(middle);
    vec2 shown = (h.y > h.x ? v.xy : v.zw) * F.range.w;
    float size = length(shown);
    if (size < 0.02 * spacing) return 0.0;
    shown *= min(1.0, 0.92 * spacing / size);
    size = length(shown);
    vec2 tip = middle + 0.5 * shown, unit = shown / size, side = vec2(-unit.y, unit.x);
    float head = 0.3 * size, width = max(0.03 * spacing, 0.7 * pixel);
    return max(stroke(xy, middle - 0.5 * shown, tip, width, pixel),
               max(stroke(xy, tip, tip - head * (unit + 0.6 * side), width, pixel), stroke(xy, tip, tip - head * (unit - 0.6 * side), width, pixel)));
}

vec3 draw_marks(vec3 colour, vec2 xy, float pixel) {
    if (F.view.y != 0) colour = mix(colour, vec3(0.95), arrow_cover(xy, pixel));
    if (F.view.z != 0) colour = mix(colour, vec3(0.9, 0.05, 0.02), stroke(xy, F.section.xy, F.section.zw, 1.2 * pixel, pixel));
    return colour;
}
