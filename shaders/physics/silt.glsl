// Silt: what makes water muddy, per area of the bed (NUMERICS 2.27). It takes nothing from the sand and moves nothing.
#ifndef PHYSICS_SILT
#define PHYSICS_SILT
#include "../physics/bed_friction.glsl"
#include "../physics/fading.glsl"

#define SILT_LEAST 6.103515625e-5f // 2^-14 kg/m2 is none: nobody sees it
#define SILT_MOST 8.0f             // as much hides the ground many times over [kg/m2]

// What is left after a step in which silt sinks by `fall` [m] through water of a depth; where there is none it lies on the ground.
FN float silt_left(float silt, float depth, float fall, float dry) {
    float left = faded(silt, wmin(lean_divide_or_zero(fall, depth), 1.0f), SILT_LEAST);
    return depth > dry ? left : 0.0f;
}

// Picked up in a step from sand that water passes with that squared speed: rate (tau/tau_c - 1), by the excess of the stress on the bed.
// (Partheniades 1965, Erosion and deposition of cohesive soils.) By Manning's law tau goes with u^2 h^(-1/3), and tau_c is that of the
// least speed where water is 1 m deep.
FN float silt_picked_up(float speed2, float depth, float inv_least_speed2, float rate) {
    float stress = (speed2 * inv_least_speed2) * inverse_cube_root(depth);
    return wmin(rate * wmax(stress - 1.0f, 0.0f), SILT_MOST);
}

#endif
