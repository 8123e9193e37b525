// What slows sand from within: friction in a layer that thins while it slides, and viscosity in its plane (NUMERICS 2.18).
#ifndef PHYSICS_INTERNAL_FRICTION
#define PHYSICS_INTERNAL_FRICTION
#include "../physics/velocity.glsl"

// What internal friction leaves of a velocity: all of a block's, at rest and where sand piles up. growth: divergence of the sand's velocity
// at the face [1/s]; speed2: square of the old velocity; friction: b times what friction takes from a velocity in the substep.
FN float internal_friction(float growth, float least_height, float speed2, float wave_speed2, float friction) {
    float thinning = least_height * wmax(growth, 0.0f);
    float left = 1.0f;
    if (UNIFORM(thinning > 0.0f)) {
        float speed = lean_root(wmax(speed2 + 0.0025f * wave_speed2, 1.0e-20f)); // no less than a twentieth of that of waves
        float kept = wmax(0.0f, 1.0f - lean_divide_or_zero(friction * thinning, (speed + thinning) * speed));
        left = thinning > 0.0f ? kept : 1.0f;
    }
    return left;
}

// What viscosity adds to the velocity of a face per viscosity number: differences to the faces around, each times the depth of sand that
// touches there.
FN float in_plane_viscosity(float own, Around at, float height_low, float height_high, float height_left, float height_right, float inv_mean) {
    float along = height_high * (at.high - own) - height_low * (own - at.low);
    float across = height_right * (at.right - own) - height_left * (own - at.left);
    return (along + across) * inv_mean;
}

#endif
