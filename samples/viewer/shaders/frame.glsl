// Bindings of every pass: the plugin's outputs (read in place) and the renderer's own images.
layout(std140, set = 0, binding = 0) uniform Frame {
#include "frame_params.inc"
} F;

// Cell (i, j) of the grid is texel (i, j).
layout(set = 0, binding = 1) uniform sampler2D heights; // solid, water surface [m], the host's quantity, depth of sand [m]
layout(set = 0, binding = 2) uniform sampler2D slopes;  // of the solid x, y; of the water x, y
layout(set = 0, binding = 3) uniform sampler2D matter;  // saturation, foam, how wet the ground is, silt in the water [kg/m2]
layout(set = 0, binding = 4) uniform sampler2D flow;    // velocity of water, of sand [m/s]
layout(set = 0, binding = 5) uniform sampler2D light;   // sun that arrives, sky that is open
layout(set = 0, binding = 6) uniform sampler2D pyramid; // greatest height of patches between cell centres, see march.glsl

layout(set = 0, binding = 25) uniform sampler2D summit_image; // one texel: see summit.comp

layout(set = 0, binding = 28) uniform sampler3D noise_image; // see noise.glsl

// An elevation above every surface [m].
float summit() { return texelFetch(summit_image, ivec2(0), 0).x; }

const int KIND_SKY = 0, KIND_PLINTH = 1, KIND_SOLID = 2, KIND_WATER = 3, KIND_SOLID_WALL = 4, KIND_WATER_WALL = 5;
const int KIND_FAR_SOLID = 6, KIND_FAR_WATER = 7; // beyond the block, see beyond.glsl

// What a picture may be drawn without. The numbers are those of the list in look.cpp.
const int FOAM = 0, SMALL_WAVES = 1, FLOW_MAP = 2, REFLECTION = 3, REFRACTION = 4, CAUSTICS = 5, MUD = 6, GRAIN = 7, WIND_RIPPLES = 8, GLITTER = 9,
          ROCK = 10, SHADOWS = 11, WET_SAND = 12, CLOUDS = 13, HAZE = 14, WETNESS = 15;
bool drawn(int feature) { return (F.features.x & (1 << feature)) != 0; }

// The pyramid's levels lie in one texture, the base below and the others side by side on top of it: some drivers fetch wrong
// texels where neighbouring lanes ask for different mip levels. F.image.w: height of the base; F.grid.w: its width.
ivec2 pyramid_size(int level) { return ivec2(F.grid.w, F.image.w) >> level; }
ivec2 pyramid_texel(ivec2 block, int level) {
    block = clamp(block, ivec2(0), pyramid_size(level) - 1);
    return level == 0 ? block : block + ivec2(F.grid.w - (F.grid.w >> (level - 1)), F.image.w);
}

vec2 cell_of(vec2 xy) { return xy / F.domain.x - 0.5; }
vec2 texture_of(vec2 xy) { return xy / (F.domain.x * vec2(F.grid.xy)); }

// Solid, water surface and depth of sand between cell centres.
vec4 heights_at(vec2 xy) {
    vec2 c = clamp(cell_of(xy), vec2(0.0), vec2(F.grid.xy - 1));
    ivec2 k = ivec2(c), n = min(k + 1, F.grid.xy - 1);
    vec2 f = c - vec2(k);
    return mix(mix(texelFetch(heights, k, 0), texelFetch(heights, ivec2(n.x, k.y), 0), f.x),
               mix(texelFetch(heights, ivec2(k.x, n.y), 0), texelFetch(heights, n, 0), f.x), f.y);
}

// An `if` that software devices skip when no lane needs it: they run both sides of a branch, but leave a loop early.
#define WHERE(condition) for (bool once = (condition); once; once = false)

vec3 ray_through(vec2 pixel) {
    vec2 p = (pixel + 0.5 + F.lens.xy) / vec2(F.image.xy) * 2.0 - 1.0;
    return normalize(F.forward.xyz + F.right.xyz * p.x - F.up.xyz * p.y);
}
