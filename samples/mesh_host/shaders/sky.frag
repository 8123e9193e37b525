#version 450
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"
layout(location = 0) in vec4 far;
layout(location = 0) out vec4 colour;

void main() {
    vec3 along = normalize(far.xyz / far.w - S.eye.xyz);
    if (along.z < -0.06) discard; // ground has to be there: where it is not, the loud background shows the hole
    colour = shown(sky(along) + SUNLIGHT * 20.0 * smoothstep(0.9993, 0.9997, dot(along, S.sun.xyz)), along, 1.0);
}
