#version 450
#extension GL_GOOGLE_include_directive : require
// From the plugin's outputs to what is drawn: 3 x 3 Gaussian of the heights, a water surface that ends inside the shore.
#include "frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, set = 0, binding = 7) readonly buffer SandSurface { float sand_surface[]; };
layout(std430, set = 0, binding = 8) readonly buffer SandDepth { float sand_depth[]; };
layout(std430, set = 0, binding = 9) readonly buffer WaterDepth { float water_depth[]; };
layout(std430, set = 0, binding = 10) readonly buffer Saturation { float saturation[]; };
layout(std430, set = 0, binding = 11) readonly buffer Foam { float foam[]; };
layout(std430, set = 0, binding = 12) readonly buffer Flow { float water_velocity[]; };
layout(std430, set = 0, binding = 13) readonly buffer SandVelocity { float sand_velocity[]; };
layout(std430, set = 0, binding = 30) readonly buffer Wetness { float wetness[]; };
layout(std430, set = 0, binding = 31) readonly buffer Silt { float silt[]; };
layout(std430, set = 0, binding = 27) readonly buffer HostField { float host_field[]; };
layout(set = 0, binding = 14, rgba32f) writeonly uniform image2D to_heights;
layout(set = 0, binding = 15, rgba16f) writeonly uniform image2D to_matter;
layout(set = 0, binding = 16, rgba16f) writeonly uniform image2D to_flow;

int at(int source, ivec2 c, int floats) { return F.source[source].x + c.y * F.source[source].y + c.x * floats; }

// With effect foam the output is that which drifts and lies ashore. Else it is that of fast water and of breaking fronts. A wide,
// even, fast sheet would be white all over by the first: it keeps a share, and a front, where the water runs together, all of it.
float seen_foam(ivec2 c, float depth) {
    if (F.features.y != 0) return foam[at(4, c, 1)];
    ivec2 low = max(c - 1, ivec2(0)), high = min(c + 1, F.grid.xy - 1);
    vec2 run = F.domain.x * vec2(max(high - low, ivec2(1)));
    float divergence = (water_velocity[at(5, ivec2(high.x, c.y), 2)] - water_velocity[at(5, ivec2(low.x, c.y), 2)]) / run.x +
                       (water_velocity[at(5, ivec2(c.x, high.y), 2) + 1] - water_velocity[at(5, ivec2(c.x, low.y), 2) + 1]) / run.y;
    float rising = -divergence * sqrt(depth / 9.81);
    float breaking = clamp((rising - 0.1) / 0.4, 0.0, 1.0) * clamp(10.0 * depth / F.domain.x, 0.0, 1.0);
    return max(breaking, 0.28 * foam[at(4, c, 1)]);
}

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(c, F.grid.xy))) return;
    float film = F.water.w;
    float solid = 0.0, sand = 0.0, level = 0.0, wet_weight = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            ivec2 n = clamp(c + ivec2(x, y), ivec2(0), F.grid.xy - 1);
            float weight = (x == 0 ? 0.5 : 0.25) * (y == 0 ? 0.5 : 0.25);
            float ground = sand_surface[at(0, n, 1)], depth = water_depth[at(2, n, 1)];
            solid += weight * ground;
            sand += weight * sand_depth[at(1, n, 1)];
            if (depth > 0.25 * film) {
                level += weight * (ground + depth);
                wet_weight += weight;
            }
        }
    }
    // Next to water a dry cell carries the water's level on below its own ground, so that the two surfaces cross between the
    // cells; farther off the water lies just below the ground. A thin film on a slope keeps its depth.
    float depth = water_depth[at(2, c, 1)];
    float below = solid - 0.02 * F.domain.x;
    float surface = below;
    if (wet_weight > 0.0) {
        level /= wet_weight;
        surface = depth > 0.25 * film ? max(level, solid + min(depth, film)) : min(level, below);
    }
    imageStore(to_heights, c, vec4(solid, surface, host_field[at(9, c, 1)], sand));

    vec2 water_speed = vec2(water_velocity[at(5, c, 2)], water_velocity[at(5, c, 2) + 1]);
    vec2 sand_speed = vec2(sand_velocity[at(6, c, 2)], sand_velocity[at(6, c, 2) + 1]);
    imageStore(to_matter, c, vec4(saturation[at(3, c, 1)], seen_foam(c, depth), wetness[at(7, c, 1)], silt[at(8, c, 1)]));
    imageStore(to_flow, c, vec4(water_speed, sand_speed));
}
