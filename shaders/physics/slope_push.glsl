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
    if (UNIFORM(steep)) root = lean_root(wmax(slope2, 1.0e-20f)); // as cliff_push has it
    float quotient = lean_reciprocal(steep ? root : 1.0f + by.chi * slope2);
    SlopeShares s;
    s.weight = steep ? by.wedge_weight : quotient;
    s.push = steep ? by.wedge_slope * quotient : 1.0f;
    s.base = 1.0f;
    s.slope2 = slope2;
    return s;
}

// The ground under cohesive sand. Its weight follows that, not the cliff.
struct Bed {
    float ground2; // square of its slope
    float slope2;  // of that as far as the surface falls with it
    float weight;  // C there
    float tilt;    // 1/C
};

FN Bed bed_under(Rise along, Rise across, float slope2, SlopeLaw by) {
    Bed bed;
    bed.ground2 = slope_squared(along.ground, across.ground, by.inv_dx);
    bed.slope2 = wmin(bed.ground2, slope2);
    bed.tilt = 1.0f + by.chi * wmin(bed.slope2, by.wedge_slope2);
    bed.weight = lean_reciprocal(bed.tilt);
    return bed;
}

// Whether a surface is steeper than its sand's friction and the ground under it. Where it is not, cohesive sand pushes whole.
FN bool is_cliff(float slope2, Bed bed, SlopeLaw by) { return slope2 > wmax(square(by.friction), wmin(bed.slope2, by.wedge_slope2)); }

// What the wedge above Culmann's (1875) plane pushes with more than its friction bears, in units of the weight: 0 at the inner friction's
// slope, the slope itself less a constant far beyond it.
FN float culmann_excess(float slope, float slope2, SlopeLaw by) {
    return lean_root((1.0f + slope2) * (1.0f + square(by.inner))) - 1.0f - by.inner * slope;
}

// r of a cliff whose cohesion holds one of its depth: as Culmann's plane has it, level and upright faces as they are. Against its excess
// stand the tension at the top, up to 2 s_f c, and the cohesion on the ground: both hold it up to the height that the plane gives it.
// weight: C of the surface's slope; depth: the sand's on the higher side [m].
FN float cliff_push(Rise along, Rise across, float slope2, Bed bed, float weight, float depth, SlopeLaw by) {
    float base2 = wmax(wmax(square(by.friction), bed.slope2), 1.0e-20f);
    float slope = lean_root(wmax(slope2, 1.0e-20f));
    float base = lean_root(base2);
    // One quotient for what is divided by the slope, by the ground's and by the depth.
    float tilted = base * (1.0f + by.chi * wmin(base2, by.wedge_slope2));
    float cells = wmax(depth * by.inv_dx, 1.0e-6f);
    float inverse = lean_reciprocal(slope * tilted * cells);
    float inv_slope = inverse * (tilted * cells);
    float inv_tilted = inverse * (slope * cells);
    float per_cell = slope * (inverse * (slope * tilted));
    float adhesion = 0.5f * by.adhesion;
    float drive = (by.rankine + adhesion * (inv_slope * weight)) * culmann_excess(slope, slope2, by);
    float drive_base = (by.rankine + adhesion * inv_tilted) * culmann_excess(base, base2, by);
    // Tension pulls by the rise of the depth: the surface's less the ground's, of which friction takes what lies askew.
    float follows = (along.surface * along.ground + across.surface * across.ground) * square(by.inv_dx) * inv_slope;
    float askew2 = wmax(bed.ground2 - square(follows), 0.0f);
    float grip = lean_root(wmax(square(by.friction * bed.weight) - askew2, 1.0e-20f));
    float at_rest = slope - wmax(follows + grip, 0.0f); // the least that balances the column's own tension (NUMERICS 2.20) within its friction
    float slides = bed.weight * wmin(base, by.wedge_slope);
    float upright = wmax(slides + (slope - base), at_rest); // what a column's own tension bears beside nothing
    float net = wmin(wmax(slides + (drive - drive_base), at_rest), upright);
    float within = depth > 0.0f ? wmin(1.0f, square(per_cell)) : 0.0f; // a wall that one cell holds is upright however coarse the grid
    net = net + within * (upright - net);
    return (slope > base ? net : bed.weight * wmin(slope, by.wedge_slope)) * (bed.tilt * inv_slope);
}

// What cohesion makes of the shares. push: r of cohesive sand; held: its cohesive share, 1 at most; strength: above 0 where there is any.
FN SlopeShares with_cohesion(SlopeShares dry, Bed bed, float push, float held, float strength) {
    SlopeShares s;
    s.weight = dry.weight + held * (bed.weight - dry.weight);
    s.push = dry.push + held * (push - dry.push);
    s.base = strength > 0.0f ? dry.weight * bed.tilt : 1.0f;
    s.slope2 = dry.slope2;
    return s;
}

// The push as a fall along the face's axis [m]: of the sand's own weight what pore pressure does not bear, limited by the wedge. Held water
// falls as its sand does: drag brings what its own surface has (table_rise), here is the rest.
FN float slope_push(SlopeShares s, float rise, float table_rise, PoreShares pores, float density_ratio, float buoyancy) {
    float own = s.weight * s.push * rise;
    return pushing_weight(pores, density_ratio, buoyancy) * own + density_ratio * pores.held * (own - table_rise);
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
    bool loose = both(low + high > 0.0f, s.slope2 < plane_slope2); // asked of the capped share, g++ -O3 leaves the loop over i scalar
    return both(loose, due != 0.0f) ? lacks : 0.0f;
}

// Share of its own weight's pressure that the stress of a cell bears (NUMERICS 2.7): none up to half the cohesion that holds an upright
// wall, whole where it does. cohesive: its cohesive share, not cut at 1.
FN float stress_share(float cohesive) { return wclamp(0.5f * cohesive - 1.0f, 0.0f, 1.0f); }

// What water meets where it drives sand uphill, as a rise: what the slope withholds of the push of level ground where stress bears the rest,
// of Rankine's passive one where there is none. weight: pushing_weight.
FN float withheld_push(float rise, SlopeShares s, float passive, float stressed, float weight) {
    float borne = passive + stressed * (1.0f - passive);
    return (borne - s.weight * s.push) * rise * weight;
}

// What is left of a push of water on grains, and of the withheld push, as falls.
struct GrainPush {
    float left, withheld;
};

// Where it drives them uphill against their own push it calls that forth: no more than it is, and no more than moves them up.
FN GrainPush met_by_slope(float own, float pushed, float withheld) {
    float uphill = withheld > 0.0f ? wmin(-(own + pushed), withheld) : wmin(own + pushed, -withheld);
    float called = wmin(wmax(uphill, 0.0f), wabs(pushed));
    float met = withheld > 0.0f ? called : -called;
    GrainPush push;
    push.left = pushed + met;
    push.withheld = withheld - met;
    return push;
}

#endif
