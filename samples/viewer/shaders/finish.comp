#version 450
#extension GL_GOOGLE_include_directive : require
// Edges are smoothed along their direction where there is one sample a pixel; what was drawn small is enlarged; encodes for the display.
#include "frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 23, rgba16f) readonly uniform image2D colours;
layout(set = 0, binding = 24, rgba8) writeonly uniform image2D to_picture;

vec3 at(ivec2 p) { return imageLoad(colours, clamp(p, ivec2(0), F.image.xy - 1)).rgb; }
float luma(vec3 c) { return sqrt(dot(c, vec3(0.299, 0.587, 0.114))); }

vec3 smoothed(ivec2 p) {
    vec3 colour = at(p);
    if (F.view.w == 0) return colour;
    vec3 n = at(p + ivec2(0, -1)), s = at(p + ivec2(0, 1)), w = at(p + ivec2(-1, 0)), e = at(p + ivec2(1, 0));
    float lm = luma(colour), ln = luma(n), ls = luma(s), lw = luma(w), le = luma(e);
    float low = min(lm, min(min(ln, ls), min(lw, le))), high = max(lm, max(max(ln, ls), max(lw, le)));
    if (high - low <= max(0.06, 0.12 * high)) return colour;
    // Across the edge the picture jumps; blend with the neighbour on the side where it does so most.
    bool level = abs(ln + ls - 2.0 * lm) > abs(lw + le - 2.0 * lm);
    vec3 beside = level ? (abs(ln - lm) > abs(ls - lm) ? n : s) : (abs(lw - lm) > abs(le - lm) ? w : e);
    vec3 cross = 0.25 * (n + s + w + e);
    float share = clamp(abs(luma(cross) - lm) / (high - low), 0.0, 1.0);
    return mix(colour, mix(cross, beside, 0.5), 0.75 * smoothstep(0.0, 0.7, share));
}

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), size = imageSize(to_picture);
    if (any(greaterThanEqual(p, size))) return;
    vec3 colour;
    if (size == F.image.xy) {
        colour = smoothed(p);
    } else { // fewer pixels were drawn than the picture has
        vec2 place = (vec2(p) + 0.5) * vec2(F.image.xy) / vec2(size) - 0.5;
        ivec2 corner = ivec2(floor(place));
        vec2 f = place - vec2(corner);
        colour = mix(mix(smoothed(corner), smoothed(corner + ivec2(1, 0)), f.x),
                     mix(smoothed(corner + ivec2(0, 1)), smoothed(corner + ivec2(1, 1)), f.x), f.y);
    }
    vec3 encoded = mix(12.92 * colour, 1.055 * pow(max(colour, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055, greaterThan(colour, vec3(0.0031308)));
    // Half a step of noise hides the bands of 8 bits.
    uint h = uint(p.x) * 0x9E3779B1u ^ uint(p.y) * 0x85EBCA77u;
    h ^= h >> 15; h *= 0x2C1B3C6Du; h ^= h >> 13;
    imageStore(to_picture, p, vec4(encoded + (float(h >> 8) / 16777216.0 - 0.5) / 255.0, 1.0));
}
