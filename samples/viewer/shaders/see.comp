#version 450
#extension GL_GOOGLE_include_directive : require
// What the eye meets in each pixel: position and kind.
#include "frame.glsl"
#include "march.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 20, rgba32f) writeonly uniform image2D to_seen;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, F.image.xy))) return;
    vec3 along = ray_through(vec2(pixel));
    vec3 place = along;
    int kind = KIND_SKY;
    if (along.z < 0.0 && F.eye.z > F.plinth.w) {
        kind = KIND_PLINTH;
        place = F.eye.xyz + along * ((F.plinth.w - F.eye.z) / along.z);
    }
    int axis;
    vec2 span = block_span(F.eye.xyz, along, axis);
    if (span.x < span.y) {
        vec3 entry = F.eye.xyz + along * span.x;
        vec4 h = heights_at(entry.xy);
        if (axis < 2 && entry.z < max(h.x, h.y)) {
            kind = entry.z < h.x ? KIND_SOLID_WALL : KIND_WATER_WALL;
            place = entry;
        } else {
            Hit hit = march(F.eye.xyz, along, span.x, span.y, MARCH_SOLID | MARCH_WATER, F.march_steps.x);
            if (hit.t >= 0.0) {
                kind = hit.surface == MARCH_WATER ? KIND_WATER : KIND_SOLID;
                place = F.eye.xyz + along * hit.t;
            }
        }
    }
    imageStore(to_seen, pixel, vec4(place, float(kind)));
}
