#version 450
#extension GL_GOOGLE_include_directive : require
// One triangle over the whole picture, behind all that the depth test keeps.
#include "scene.glsl"
layout(location = 0) out vec4 far;

void main() {
    gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, 0.0, 1.0);
    far = S.from_screen * vec4(gl_Position.xy, 1.0, 1.0);
}
