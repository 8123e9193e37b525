#version 450
#extension GL_GOOGLE_include_directive : require
// Every operation that stages rely on, on random operands; the host compares with its own results bit for bit.
layout(local_size_x_id = 1, local_size_y_id = 2, local_size_z = 1) in;
#include "language/division_glsl.h"

layout(std430, set = 0, binding = 0) readonly buffer operands_block { vec2 operands[]; }; // any sign; positive
layout(std430, set = 0, binding = 1) writeonly buffer results_block { float results[]; };

#define RESULTS 8 // exact_float_results_per_try

void main() {
    uint n = gl_GlobalInvocationID.x;
    if (n >= uint(operands.length())) return;
    float a = operands[n].x;
    float b = operands[n].y;
    results[RESULTS * n + 0u] = a + b;
    results[RESULTS * n + 1u] = a - b;
    results[RESULTS * n + 2u] = a * b;
    results[RESULTS * n + 3u] = a * b + a; // differs if contracted
    results[RESULTS * n + 4u] = wdiv(a, b);
    results[RESULTS * n + 5u] = wsqrt(b);
    results[RESULTS * n + 6u] = lean_quotient(abs(a), b);
    results[RESULTS * n + 7u] = lean_root(b);
}
