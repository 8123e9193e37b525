#version 450
// One level of the pyramid: the greatest of 2 x 2.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 1, binding = 0, r32f) readonly uniform image2D finer;
layout(set = 1, binding = 1, r32f) writeonly uniform image2D coarser;

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(c, imageSize(coarser)))) return;
    ivec2 f = 2 * c;
    float low = max(imageLoad(finer, f).x, imageLoad(finer, f + ivec2(1, 0)).x);
    float high = max(imageLoad(finer, f + ivec2(0, 1)).x, imageLoad(finer, f + ivec2(1, 1)).x);
    imageStore(coarser, c, vec4(max(low, high)));
}
