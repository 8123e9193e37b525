// Foam from the state alone, no history.
#ifndef PHYSICS_FOAM
#define PHYSICS_FOAM
#include "../physics/scalar.glsl"

// Fast water: from Froude number 1 (Fr^2 = 1) to 2 (Fr^2 = 4). `wave2`: g h, the squared speed of long waves [m2/s2].
FN float jet_foam(float speed2, float wave2) { return wclamp((divide_or_zero(speed2, wave2) - 1.0f) * 0.33333334f, 0.0f, 1.0f); }

// Breaking fronts: the surface rises by `rise` [m/s], between 0.15 and 0.65 of the wave speed. (Kennedy, Chen, Kirby and
// Dalrymple 2000, Boussinesq modeling of wave transformation, breaking, and runup I: onset 0.65, end 0.15 sqrt(g h).)
FN float breaking_foam(float rise, float wave2) { return wclamp((divide_or_zero(rise, wsqrt(wave2)) - 0.15f) * 2.0f, 0.0f, 1.0f); }

// Films thinner than a tenth of a cell carry less.
FN float film_weight(float depth, float inv_dx) { return wclamp(10.0f * depth * inv_dx, 0.0f, 1.0f); }

// Of water of a depth; `inflow`: sum of what enters less what leaves along both axes [m/s], -div(u) dx.
FN float foam_of(float depth, float speed2, float inflow, float gravity, float inv_dx) {
    float wave2 = gravity * depth;
    float rise = depth * inflow * inv_dx;
    return flush(wmax(jet_foam(speed2, wave2), breaking_foam(rise, wave2)) * film_weight(depth, inv_dx));
}

#endif
