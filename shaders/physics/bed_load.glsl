// Bed load: sand that fast clear water drags along the bed (NUMERICS 2.11). Not in the paper, whose pure water leaves the sand under
// it alone. Shear stress tau/rho_w = c |u|^2 moves 8/((s - 1) g) (tau/rho_w - tau_c/rho_w)^1.5 [m2/s] of sand with the flow
// (E. Meyer-Peter and R. Mueller 1948) and the more of it the steeper the bed falls.
#ifndef PHYSICS_BED_LOAD
#define PHYSICS_BED_LOAD
#include "../physics/scalar.glsl"

// Volume per width and time through a face: `along` is the face's own velocity, `across` the other component, `rise` the bed's
// step to the high cell, slope_number 2/dx, slope_cap what keeps the bed's own diffusion stable [m/s].
FN float bed_load(float along, float across, float rise, float shear, float threshold, float rate, float slope_number, float slope_cap) {
    float speed2 = square(along) + square(across);
    float excess = wmax(shear * speed2 - threshold, 0.0f);
    float moved = rate * (excess * wsqrt(excess));
    float downhill = wmin(moved * slope_number, slope_cap) * rise;
    return moved * divide_or_zero(along, wsqrt(speed2)) - downhill;
}

#endif
