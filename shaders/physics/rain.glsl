// What falls on a cell under a rain map (NUMERICS 2.9).
#ifndef PHYSICS_RAIN
#define PHYSICS_RAIN
#include "../physics/ledger.glsl"

// floor(share/65536 n) for shares to 65536: how much of n has fallen on a cell, but for what each whole 65536 of them brings.
FN uint part_of(uint share, uint n) { return share * (n >> 16) + ((share * (n & 65535u)) >> 16); }

// The depth that falls on a cell in a step: what has fallen in all, cut to whole quanta, less what had fallen before. Nothing is lost that
// way however little a step brings. share: of rain.x, in 1/65536; rain: StepInput.mapped_rain.
FN float mapped_rain(float share, vec4 rain, float quantum, float inv_ledger_quantum) {
    uint s = uint(int(share));
    uint before = uint(int(rain.y));
    uint quanta = part_of(s, before + quanta_of(rain.x, inv_ledger_quantum, quantum)) - part_of(s, before);
    return quantum > 0.0f ? float(int(quanta)) * quantum : share * 1.52587890625e-5f * rain.x;
}

#endif
