// Prelude of the stage language for GLSL. The wrapper that stagec writes includes it, then the stage file.
#define WADI_GLSL
#define FN
#define REF(T) inout T
#define STAGE(NAME)
#define EXTENT(KIND)
#define REACH(CELLS)
#define FAR_IF(BITS)
#define END_STAGE
#define HELPER
#define HELPER_CONST
#define KERNEL void kernel(int i, int j)
#define IN(SLOT, T, NAME) layout(std430, set = 0, binding = SLOT + 2) readonly buffer NAME##_block { T NAME[]; };
#define OUT(SLOT, T, NAME) layout(std430, set = 0, binding = SLOT + 2) buffer NAME##_block { T NAME[]; };
#define INOUT(SLOT, T, NAME) layout(std430, set = 0, binding = SLOT + 2) buffer NAME##_block { T NAME[]; };
#define IN_IF(BITS, SLOT, T, NAME) IN(SLOT, T, NAME)
#define OUT_IF(BITS, SLOT, T, NAME) OUT(SLOT, T, NAME)
#define INOUT_IF(BITS, SLOT, T, NAME) INOUT(SLOT, T, NAME)
#define HAS(BITS) ((EFFECTS & (BITS)) == (BITS))
#define UNIFORM(C) (C)
#define IDX(I, J) (((J) + GHOST) * P.pitch + (I) + LEAD)

layout(local_size_x_id = 1, local_size_y_id = 2, local_size_z = 1) in;
layout(constant_id = 0) const uint EFFECTS = 0u;
layout(constant_id = 4) const uint ACTIVE_TILES = 0u; // 1: over a list of tiles, or telling which tiles changed

#include "../effects.h"
#include "../step_params.h"

layout(std140, set = 0, binding = 0) uniform WorldParamsBlock { WorldParams P; };
layout(std140, set = 0, binding = 1) uniform StepInputBlock { StepInput S; };

#include "division_glsl.h"
#define HAS_MIN_MAX
float wmin(float a, float b) { return min(a, b); }
float wmax(float a, float b) { return max(a, b); }
float wabs(float x) { return abs(x); }
float wtrunc(float x) { return trunc(x); }
float wfloor(float x) { return floor(x); }
int float_bits(float x) { return floatBitsToInt(x); }
float bits_float(int x) { return intBitsToFloat(x); }
bool both(bool a, bool b) { return a && b; }
bool either(bool a, bool b) { return a || b; }
float choose(bool c, float a, float b) { return c ? a : b; }
