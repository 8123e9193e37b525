// Face velocities: momentum advection with the limited mass fluxes, pressure, wet/dry and rest rules (NUMERICS 2.3, 2.4).
#ifndef PHYSICS_VELOCITY
#define PHYSICS_VELOCITY
#include "../physics/scalar.glsl"

// Velocities at the faces around one: low and high along its direction, left and right across it.
struct Around {
    float low, high, left, right;
};

// Flux-form staggered upwind advection of one face velocity in increment form (NUMERICS 2.3, after Stelling and
// Duinmeijer 2003): flux_* are the depths moved through the four sides of the face's own control volume, each the sum of two faces',
// low and high along its direction, left and right across it; height its mean new depth, inv_sum 1 over the sum of both cells': the halves
// of both means cancel. A convex combination of the five velocities for any time step.
FN float advect_velocity(float u, float u_low, float u_high, float u_left, float u_right, float flux_low, float flux_high, float flux_left,
                         float flux_right, float height, float inv_sum, float dry) {
    float along = wmax(-flux_high, 0.0f) * (u_high - u) + wmax(flux_low, 0.0f) * (u_low - u);
    float across = wmax(-flux_right, 0.0f) * (u_right - u) + wmax(flux_left, 0.0f) * (u_left - u);
    float moved = u + (along + across) * inv_sum;
    return height > dry ? moved : u;
}

// Monotonized central slope (van Leer 1977) of a value between its neighbours.
FN float central_slope(float low, float mid, float high) {
    float a = mid - low;
    float b = high - mid;
    return minmod(2.0f * minmod(a, b), 0.5f * (a + b));
}

// Velocities on both sides of a face along one axis; inside_*: 1 where the grid has the far one, else 0.
struct FaceLine {
    float far_low, low, high, far_high, inside_low, inside_high;
};

FN FaceLine face_line(float far_low, float low, float high, float far_high, bool inside_low, bool inside_high) {
    FaceLine line;
    line.far_low = far_low;
    line.low = low;
    line.high = high;
    line.far_high = far_high;
    line.inside_low = inside_low ? 1.0f : 0.0f;
    line.inside_high = inside_high ? 1.0f : 0.0f;
    return line;
}

// What `inflow` through one side of u's control volume brings beyond u itself (NUMERICS 2.16): from `near`, whose other neighbour is
// `far`, or, where negative, out of u's own slope towards `near`. near_courant: how many cells `near` moves in the step. inflow, inv_sum:
// as fluxes and inv_sum of advect_velocity.
FN float side_gain(float inflow, float u, float near, float far, float inside, float own_slope, float inv_sum, float near_courant) {
    float share = 0.5f * (1.0f - wmin(wabs(inflow) * inv_sum, 1.0f));
    float near_share = 0.5f * (1.0f - wmin(near_courant, 1.0f));
    float brought = (near - u) + near_share * (inside * central_slope(far, near, u));
    return wmax(inflow, 0.0f) * brought + wmin(inflow, 0.0f) * (share * own_slope);
}

FN float line_gain(float u, FaceLine at, float flux_low, float flux_high, float inv_sum, float low_courant, float high_courant) {
    float own = central_slope(at.low, u, at.high);
    return side_gain(flux_low, u, at.low, at.far_low, at.inside_low, -own, inv_sum, low_courant) +
           side_gain(-flux_high, u, at.high, at.far_high, at.inside_high, own, inv_sum, high_courant);
}

// What fluxes of second order bring, kept between a velocity and its four neighbours.
FN float between_neighbours(float moved, float u, float u_low, float u_high, float u_left, float u_right) {
    float least = wmin(u, wmin(wmin(u_low, u_high), wmin(u_left, u_right)));
    float most = wmax(u, wmax(wmax(u_low, u_high), wmax(u_left, u_right)));
    return wclamp(moved, least, most);
}

// advect_velocity with limited slopes, kept between u and its four neighbours: no new extremum at any time step. `centered` and the lines
// are the velocities that are advected, at the time of the height; u_*: the face's and its neighbours' own.
FN float advect_velocity_second_order(float u, float u_low, float u_high, float u_left, float u_right, float centered, FaceLine along, FaceLine across,
                                      float flux_low, float flux_high, float flux_left, float flux_right, float height, float inv_sum, float k, float dry) {
    float gain = line_gain(centered, along, flux_low, flux_high, inv_sum, k * wabs(along.low), k * wabs(along.high)) +
                 line_gain(centered, across, flux_left, flux_right, inv_sum, wabs(flux_left) * inv_sum, wabs(flux_right) * inv_sum);
    float moved = between_neighbours(u + gain * inv_sum, u, u_low, u_high, u_left, u_right);
    return height > dry ? moved : u;
}

// Gravity as a face may use it at this time step (NUMERICS 2.4b): the cap keeps the wave CFL number where the scheme
// damps instead of ringing, and gets tighter the faster the water moves.
FN float water_gravity(float gravity, float speed, float deepest, float k, float base, float inv_k2) {
    float margin = wmax(LEAST_GRAVITY_CAP, base - k * speed);
    float cap = margin * margin * inv_k2; // of gravity times depth
    bool over = gravity * deepest > cap;
    float used = gravity;
    if (UNIFORM(over)) used = over ? lean_quotient(cap, over ? deepest : 1.0f) : gravity; // hardly ever
    return used;
}

// The same for sand (NUMERICS 2.7): cap = 0.25/ks^2.
FN float sand_gravity(float gravity, float highest, float cap) {
    bool over = gravity * highest > cap;
    float used = gravity;
    if (UNIFORM(over)) used = over ? lean_quotient(cap, over ? highest : 1.0f) : gravity; // hardly ever
    return used;
}

// Wet/dry rule of sand and of water in it (NUMERICS 2.4c): true where a face must stand still, because both cells are dry, or because
// the wet one's surface does not stand above its dry neighbour.
FN bool blocked(float height_low, float height_high, float surface_low, float surface_high, float dry) {
    bool wet_low = height_low > dry;
    bool wet_high = height_high > dry;
    bool both_dry = both(!wet_low, !wet_high);
    bool wall_high = both(both(wet_low, !wet_high), surface_high >= surface_low);
    bool wall_low = both(both(wet_high, !wet_low), surface_low >= surface_high);
    return either(both_dry, either(wall_high, wall_low));
}

// A velocity that draws no water from a dry cell (NUMERICS 2.4c).
FN float leaving_wet(float u, float height_low, float height_high, float dry) {
    float low = height_low > dry ? 1.0f : 0.0f; // weights: with u in one arm of a selection g++ does not vectorise the row
    float high = height_high > dry ? 1.0f : 0.0f;
    return low * wmax(u, 0.0f) + high * wmin(u, 0.0f);
}

// Clamp of a velocity by its size, across being its other component at the face (NUMERICS 2.4d): a clamp by component would let water run
// faster along the diagonals of the grid.
FN float clamped_speed(float along, float across, float limit) {
    float finite = wclamp(along, -1.0e15f, 1.0e15f); // whose square is
    float size2 = finite * finite + across * across;
    bool over = size2 > limit * limit;
    float shortened = finite;
    if (UNIFORM(over)) shortened = finite * divide_or_zero(limit, wsqrt(size2)); // hardly ever
    return wclamp(over ? shortened : finite, -limit, limit);
}

// A velocity after rain, which brings none (NUMERICS 2.9); inv_sum: 1 over both cells' depths behind the rain.
FN float diluted(float velocity, float rain, float inv_sum) {
    float left = velocity;
    if (UNIFORM(rain > 0.0f)) left = velocity - velocity * wmin(rain * (2.0f * inv_sum), 1.0f);
    return left;
}

// Rest rule (NUMERICS 2.4e): a level and slow face stands still for ever.
FN bool at_rest(float surface_low, float surface_high, float u, float rest_surface, float rest_velocity) {
    return both(wabs(surface_high - surface_low) <= rest_surface, wabs(u) <= rest_velocity);
}

#endif
