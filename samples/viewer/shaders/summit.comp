#version 450
#extension GL_GOOGLE_include_directive : require
// The greatest height of all: of the pyramid's coarsest level.
#include "frame.glsl"
layout(local_size_x = 1) in;
layout(set = 0, binding = 26, r32f) writeonly uniform image2D to_summit;

void main() {
    float highest = -1e30;
    int coarsest = F.grid.z - 1;
    ivec2 size = pyramid_size(coarsest);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) highest = max(highest, texelFetch(pyramid, pyramid_texel(ivec2(x, y), coarsest), 0).x);
    }
    imageStore(to_summit, ivec2(0), vec4(highest + 1e-4 * abs(highest) + 1e-3));
}
