// Velocities at the outer faces of open sides (NUMERICS 2.9).
#ifndef PHYSICS_OPEN_SIDE
#define PHYSICS_OPEN_SIDE
#include "../physics/scalar.glsl"

// How far a stream is one that waves run up: 1 to half the waves' speed, 0 from it on.
FN float subcritical_share(float velocity, float wave) {
    return wclamp(2.0f - 2.0f * divide_or_zero(wabs(velocity), wave), 0.0f, 1.0f);
}

// Outward velocity of the water inside sand at a side that has a level: push is what the water above it gains in a step, free the relative permeability of
// what it leaves, exchange what drag takes in a step from water of that density beside sand at rest. Implicit, as in the sand.
FN float seeped(float own, float push, float free, float water_density, float exchange) {
    float weight = water_density * free;
    return (own + push) * divide_or_zero(weight, weight + exchange);
}

#endif
