// Coulomb friction of sand on the ground under it (paper 3.3.1, 4.2.4; NUMERICS 2.8).
#ifndef PHYSICS_COULOMB_FRICTION
#define PHYSICS_COULOMB_FRICTION
#include "../physics/scalar.glsl"

// What friction takes from a velocity in a substep at most [m/s], on level ground: mu g dts of the weight that buoyancy leaves.
// wet: h_m/h_s.
FN float coulomb_slip(float mu, float gravity, float dts, float wet, float density_ratio) {
    return mu * gravity * dts * wmax(0.0f, 1.0f - density_ratio * wet);
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
