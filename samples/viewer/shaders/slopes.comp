#version 450
#extension GL_GOOGLE_include_directive : require
// Slopes of both surfaces at cell centres, and the pyramid's base.
#include "frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 17, rgba16f) writeonly uniform image2D to_slopes;
layout(set = 0, binding = 18, r32f) writeonly uniform image2D to_pyramid;

vec4 cell(ivec2 c) { return texelFetch(heights, clamp(c, ivec2(0), F.grid.xy - 1), 0); }

// Across a shore the water is not smooth: a neighbour that is dry counts as level with this cell.
float water_beside(vec4 here, vec4 there) { return there.y > there.x ? there.y : here.y; }

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(c, pyramid_size(0)))) return;
    // Patch (a, b) lies between the centres of cells a - 1, a and b - 1, b.
    vec4 here = cell(c), west = cell(c - ivec2(1, 0)), south = cell(c - ivec2(0, 1)), corner = cell(c - ivec2(1, 1));
    vec4 top = max(max(here, west), max(south, corner));
    bool is_patch = all(lessThanEqual(c, F.grid.xy));
    imageStore(to_pyramid, c, vec4(is_patch ? max(top.x, top.y) : -1e30));
    if (any(greaterThanEqual(c, F.grid.xy))) return;

    vec4 east = cell(c + ivec2(1, 0)), north = cell(c + ivec2(0, 1));
    ivec2 low = max(c - 1, ivec2(0)), high = min(c + 1, F.grid.xy - 1);
    vec2 run = F.domain.x * vec2(max(high - low, ivec2(1)));
    vec2 solid = vec2(east.x - west.x, north.x - south.x) / run;
    vec2 water = vec2(water_beside(here, east) - water_beside(here, west), water_beside(here, north) - water_beside(here, south)) / run;
    imageStore(to_slopes, c, vec4(solid, here.y > here.x ? water : solid));
}
