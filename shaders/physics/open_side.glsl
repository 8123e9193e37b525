// Velocities at the outer faces of open sides (NUMERICS 2.9).
#ifndef PHYSICS_OPEN_SIDE
#define PHYSICS_OPEN_SIDE
#include "../physics/scalar.glsl"

// Outward velocity of an outflow side (NUMERICS 2.9): next is that of the next face inside, rise how much higher the water stands in the
// last cell than in the one before, gravity as the scheme may use it. The incoming characteristic u - 2 sqrt(g h) has no gradient, so that
// waves leave; in fast flow, which no wave runs up, next alone.
FN float radiated(float next, float depth, float rise, float gravity) {
    float wave = wsqrt(gravity * depth);
    float before = wsqrt(gravity * wmax(depth - rise, 0.0f));
    float froude = divide_or_zero(wabs(next), wave);
    float share = wclamp(2.0f - 2.0f * froude, 0.0f, 1.0f);
    return next + share * (2.0f * (wave - before));
}

#endif
