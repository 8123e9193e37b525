// Coulomb friction of sand on the ground under it (paper 3.3.1, 4.2.4; NUMERICS 2.8).
#ifndef PHYSICS_COULOMB_FRICTION
#define PHYSICS_COULOMB_FRICTION
#include "../physics/scalar.glsl"

// What friction takes from a velocity in a substep at most [m/s], on level ground: mu g dts of the weight that is left of the sand's own.
FN float coulomb_slip(float mu, float gravity, float dts, float weight) { return mu * gravity * dts * weight; }

// The weight that buoyancy leaves, as a share. wet: h_m/h_s.
FN float buoyant_weight(float wet, float density_ratio) { return wmax(0.0f, 1.0f - density_ratio * wet); }

// What cohesion on the ground takes besides, however heavy the sand is, as on the infinite slope of soil mechanics.
// strength: sum over both cells of cohesive share times depth; base: how much of it clings to the ground.
FN float adhesion_slip(float per_share, float base, float strength, float inv_sum) { return per_share * base * (strength * inv_sum); }

// What water brings uphill meets the sand above, whose slope withholds a push (NUMERICS 2.18): how much of that withheld push, a vector,
// it calls forth. No more than it brings against it, and no more than moves uphill.
FN float uphill_met(float brought, float brought_across, float along, float across, float withheld, float withheld_across) {
    float size = lean_root(wmax(withheld * withheld + withheld_across * withheld_across, 1.0e-28f));
    float per_size = lean_reciprocal(size);
    float uphill = (brought * withheld + brought_across * withheld_across) * per_size;
    float moves = (along * withheld + across * withheld_across) * per_size;
    return wmax(wmin(wmin(uphill, size), moves), 0.0f) * per_size;
}

// Sand's velocity after drag and stick or slip. along, across: sand momentum per mass with the water's share, us + kappa um;
// slip: coulomb_slip on its slope; limit: clamp of the speed that is left.
FN float stick_or_slip(float along, float across, float slip, float kappa, float limit) {
    float size = lean_root(wmax(along * along + across * across, 1.0e-28f));
    float heavier = 1.0f + kappa;
    float left = wmin(wmax(size - slip, 0.0f), limit * heavier);
    return wclamp(along * lean_quotient(left, size * heavier), -limit, limit);
}

#endif
