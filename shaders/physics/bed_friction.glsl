// Friction of water on its bed (NUMERICS 2.4).
#ifndef PHYSICS_BED_FRICTION
#define PHYSICS_BED_FRICTION
#include "../physics/scalar.glsl"

// A component of the velocity behind friction V' = V* - rate |V'| V': `pushed` is its component of V*, `own` and `across` are the
// face's and the cross velocity from before the step, rate = dt c/h [s/m]. V* across is taken as what friction would hold at `across`,
// so that a steady flow is the same for any time step.
FN float bed_friction(float pushed, float own, float across, float rate) {
    float held = across * (1.0f + rate * wsqrt(square(own) + square(across)));
    float speed = wsqrt(square(wclamp(pushed, -1.0e15f, 1.0e15f)) + square(wclamp(held, -1.0e15f, 1.0e15f)));
    float root = wsqrt(1.0f + wmin(4.0f * rate * speed, 1.0e30f)); // of an infinity it is undefined on some GPUs
    return wdiv(2.0f * pushed, 1.0f + root);
}

#endif
