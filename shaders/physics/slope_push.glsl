// The push of a slope of sand: gravity normal to it, with Coulomb's wedge as the limit (NUMERICS 2.18).
#ifndef PHYSICS_SLOPE_PUSH
#define PHYSICS_SLOPE_PUSH
#include "../physics/scalar.glsl"

// The sand's surface in a cell and the ground under it, and how far they may rise from there or to there: from a dry cell not at all.
struct SandTop {
    float height, ground, room;
};

FN SandTop sand_top(float ground, float sand, float dry) {
    SandTop top;
    top.height = ground + sand;
    top.ground = ground;
    top.room = sand > dry ? 1.0e15f : 0.0f;
    return top;
}

// Depth through which the sand of two cells touches: beside a brink not that of the pile below it.
FN float shared_depth(SandTop low, SandTop high) { return wmax(wmin(low.height, high.height) - wmax(low.ground, high.ground), 0.0f); }

// Rise of the sand's surface between two cells; 0 where the wet/dry rule blocks the face between them, so that sand along a steep
// dry wall is not lightened by the wall's slope.
FN float free_rise(SandTop low, SandTop high) { return wmax(wmin(high.height - low.height, high.room), -low.room); }

// Rise across a face: the mean of the four beside it, those beyond the grid being 0. low, high: the face's own cells.
FN float cross_rise(SandTop low_left, SandTop left, SandTop low, SandTop high, SandTop low_right, SandTop right, bool inside_left, bool inside_right) {
    float left_rises = free_rise(low_left, low) + free_rise(left, high);
    float right_rises = free_rise(low, low_right) + free_rise(high, right);
    return 0.25f * ((inside_left ? left_rises : 0.0f) + (inside_right ? right_rises : 0.0f));
}

// Share of the cohesion that a cliff of this height needs to push as hydrostatic sand does against its own tension.
FN float cohesive_share_of(float cohesion, float inv_height, float per_cohesion) { return wmin(1.0f, per_cohesion * cohesion * inv_height); }

// Of the deeper cell; of two that are as deep the larger one.
FN float of_deeper(float height_low, float height_high, float low, float high) {
    float even = wmax(low, high);
    float deeper = height_low > height_high ? low : high;
    return height_low == height_high ? even : deeper;
}

// What a slope leaves of weight and friction, and what Coulomb's wedge leaves of the push.
struct SlopeShares {
    float weight; // C = 1/(1 + chi s^2), s no steeper than the wedge's plane
    float push;   // r: less than 1 where it is steeper
};

FN SlopeShares level_shares() {
    SlopeShares s;
    s.weight = 1.0f;
    s.push = 1.0f;
    return s;
}

// rise: along the face's axis; rise_across: cross_rise; depth: the sand's on the higher side [m]; held: cohesive share.
FN SlopeShares slope_shares(float rise, float rise_across, float depth, float inv_dx, float chi, float wedge_slope, float wedge_slope2,
                            float wedge_weight, float held) {
    float along = rise * inv_dx;
    float across = rise_across * inv_dx;
    float slope2 = along * along + across * across; // counts beside 1 alone
    bool steep = slope2 > wedge_slope2;
    // One quotient for both: C where the wedge does not count, r where it does.
    float root = 1.0f;
    if (UNIFORM(steep)) root = lean_root(slope2);
    float quotient = lean_reciprocal(steep ? root : 1.0f + chi * slope2);
    float plane = wedge_slope * quotient;
    float cliff = wmin(depth * inv_dx * quotient, 1.0f); // a step in the ground counts no more than the sand upon it
    float weight = steep ? wedge_weight : quotient;
    // Without a part of the push that grows with the slope the thrust of a cliff within one cell would go to 0 on finer grids.
    float push = steep ? plane + 0.1f * wmax(cliff - plane, 0.0f) : 1.0f;
    SlopeShares s;
    s.weight = weight + held * (1.0f - weight);
    s.push = push + held * (1.0f - push);
    return s;
}

// The push as a fall along the face's axis [m]: the sand's own buoyant weight is limited by the wedge, the push of a sloping water surface
// is not. pure_rise: rise of the depth of pure water.
FN float slope_push(SlopeShares s, float rise, float pure_rise, float density_ratio) {
    float borne = minmod(-pure_rise, rise);
    return s.weight * (s.push * (rise - density_ratio * borne) + density_ratio * (pure_rise + borne));
}

// Rankine's coefficient of passive earth pressure, tan^2(45 deg + phi/2): how many times its own push sand can bear before it is
// pushed together.
FN float passive_coefficient(float friction) { return square(friction + lean_root(1.0f + square(friction))); }

#endif
