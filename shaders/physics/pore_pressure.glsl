// Where the water in sand stands, and what of the sand's weight its pressure bears (NUMERICS 2.8, 2.19).
#ifndef PHYSICS_PORE_PRESSURE
#define PHYSICS_PORE_PRESSURE
#include "../physics/scalar.glsl"

// Depth of sand whose pores are full: below the table of its water, in its lower part. Above it pores hold `retained` of the depth.
FN float full_depth(float water, float sand, float retained, float inv_drainable) {
    return retained > 0.0f ? wclamp((water - retained * sand) * inv_drainable, 0.0f, sand) : wmin(water, sand);
}

// Of the depth of a face's sand.
struct PoreShares {
    float full; // whose pores are full: pressure bears part of that sand
    float held; // of water that suction holds above: it hangs on the grains and weighs as they do
};

// full, mixed: sums of both cells; inv_sum: 1 over that of the sand.
FN PoreShares pore_shares(float full, float mixed, float inv_sum) {
    PoreShares shares;
    shares.full = full * inv_sum;
    shares.held = mixed * inv_sum - shares.full;
    return shares;
}

// What presses sand onto its ground, as a share of its own weight: effective stress, the weight of grains and held water less the
// pressure in full pores (Terzaghi 1923). Above suction no grain floats (chi of Bishop 1959 is 0 there).
FN float effective_weight(PoreShares pores, float density_ratio) { return wmax(0.0f, 1.0f - density_ratio * (pores.full - pores.held)); }

// What of the sand's own weight pushes it down a slope: the rest is borne by pressure or brought by held water.
FN float pushing_weight(PoreShares pores, float density_ratio) { return wmax(0.0f, 1.0f - density_ratio * pores.full); }

#endif
