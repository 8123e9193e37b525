// The push of a slope of sand: gravity normal to it, with Coulomb's wedge as the limit (NUMERICS 2.18).
#ifndef PHYSICS_SLOPE_PUSH
#define PHYSICS_SLOPE_PUSH
#include "../physics/pore_pressure.glsl"
#include "../physics/scalar.glsl"

// The sand's surface in a cell and the ground under it, and how far they may rise from there or to there: from a dry cell not at all.
struct SandTop {
    float height, ground, sand, room;
};

FN SandTop sand_top(float ground, float sand, float dry) {
    SandTop top;
    top.height = ground + sand;
    top.ground = ground;
    top.sand = sand;
    top.room = sand > dry ? 1.0e15f : 0.0f;
    return top;
}

// Depth through which the sand of two cells touches: beside a brink not that of the pile below it.
FN float shared_depth(SandTop low, SandTop high) { return wmax(wmin(low.height, high.height) - wmax(low.ground, high.ground), 0.0f); }

// The same in all four cells around a corner.
FN float touching(SandTop low_left, SandTop low_right, SandTop high_left, SandTop high_right) {
    float surface = wmin(wmin(low_left.height, high_right.height), wmin(low_right.height, high_left.height));
    float ground = wmax(wmax(low_left.ground, high_right.ground), wmax(low_right.ground, high_left.ground));
    return wmax(surface - ground, 0.0f);
}

// Rises between two cells, of the sand's surface and of the ground under it.
struct Rise {
    float surface, ground;
};

FN float rise_within(float rise, float room_low, float room_high) { return wmax(wmin(rise, room_high), -room_low); }

FN Rise rise_between(SandTop low, SandTop high) {
    Rise rise;
    rise.surface = high.height - low.height;
    rise.ground = high.ground - low.ground;
    return rise;
}

// 0 where the wet/dry rule blocks the face between them, so that sand along a steep dry wall is not lightened by the wall's slope.
FN Rise free_rise(SandTop low, SandTop high) {
    Rise rise;
    rise.surface = rise_within(high.height - low.height, low.room, high.room);
    rise.ground = rise_within(high.ground - low.ground, low.room, high.room);
    return rise;
}

FN Rise mean_rise(Rise a, Rise b) {
    Rise rise;
    rise.surface = 0.5f * (a.surface + b.surface);
    rise.ground = 0.5f * (a.ground + b.ground);
    return rise;
}

// Rise across a face: the mean of the four beside it, those beyond the grid being 0. low, high: the face's own cells.
FN Rise cross_rise(SandTop low_left, SandTop left, SandTop low, SandTop high, SandTop low_right, SandTop right, bool inside_left, bool inside_right) {
    Rise left_rise = mean_rise(free_rise(low_left, low), free_rise(left, high));
    Rise right_rise = mean_rise(free_rise(low, low_right), free_rise(high, right));
    Rise rise;
    rise.surface = 0.5f * ((inside_left ? left_rise.surface : 0.0f) + (inside_right ? right_rise.surface : 0.0f));
    rise.ground = 0.5f * ((inside_left ? left_rise.ground : 0.0f) + (inside_right ? right_rise.ground : 0.0f));
    return rise;
}

// Cohesion in quarters of what a cliff of this height needs to push as hydrostatic sand does against its own tension.
FN float cohesive_share_of(float cohesion, float inv_height, float per_cohesion) { return wmin(per_cohesion * cohesion * inv_height, 1.0e6f); }

// Of the deeper cell; of two that are as deep the larger one.
FN float of_deeper(float height_low, float height_high, float low, float high) {
    float even = wmax(low, high);
    float deeper = height_low > height_high ? low : high;
    return height_low == height_high ? even : deeper;
}

// What a world's sand pushes with and is held by on a slope.
struct SlopeLaw {
    float inv_dx;
    float chi;           // how far weight follows the slope
    float wedge_slope;   // s*
    float wedge_slope2;
    float wedge_weight;  // C there
    float friction;      // mu on the ground
    float inner;         // c_f within the sand
    float rankine;       // s_f = tan(45 deg + phi_f/2)
    float adhesion;      // share of its cohesion that clings to the ground
};

// What a slope leaves of weight and friction, and what Coulomb's wedge leaves of the push.
struct SlopeShares {
    float weight; // C = 1/(1 + chi s^2), s no steeper than the wedge's plane
    float push;   // r: less than 1 where it is steeper
    float base;   // of the cohesion on the ground: columns of a face that is steeper than the ground do not slide on it
    float slope2; // s^2
};

FN SlopeShares level_shares() {
    SlopeShares s;
    s.weight = 1.0f;
    s.push = 1.0f;
    s.base = 1.0f;
    s.slope2 = 0.0f;
    return s;
}

// Square of a slope whose rises along the face's axis and across it are these. Counts beside 1 alone.
FN float slope_squared(float along, float across, float inv_dx) {
    float a = along * inv_dx;
    float b = across * inv_dx;
    return a * a + b * b;
}

// Of sand without cohesion. slope2: square of its surface's slope.
FN SlopeShares slope_shares(float slope2, SlopeLaw by) {
    bool steep = slope2 > by.wedge_slope2;
    // One quotient for both: C where the wedge does not count, r where it does.
    float root = 1.0f;
    if (UNIFORM(steep)) root = lean_root(slope2);
    float quotient = lean_reciprocal(steep ? root : 1.0f + by.chi * slope2);
    SlopeShares s;
    s.weight = steep ? by.wedge_weight : quotient;
    s.push = steep ? by.wedge_slope * quotient : 1.0f;
    s.base = 1.0f;
    s.slope2 = slope2;
    return s;
}

// By how much more than its friction a face of this slope pushes, in units of the weight. Against it stand the tension at its top, up to
// 2 s_f c, and the cohesion on the ground under it: both hold it up to the height that Culmann's (1875) plane gives it. 0 at the inner
// friction's slope, the slope itself less a constant far beyond it.
FN float culmann_drive(float slope, SlopeLaw by) {
    float slope2 = square(slope);
    float plane = lean_root((1.0f + slope2) * (1.0f + square(by.inner))) - 1.0f - by.inner * slope;
    float ground = 0.5f * by.adhesion * lean_reciprocal(slope * (1.0f + by.chi * wmin(slope2, by.wedge_slope2)));
    return (by.rankine + ground) * plane;
}

// r of such a face as Culmann's plane has it, level and upright ones as they are. bed: the ground's slope; weight: C of that; at_rest: the
// least push that balances the column's own tension (NUMERICS 2.20) within its friction; within_cell: share of a wall that one cell
// holds, which is upright however coarse the grid.
FN float culmann_push(float slope, float bed, float weight, float at_rest, float within_cell, SlopeLaw by) {
    float base = wmax(by.friction, bed);
    float wedge = wmax(by.friction, by.wedge_slope);
    float slides = weight * wmin(base, wedge);
    float upright = wmax(slides + (slope - base), at_rest); // what a column's own tension bears beside nothing
    float net = slides + (culmann_drive(slope, by) - culmann_drive(base, by));
    net = wmin(wmax(net, at_rest), upright);
    net = net + within_cell * (upright - net);
    return lean_quotient(slope > base ? net : weight * wmin(slope, wedge), weight * slope);
}

// r of sand whose cohesion holds a cliff of its depth, steeper than its friction and its bed: Culmann's plane.
FN float cohesive_push(Rise along, Rise across, float slope2, float ground2, float bed2, float weight, float depth, SlopeLaw by) {
    float slope = lean_root(wmax(slope2, 1.0e-20f));
    float bed = lean_root(wmax(bed2, 1.0e-20f));
    // Tension pulls by the rise of the depth: the surface's less the ground's, of which friction takes what lies askew.
    float follows = lean_quotient((along.surface * along.ground + across.surface * across.ground) * square(by.inv_dx), slope);
    float askew2 = wmax(ground2 - square(follows), 0.0f);
    float grip = lean_root(wmax(square(by.friction * weight) - askew2, 1.0e-20f));
    float at_rest = slope - wmax(follows + grip, 0.0f);
    float per_cell = slope * lean_reciprocal_or_zero(depth * by.inv_dx);
    return culmann_push(slope, bed, weight, at_rest, wmin(1.0f, square(per_cell)), by);
}

// Of such sand: its weight follows the ground, not the cliff.
FN SlopeShares cohesive_shares(SlopeShares dry, Rise along, Rise across, float slope2, float depth, SlopeLaw by) {
    float ground2 = slope_squared(along.ground, across.ground, by.inv_dx);
    float bed2 = wmin(ground2, slope2); // as far as the surface falls with it
    float tilt = 1.0f + by.chi * wmin(bed2, by.wedge_slope2);
    SlopeShares s;
    s.weight = lean_reciprocal(tilt);
    s.base = dry.weight * tilt;
    s.slope2 = slope2;
    bool steep = slope2 > wmax(square(by.friction), wmin(bed2, by.wedge_slope2)); // else it pushes whole
    s.push = 1.0f;
    if (UNIFORM(steep)) s.push = steep ? cohesive_push(along, across, slope2, ground2, bed2, s.weight, depth, by) : 1.0f;
    return s;
}

// Of sand on any slope. held: its cohesive share, 1 at most; strength: above 0 where there is any cohesion.
FN SlopeShares shares_on_slope(Rise along, Rise across, float depth, float held, float strength, SlopeLaw by) {
    float slope2 = slope_squared(along.surface, across.surface, by.inv_dx);
    SlopeShares s = slope_shares(slope2, by);
    if (UNIFORM(strength > 0.0f)) {
        SlopeShares whole = cohesive_shares(s, along, across, slope2, depth, by);
        s.weight = s.weight + held * (whole.weight - s.weight);
        s.push = s.push + held * (whole.push - s.push);
        s.base = strength > 0.0f ? whole.base : 1.0f;
    }
    return s;
}

// The push as a fall along the face's axis [m]: of the sand's own weight what pore pressure does not bear, limited by the wedge. Held water
// falls as its sand does: drag brings what its own surface has (table_rise), here is the rest.
FN float slope_push(SlopeShares s, float rise, float table_rise, PoreShares pores, float density_ratio) {
    float own = s.weight * s.push * rise;
    return pushing_weight(pores, density_ratio) * own + density_ratio * pores.held * (own - table_rise);
}

// Highest plane through a cell that is no steeper than the failing one from any neighbour, nor above the sand nor below the ground: sides and
// corners are the lowest of the planes there, rises what the plane gains on the way.
FN float failing_plane(float ground, float top, float sides, float corners, float rise) {
    return wmax(ground, wmin(top, wmin(sides + rise, corners + 1.41421356f * rise)));
}

// Share of a face's sand that lies above the failing plane. low, high: depths above it in both cells.
FN float wedge_share(float low, float high, float inv_sum) { return wmin((low + high) * inv_sum, 1.0f); }

// Fall [m] that a face's push lacks so that the wedge above the failing plane slides as a whole: what friction takes and, of the share of the
// column that lies above the plane, what the plane's slope leaves; times the plane's own fall, up to all of it. low, high: depths above the
// plane; friction_fall: mu dx; wedge_fall: what is left of the push on the plane, times dx. Of sand that weighs 1.
FN float wedge_push(SlopeShares s, float rise, float low, float high, float inv_sum, float friction_fall, float wedge_fall,
                    float inv_plane_rise, float plane_slope2) {
    float share = wedge_share(low, high, inv_sum);
    float towards = wclamp((rise - (high - low)) * inv_plane_rise, -1.0f, 1.0f);
    float due = (friction_fall * s.weight + share * wedge_fall) * towards;
    float own = s.weight * s.push * rise;
    float lacks = due > 0.0f ? wmax(due - own, 0.0f) : wmin(due - own, 0.0f);
    bool loose = both(share > 0.0f, s.slope2 < plane_slope2);
    return both(loose, due != 0.0f) ? lacks : 0.0f;
}

// Rankine's coefficient of passive earth pressure, tan^2(45 deg + phi/2): how many times its own push sand can bear before it is
// pushed together.
FN float passive_coefficient(float friction) { return square(friction + lean_root(1.0f + square(friction))); }

// Share of its own weight's pressure that the stress of a cell bears (NUMERICS 2.7): none up to half the cohesion that holds an upright
// wall, whole where it does. cohesive: its cohesive share, not cut at 1.
FN float stress_share(float cohesive) { return wclamp(0.5f * cohesive - 1.0f, 0.0f, 1.0f); }

// What water meets where it drives sand uphill, as a rise: what the slope withholds of the push of level ground where stress bears the rest,
// of Rankine's passive one where there is none. weight: pushing_weight.
FN float withheld_push(float rise, SlopeShares s, float friction, float stressed, float weight) {
    float passive = passive_coefficient(friction);
    float borne = passive + stressed * (1.0f - passive);
    return (borne - s.weight * s.push) * rise * weight;
}

#endif
