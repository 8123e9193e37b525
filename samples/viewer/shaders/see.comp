#version 450
#extension GL_GOOGLE_include_directive : require
// What the eye meets in each pixel: position and kind.
#include "frame.glsl"
#include "march.glsl"
#include "beyond.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 20, rgba32f) writeonly uniform image2D to_seen;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, F.image.xy))) return;
    vec3 eye = eye_place(), along = ray_through(vec2(pixel));
    int axis;
    vec2 span = block_span(eye, along, axis);
    bool enters = span.x < span.y, beyond = goes_on();
    // How far the land can be met: down to the block's foot, or up to its summit.
    float nearest = enters ? span.x : NEVER, deepest = along.z < 0.0 ? (F.plinth.w - eye.z) / along.z : eye.z < summit() ? NEVER : 0.0;
    vec3 place = along;
    int kind = KIND_SKY;
    float t = -1.0;
    WHERE (beyond && !(enters && span.x == 0.0)) t = meet_beyond(eye, along, 0.0, min(nearest, deepest));
    if (t < 0.0 && enters) {
        vec3 entry = eye + along * span.x;
        vec4 h = heights_at(entry.xy);
        if (axis < 2 && entry.z < max(h.x, h.y)) {
            kind = entry.z < h.x ? KIND_SOLID_WALL : KIND_WATER_WALL;
            place = entry;
            if (beyond) t = span.x; // no wall, only a rounding error before the land beyond
        } else {
            Hit hit = march(eye, along, span.x, span.y, MARCH_SOLID | MARCH_WATER, F.march_steps.x);
            if (hit.t >= 0.0) {
                kind = hit.surface == MARCH_WATER ? KIND_WATER : KIND_SOLID;
                place = eye + along * hit.t;
            }
        }
    }
    WHERE (beyond && kind == KIND_SKY && t < 0.0) t = meet_beyond(eye, along, enters ? span.y : 0.0, deepest);
    if (t >= 0.0) {
        place = eye + along * t;
        vec4 h = heights_at(on_block(place.xy));
        kind = h.y > h.x ? KIND_FAR_WATER : KIND_FAR_SOLID;
    } else if (kind == KIND_SKY && !beyond && along.z < 0.0 && eye.z > F.plinth.w) {
        kind = KIND_PLINTH;
        place = eye + along * ((F.plinth.w - eye.z) / along.z);
    }
    imageStore(to_seen, pixel, vec4(place, float(kind)));
}
