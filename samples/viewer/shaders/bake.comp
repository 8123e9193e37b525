#version 450
#extension GL_GOOGLE_include_directive : require
// Gradient noise in space (K. Perlin, Improving Noise, 2002) with its derivatives, once, as an image that tiles. The slices lie behind each
// other along y of the dispatch.
#include "frame.glsl"
#include "noise.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 29, rgba16f) writeonly uniform image3D to_noise;

vec3 corner_gradient(ivec3 k) {
    uvec3 v = uvec3((k + int(NOISE_PERIOD)) % int(NOISE_PERIOD));
    uint h = hash_of(uvec2(v.x + v.z * 1664525u, v.y ^ (v.z * 22695477u)));
    return vec3(unit_of(h), unit_of(h * 747796405u + 1u), unit_of(h * 2891336453u + 7u)) * 2.0 - 1.0;
}

void main() {
    int size = imageSize(to_noise).x;
    ivec3 texel = ivec3(gl_GlobalInvocationID.x, int(gl_GlobalInvocationID.y) % size, int(gl_GlobalInvocationID.y) / size);
    vec3 p = (vec3(texel) + 0.5) * (NOISE_PERIOD / float(size)), base = floor(p), f = p - base;
    vec3 u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0), du = 30.0 * f * f * (f * (f - 2.0) + 1.0);
    vec4 sum = vec4(0.0);
    for (int corner = 0; corner < 8; ++corner) {
        ivec3 c = ivec3(corner & 1, (corner >> 1) & 1, corner >> 2);
        vec3 high = vec3(c), g = corner_gradient(ivec3(base) + c);
        vec3 w = mix(1.0 - u, u, high), dw = mix(-du, du, high); // weight along each axis and its derivative
        float value = dot(g, f - high), weight = w.x * w.y * w.z;
        sum += vec4(value * weight, g * weight + value * vec3(dw.x * w.y * w.z, w.x * dw.y * w.z, w.x * w.y * dw.z));
    }
    imageStore(to_noise, texel, sum);
}
