// Effects: the bits of the mask that decides which stages, buffers and branches exist.
// Shared by every stage (GLSL, C++, CUDA) and by the engine: plain #defines only.
// What each bit means and needs: effect_rows.hpp, a row for each.
#ifndef WADI_EFFECTS_H
#define WADI_EFFECTS_H

#define EFFECT_WATER 1u
#define EFFECT_SAND 2u
#define EFFECT_MIXTURE 4u
#define EFFECT_DIFFUSION 8u
#define EFFECT_DRAG 16u
#define EFFECT_ELASTOPLASTIC 32u
#define EFFECT_COHESION 64u
#define EFFECT_SOURCES 128u
#define EFFECT_RAIN 256u
#define EFFECT_OPEN_SIDES 512u
#define EFFECT_BED_FRICTION 1024u
#define EFFECT_BED_SHEAR 2048u
#define EFFECT_SLOPE_NORMAL 4096u
#define EFFECT_INTERNAL_FRICTION 8192u
#define EFFECT_RETENTION 16384u
#define EFFECT_ROUGHNESS 32768u
#define EFFECT_RAIN_MAP 65536u
#define EFFECT_FOAM 131072u
#define EFFECT_WETNESS 262144u
#define EFFECT_SILT 524288u

// Choices: bits of the same mask, from settings and never from content.
#define EFFECT_PUBLISHED 1048576u
#define EFFECT_DIRECT_STRAIN 2097152u
#define EFFECT_SECOND_ORDER_WATER 4194304u
#define EFFECT_SECOND_ORDER_SAND 8388608u
#define EFFECT_SHOCK_VISCOSITY 16777216u
#define EFFECT_FLOW_FRICTION 33554432u
#define EFFECT_INFILTRATION 67108864u

#endif
