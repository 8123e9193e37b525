#version 450
// The greatest height of all: of the pyramid's coarsest level.
layout(local_size_x = 1) in;
layout(set = 1, binding = 0, r32f) readonly uniform image2D coarsest;
layout(set = 1, binding = 1, r32f) writeonly uniform image2D summit;

void main() {
    float highest = -1e30;
    ivec2 size = imageSize(coarsest);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) highest = max(highest, imageLoad(coarsest, ivec2(x, y)).x);
    }
    imageStore(summit, ivec2(0), vec4(highest + 1e-4 * abs(highest) + 1e-3));
}
