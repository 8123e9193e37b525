// Where the water in sand stands, and what of the sand's weight its pressure bears (NUMERICS 2.8, 2.19).
#ifndef PHYSICS_PORE_PRESSURE
#define PHYSICS_PORE_PRESSURE
#include "../physics/scalar.glsl"

// Depth of sand whose pores are full: below the table of its water, in its lower part. Above it `retained` of the pores are. depth: at which
// the water's surface stands.
FN float full_depth(float depth, float sand, float retained, float inv_drainable) {
    return retained > 0.0f ? wclamp((depth - retained * sand) * inv_drainable, 0.0f, sand) : wmin(depth, sand);
}

// Of the depth of a face's sand.
struct PoreShares {
    float full; // whose pores are full: pressure bears part of that sand
    float held; // of water that suction holds above: it hangs on the grains and weighs as they do [m of water]
};

// full, mixed: sums of both cells; inv_sum: 1 over that of the sand.
FN PoreShares pore_shares(float full, float mixed, float inv_sum, float porosity) {
    PoreShares shares;
    shares.full = full * inv_sum;
    shares.held = mixed * inv_sum - porosity * shares.full;
    return shares;
}

// What presses sand onto its ground, as a share of its own weight: effective stress, the weight of grains and held water less the
// pressure in full pores (Terzaghi 1923). Above suction no grain floats (chi of Bishop 1959 is 0 there). buoyancy: what of the sand
// displaces water.
FN float effective_weight(PoreShares pores, float density_ratio, float buoyancy) {
    return wmax(0.0f, 1.0f - density_ratio * (buoyancy * pores.full - pores.held));
}

// What of the sand's own weight pushes it down a slope: the rest is borne by pressure or brought by held water.
FN float pushing_weight(PoreShares pores, float density_ratio, float buoyancy) { return wmax(0.0f, 1.0f - density_ratio * (buoyancy * pores.full)); }

// What a sloping surface of water pushes grains with beside what drag brings, as a fall of sand [m]: pressure acts on water and grains
// alike. table_rise: of that surface; pressed: share of the sand that is grains.
FN float grain_push(PoreShares pores, float table_rise, float density_ratio, float pressed) { return density_ratio * (pressed * pores.full * table_rise); }

#endif
