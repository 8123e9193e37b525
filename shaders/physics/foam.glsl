// Foam: from the state alone, without history, and what drifts (NUMERICS 2.25).
#ifndef PHYSICS_FOAM
#define PHYSICS_FOAM
#include "../physics/scalar.glsl"

// Fast water: from Froude number 1 (Fr^2 = 1) to 2 (Fr^2 = 4). `wave2`: g h, the squared speed of long waves [m2/s2].
FN float jet_foam(float speed2, float wave2) { return wclamp((divide_or_zero(speed2, wave2) - 1.0f) * 0.33333334f, 0.0f, 1.0f); }

// Breaking fronts: the surface rises by `rise` [m/s], between 0.15 and 0.65 of the wave speed. (Kennedy, Chen, Kirby and
// Dalrymple 2000, Boussinesq modeling of wave transformation, breaking, and runup I: onset 0.65, end 0.15 sqrt(g h).)
FN float breaking_foam(float rise, float wave2) { return wclamp((divide_or_zero(rise, wsqrt(wave2)) - 0.15f) * 2.0f, 0.0f, 1.0f); }

// Films thinner than a tenth of a cell carry less.
FN float film_weight(float depth, float inv_dx) { return wclamp(10.0f * depth * inv_dx, 0.0f, 1.0f); }

// Of water of a depth; `inflow`: sum of what enters less what leaves along both axes [m/s], -div(u) dx.
FN float foam_of(float depth, float speed2, float inflow, float gravity, float inv_dx) {
    float wave2 = gravity * depth;
    float rise = depth * inflow * inv_dx;
    return flush(wmax(jet_foam(speed2, wave2), breaking_foam(rise, wave2)) * film_weight(depth, inv_dx));
}

#define FOAM_LEAST 1.52587890625e-5f // 2^-16 is none
#define FOAM_MOST 4.0f               // where currents pile it up, it collapses
#define INV_FOAM_DRAFT 50.0f         // foam floats freely in 2 cm of water [1/m]
#define FOAM_PACE 1.1764706f         // 1/0.85: what floats on a stream is so much faster than its mean (ISO 748)

// Share of the foam that shallow water carries; the rest of it lies on the ground.
FN float afloat(float depth) { return wclamp(depth * INV_FOAM_DRAFT, 0.0f, 1.0f); }

// Cover born in a step where breaking water loses energy: what a viscosity of half the speed of long waves times dx takes from the fall of
// the velocity across a cell. `rate`: WorldParams.foam_birth; no compression is that fast (1e4 m/s).
FN float foam_born(float depth, float inflow, float gravity, float inv_dx, float rate) {
    float fall = wclamp(inflow, 0.0f, 1.0e4f);
    float wave2 = gravity * depth;
    float breaks = breaking_foam(depth * fall * inv_dx, wave2);
    return breaks * wmin(rate * (depth * (wsqrt(wave2) * (fall * fall))), 1.0f);
}

#endif
