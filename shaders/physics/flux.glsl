// Conservative upwind transport of heights (paper 4.1.2 with the sign of Eq. 7 corrected; Chentanez and Mueller 2010)
// and the outflow limiter (NUMERICS 2.2). A flux is a depth moved in one step, k*q [m], positive east and north.
#ifndef PHYSICS_FLUX
#define PHYSICS_FLUX
#include "../physics/scalar.glsl"

// Raw upwind flux through a face between `low` (west or south) and `high` (east or north) cells.
FN float upwind_flux(float velocity, float height_low, float height_high, float k) {
    return k * (wmax(velocity, 0.0f) * height_low + wmin(velocity, 0.0f) * height_high);
}

// The same by the depth that the donor's limited slope gives half a cell and half a step downstream (NUMERICS 2.16). The slope
// is the least of depth and free surface over both of the donor's faces; none beside dry cells. far_*: the cells behind.
FN float second_order_flux(float velocity, float far_low, float low, float high, float far_high, float surface_far_low, float surface_low,
                           float surface_high, float surface_far_high, float k, float dry) {
    bool east = velocity > 0.0f;
    float behind = east ? far_low : far_high;
    float donor = east ? low : high;
    float ahead = east ? high : low;
    float surface_behind = east ? surface_far_low : surface_far_high;
    float surface_donor = east ? surface_low : surface_high;
    float surface_ahead = east ? surface_high : surface_low;
    float rise = minmod(minmod(donor - behind, surface_donor - surface_behind), minmod(ahead - donor, surface_ahead - surface_donor));
    float share = 0.5f * (1.0f - wmin(k * wabs(velocity), 1.0f));
    bool wet = both(both(behind > dry, ahead > dry), donor > dry);
    float depth = wet ? donor + share * rise : donor;
    return k * (velocity * depth);
}

// What leaves a cell through its four faces; west and south fluxes leave where negative.
FN float outflow(float flux_west, float flux_east, float flux_south, float flux_north) {
    return (wmax(-flux_west, 0.0f) + wmax(flux_east, 0.0f)) + (wmax(-flux_south, 0.0f) + wmax(flux_north, 0.0f));
}

// Factor on all outflow of a cell so that it never gives more than it holds; 4 ulp
// keep the sum of the four below it however they were rounded.
FN float outflow_scale(float height, float outflow_depth, float limiter) {
    float safe_height = height * (1.0f - 4.76837158e-7f);
    float limited = outflow_depth > safe_height ? divide_or_zero(safe_height, outflow_depth) : 1.0f;
    return limiter > 0.0f ? limited : 1.0f;
}

// The flux after its donor's limiter, in whole quanta.
FN float limited_flux(float raw, float scale_low, float scale_high, float quantum, float inv_quantum) {
    float scale = raw > 0.0f ? scale_low : scale_high;
    return flush(whole_quanta(raw * scale, quantum, inv_quantum));
}

FN float integrate_height(float height, float flux_west, float flux_east, float flux_south, float flux_north) {
    return flush(wmax(height + ((flux_west - flux_east) + (flux_south - flux_north)), 0.0f));
}

// Diffusion of mixed water as a flux (NUMERICS 2.1): the smaller of the gradients of the mixed height and of the free
// surface, none where they disagree in sign, so that a lake at rest stays at rest. number = c dt/dx^2.
FN float diffusive_flux(float mixed_low, float mixed_high, float surface_low, float surface_high, float sand_low, float sand_high, float number, float dry) {
    float a = mixed_high - mixed_low;
    float e = surface_high - surface_low;
    float s = minmod(a, e);
    bool sand = both(sand_low > dry, sand_high > dry);
    return both(s != 0.0f, sand) ? -number * s : 0.0f;
}

#endif
