// Friction of water on its bed (NUMERICS 2.4).
#ifndef PHYSICS_BED_FRICTION
#define PHYSICS_BED_FRICTION
#include "../physics/scalar.glsl"

// h^(-1/3) within 2e-7 of itself, from operations that all backends round alike: the logarithm's third by the bits of the number, then
// twice a third-order step of Newton's kind (Householder 1970) for y^-3 = h. Finite for h = 0.
FN float inverse_cube_root(float h) {
    float y = bits_float(1419915900 - float_bits(h) / 3);
    float miss = 1.0f - (h * y) * (y * y);
    y = y + y * (miss * (0.333333343f + 0.222222224f * miss));
    miss = 1.0f - (h * y) * (y * y);
    return y + y * (miss * (0.333333343f + 0.222222224f * miss));
}

// dt c of the stress on the bed, c = c_f + g n^2 h^(-1/3): friction_dt = dt c_f, gravity_dt = dt g, rough: n^2 where the bed has any.
FN float bed_grip(float friction_dt, float gravity_dt, float rough, bool any_roughness, float height) {
    float grip = friction_dt;
    if (any_roughness) grip = grip + gravity_dt * rough * inverse_cube_root(height);
    return grip;
}

// Size of a velocity of at most 1e14 m/s, 1e-14 where there is none: what is rooted is in the range of lean_root.
FN float size_of(float x, float y) { return lean_root((x * x + y * y) + 1.0e-28f); }

// A component of the velocity behind friction V' = V* - rate |V'| V': `pushed` is its component of V*, `own` and `across` are the
// face's and the cross velocity from before the step, rate = dt c/h [s/m]. V* across is taken as what friction would hold at `across`,
// so that a steady flow is the same for any time step.
FN float bed_friction(float pushed, float own, float across, float rate) {
    float push = flush(wclamp(pushed, -1.0e14f, 1.0e14f)); // in the range of lean_quotient, or 0
    float held = wclamp(across * (1.0f + wmin(rate * size_of(own, across), 1.0e29f)), -1.0e14f, 1.0e14f);
    float root = lean_root(1.0f + wmin(4.0f * rate * size_of(push, held), 1.0e29f)); // of an infinity it is undefined on some GPUs
    return lean_quotient(2.0f * push, 1.0f + root);
}

#endif
