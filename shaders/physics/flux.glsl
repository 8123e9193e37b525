// Conservative upwind transport of heights (paper 4.1.2 with the sign of Eq. 7 corrected; Chentanez and Mueller 2010)
// and the outflow limiter (NUMERICS 2.2). A flux is a depth moved in one step, k*q [m], positive east and north.
#ifndef PHYSICS_FLUX
#define PHYSICS_FLUX
#include "../physics/scalar.glsl"

// Raw upwind flux through a face between `low` (west or south) and `high` (east or north) cells.
FN float upwind_flux(float velocity, float height_low, float height_high, float k) {
    return k * (wmax(velocity, 0.0f) * height_low + wmin(velocity, 0.0f) * height_high);
}

// Depth of one layer in a cell, and the surface whose slope bounds that of the depth: for pure water the depth again.
struct Column {
    float depth, surface;
};

// Half-time profile of a layer in a cell along one axis: its limited slope up the axis, and k times the growth of the velocity over it,
// by which it thins; both 0 beside dry cells. A factor chooses: g++ would sink loads behind a condition.
struct Profile {
    float depth, slope, growth;
};

FN float column_rise(Column low, Column high) { return minmod(high.depth - low.depth, high.surface - low.surface); }

FN Profile profile(Column low, Column mid, Column high, float velocity_low, float velocity_high, float k, float dry) {
    float wet = wmin(wmin(low.depth, high.depth), mid.depth) > dry ? 1.0f : 0.0f;
    Profile p;
    p.depth = mid.depth;
    p.slope = wet * minmod(column_rise(low, mid), column_rise(mid, high));
    p.growth = wet * wclamp(k * (velocity_high - velocity_low), -1.0f, 1.0f);
    return p;
}

// The depth at the face that lies half a cell downstream; slope is counted downstream, courant = k times the face's speed.
FN float face_depth(float depth, float slope, float growth, float courant) {
    return depth + (0.5f * (1.0f - wmin(courant, 1.0f)) * slope - 0.5f * growth * depth);
}

// upwind_flux by these depths (NUMERICS 2.16), in its two parts: what leaves a donor up the axis, and down the axis.
FN float flux_up(float velocity, Profile donor, float k) {
    return k * (wmax(velocity, 0.0f) * face_depth(donor.depth, donor.slope, donor.growth, k * wabs(velocity)));
}
FN float flux_down(float velocity, Profile donor, float k) {
    return k * (wmin(velocity, 0.0f) * face_depth(donor.depth, -donor.slope, donor.growth, k * wabs(velocity)));
}

// Fluxes through a cell's two faces along one axis, positive up the axis.
struct FacePair {
    float low, high;
};

// What upwind_flux takes out of a cell through one face; outward: the face's velocity.
FN float leaving(float outward, float height, float k) { return k * (wmax(outward, 0.0f) * height); }

// What leaves a cell through its four faces; fluxes through low faces leave where negative.
FN float outflow(FacePair x, FacePair y) { return (wmax(-x.low, 0.0f) + wmax(x.high, 0.0f)) + (wmax(-y.low, 0.0f) + wmax(y.high, 0.0f)); }

// Factor on all outflow of a cell so that it never gives more than it holds; 4 ulp
// keep the sum of the four below it however they were rounded.
FN float outflow_scale(float height, float outflow_depth, float limiter) {
    float safe_height = height * (1.0f - 4.76837158e-7f);
    float limited = outflow_depth > safe_height ? lean_divide_or_zero(safe_height, outflow_depth) : 1.0f;
    return limiter > 0.0f ? limited : 1.0f;
}

// How many quanta a flux moves: what is less than one moves one in that share of the steps, since `phase` takes every value of [0, 1)
// equally often.
FN float moved_quanta(float flux, float inv_quantum, float phase) { return wfloor(wabs(flux) * inv_quantum + phase); }

// outflow_scale of a cell, negative where phase would let it give more than it holds: then its fluxes are cut toward 0. Each of the four
// moves less than a quantum more than what is meant, and as much again is kept for what rounding does.
FN float outflow_limit(float height, FacePair x, FacePair y, float limiter, float quantum, float inv_quantum, float phase) {
    float taken = outflow(x, y);
    float scale = outflow_scale(height, taken, limiter);
    bool short_of = false;
    if (UNIFORM(taken * scale + 8.0f * quantum > height)) { // hardly ever
        float moved_x = moved_quanta(wmax(-x.low, 0.0f) * scale, inv_quantum, phase) + moved_quanta(wmax(x.high, 0.0f) * scale, inv_quantum, phase);
        float moved_y = moved_quanta(wmax(-y.low, 0.0f) * scale, inv_quantum, phase) + moved_quanta(wmax(y.high, 0.0f) * scale, inv_quantum, phase);
        short_of = (moved_x + moved_y) * quantum > height;
    }
    return short_of ? -scale : scale;
}

// The flux after its donor's limiter, in whole quanta.
FN float limited_flux(float raw, float scale_low, float scale_high, float quantum, float inv_quantum, float phase) {
    float scale = raw > 0.0f ? scale_low : scale_high;
    float limited = raw * wabs(scale);
    float up = (scale > 0.0f ? 1.0f : 0.0f) * phase; // factors choose: g++ would sink loads behind conditions
    float share = limited > 0.0f ? up : -up;
    return flush(whole_quanta(limited + share * quantum, quantum, inv_quantum));
}

FN float integrate_height(float height, float flux_west, float flux_east, float flux_south, float flux_north) {
    return flush(wmax(height + ((flux_west - flux_east) + (flux_south - flux_north)), 0.0f));
}

#endif
