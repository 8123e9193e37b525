// Velocities at the outer faces of open sides (NUMERICS 2.9).
#ifndef PHYSICS_OPEN_SIDE
#define PHYSICS_OPEN_SIDE
#include "../physics/scalar.glsl"

// Outward velocity of an outflow side (NUMERICS 2.9): next is that of the next face inside, depth the water above the sand, rise how much
// higher it stands in the last cell than in the one before, gravity as the scheme may use it. The incoming characteristic u - 2 sqrt(g h)
// has no gradient, so that waves leave; in fast flow, which no wave runs up, next alone.
FN float radiated(float next, float depth, float rise, float gravity) {
    float wave = wsqrt(gravity * depth);
    float before = wsqrt(gravity * wmax(depth - rise, 0.0f));
    float froude = divide_or_zero(wabs(next), wave);
    float share = wclamp(2.0f - 2.0f * froude, 0.0f, 1.0f);
    return next + share * (2.0f * (wave - before));
}

// What the outward velocity of a side that holds a level gains in a step (NUMERICS 2.9) beside water about as deep: u - 2 sqrt(g h) changes
// only with the level. lag: the face's last velocity where fluxes take the upwind cell's depth, 0 where they take the face's; gained: what
// the cell's faces would add to its depth in the step, by water inside the sand too; push: what one cell of water between the side and its
// level would gain; wave_in: the height of the wave that the level's change sends in.
FN float absorbed(float lag, float depth, float gained, float push, float wave_in, float gravity, float k, float inv_hold) {
    float wave = wsqrt(gravity * depth);
    float per_height = divide_or_zero(wave, depth);
    float change = per_height * (gained - 2.0f * wave_in) + push * inv_hold;
    return wdiv(change, 1.0f + k * wmax(wave + lag, 0.0f));
}

// Outward velocity of the water inside sand at such a side: push is what the water above it gains in a step, free the relative permeability of
// what it leaves, exchange what drag takes in a step from water of that density beside sand at rest. Implicit, as in the sand.
FN float seeped(float own, float push, float free, float water_density, float exchange) {
    float weight = water_density * free;
    return (own + push) * divide_or_zero(weight, weight + exchange);
}

#endif
