// What fades on the surface, foam and wetness: in whole quanta of its own, so that it ends and that what drifts keeps its sum.
#ifndef PHYSICS_FADING
#define PHYSICS_FADING
#include "../physics/scalar.glsl"

#define SURFACE_QUANTUM 9.5367431640625e-7f // 2^-20: sums up to 16 are exact
#define INV_SURFACE_QUANTUM 1048576.0f

FN float surface_quanta(float amount) { return whole_quanta(amount, SURFACE_QUANTUM, INV_SURFACE_QUANTUM); }

// What is left of an amount when a share of it fades: of less than `least` nothing. What fades is rounded up, so that it is never none.
FN float faded(float amount, float share, float least) {
    float lost = amount < least ? amount : surface_quanta(amount * share) + SURFACE_QUANTUM;
    return wmax(amount - (share > 0.0f ? lost : 0.0f), 0.0f);
}

#endif
