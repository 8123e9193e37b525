#version 450
#extension GL_GOOGLE_include_directive : require
// One level of the pyramid: the greatest of 2 x 2 of the level before.
#include "frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 18, r32f) uniform image2D levels;
layout(push_constant) uniform Push { int level; };

float finer(ivec2 block) { return imageLoad(levels, pyramid_texel(block, level - 1)).x; }

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(c, pyramid_size(level)))) return;
    ivec2 f = 2 * c;
    float low = max(finer(f), finer(f + ivec2(1, 0))), high = max(finer(f + ivec2(0, 1)), finer(f + ivec2(1, 1)));
    imageStore(levels, pyramid_texel(c, level), vec4(max(low, high)));
}
