// What drifts with the pure water, foam and silt: limited upwind fluxes of an amount per cell in whole quanta of its own (NUMERICS 2.25).
#ifndef PHYSICS_DRIFTING
#define PHYSICS_DRIFTING
#include "../physics/fading.glsl"
#include "../physics/flux.glsl"

// Limiter of a cell that holds an amount of which `moves` is carried. Velocities of its four faces; `pace`: k times how much faster it is.
FN float drift_scale(float held, float moves, float west, float east, float south, float north, float pace) {
    FacePair x, y;
    x.low = -leaving(-west, moves, pace);
    x.high = leaving(east, moves, pace);
    y.low = -leaving(-south, moves, pace);
    y.high = leaving(north, moves, pace);
    return outflow_scale(held, outflow(x, y), 1.0f);
}

FN float drift_flux(float velocity, float moves_low, float moves_high, float scale_low, float scale_high, float pace) {
    return limited_flux(upwind_flux(velocity, moves_low, moves_high, pace), scale_low, scale_high, SURFACE_QUANTUM, INV_SURFACE_QUANTUM, 0.0f);
}

#endif
