#version 450
#extension GL_GOOGLE_include_directive : require
// A vertex of ground or water: one mesh of SIDE x SIDE quads, drawn once for each chunk (mesh.hpp).
#include "scene.glsl"
layout(constant_id = 0) const bool WATER = false;
layout(constant_id = 1) const int SIDE = 32;
layout(location = 0) out vec3 place; // [m]

vec2 on_grid(ivec2 v, float far) { // in cells; Mesh::on_grid has the same
    vec2 last = vec2(S.grid.xy - 1), at = mix(min(vec2(v), last), last + far, greaterThan(v, ivec2(S.grid.z)));
    return mix(at, vec2(-far), lessThan(v, ivec2(0)));
}

// A dry vertex beside water carries the water's level on below its own ground, so that the two surfaces cross between vertices and the
// depth test draws the shore pixel by pixel. Elsewhere dry water hides a little below the ground.
float height(ivec2 v, int spacing) {
    v = inside(v);
    float ground = cell(GROUND, v), depth = cell(DEPTH, v), film = 0.004 * S.sun.w, level = 0.0, wet = 0.0;
    if (!WATER) return ground;
    if (depth > film) return ground + depth;
    for (int n = 0; n < 4; ++n) {
        ivec2 beside = v + spacing * ivec2((n & 1) * (n - 2), (1 - (n & 1)) * (n - 1));
        float water = cell(DEPTH, beside);
        level += water > film ? cell(GROUND, beside) + water : 0.0;
        wet += water > film ? 1.0 : 0.0;
    }
    return min(ground - 0.05 * S.sun.w, wet > 0.0 ? level / wet : ground);
}

void main() {
    ivec4 chunk = chunks[gl_InstanceIndex];
    int spacing = 1 << chunk.z;
    ivec2 v = chunk.xy + ivec2(gl_VertexIndex % (SIDE + 1), gl_VertexIndex / (SIDE + 1)) * spacing, even = v - (v & spacing);
    // With the distance a chunk becomes the next coarser grid: odd vertices move onto even ones. Where a neighbour of twice the spacing
    // begins, both have the same vertices in every bit: no cracks, and no jump when the eye moves on.
    vec2 off = abs(on_grid(v, 1.0) - S.lod.xy);
    float away = max(max(off.x, off.y), S.lod.z) / (S.lod.w * float(spacing)), morph = clamp((away - 0.75) / 0.24, 0.0, 1.0);
    vec2 at = mix(on_grid(v, 64.0 * float(S.grid.w)), on_grid(even, 64.0 * float(S.grid.w)), morph);
    place = vec3((at + 0.5) * S.sun.w, mix(height(v, spacing), height(even, 2 * spacing), morph));
    gl_Position = S.to_screen * vec4(place, 1.0);
}
