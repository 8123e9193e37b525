// Exact 64-bit counts of height quanta in two 32-bit words: no stage needs 64-bit integers or atomics.
#ifndef PHYSICS_LEDGER
#define PHYSICS_LEDGER
#include "../physics/scalar.glsl"

FN void count_quanta(REF(uint) low, REF(uint) high, uint amount) {
    uint sum = low + amount;
    high += sum < low ? 1u : 0u;
    low = sum;
}

FN void add_count(REF(uint) low, REF(uint) high, uint amount, uint amount_high) {
    count_quanta(low, high, amount);
    high += amount_high;
}

// A depth of at most a few times largest_height as a whole number of ledger quanta; rounds only when heights are plain floats.
FN uint quanta_of(float depth, float inv_ledger_quantum, float quantum) {
    float n = depth * inv_ledger_quantum;
    return uint(quantum > 0.0f ? n : n + 0.5f);
}

#endif
