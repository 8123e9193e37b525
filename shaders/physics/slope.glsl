// Slope-normal gravity of sand, with Coulomb's wedge as the limit of its push, and friction within sand that spreads (NUMERICS 2.18).
#ifndef PHYSICS_SLOPE
#define PHYSICS_SLOPE
#include "../physics/velocity.glsl"

// How far a cell lets the sand's surface rise from it or to it: a dry one not at all.
FN float rise_room(float sand, float dry) { return sand > dry ? 1.0e15f : 0.0f; }

// Rise of the sand's surface between two cells; 0 where the wet/dry rule blocks the face between them, so that sand along a steep
// dry wall is not lightened by the wall's slope. room_*: rise_room of both.
FN float free_rise(float top_low, float top_high, float room_low, float room_high) { return wmax(wmin(top_high - top_low, room_high), -room_low); }

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

// rise along the face's axis, cross_rise across it, sand's depth on the higher side [m]; held: cohesive share.
FN SlopeShares slope_shares(float rise, float cross_rise, float depth, float inv_dx, float chi, float wedge_slope, float wedge_slope2,
                            float wedge_weight, float held) {
    float along = rise * inv_dx;
    float across = cross_rise * inv_dx;
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

// The push's fall along the face's axis [m]: the sand's own buoyant weight is limited by the wedge, the push of a sloping water surface
// is not. pure_rise: rise of the depth of pure water.
FN float limited_fall(SlopeShares s, float rise, float pure_rise, float density_ratio) {
    float borne = minmod(-pure_rise, rise);
    return s.weight * (s.push * (rise - density_ratio * borne) + density_ratio * (pure_rise + borne));
}

// Rankine's coefficient of passive earth pressure, tan^2(45 deg + phi/2): how many times its own push sand can bear before it is
// pushed together.
FN float passive_coefficient(float friction) { return square(friction + lean_root(1.0f + square(friction))); }

// What is left of a velocity after the friction within a layer that thins while it slides: all for a block, at rest and where sand
// piles up. speed2: square of the old velocity; friction: b times what friction takes from a velocity in the substep.
FN float left_within(float growth, float least_height, float speed2, float wave_speed2, float friction) {
    float thinning = least_height * wmax(growth, 0.0f);
    float left = 1.0f;
    if (UNIFORM(thinning > 0.0f)) {
        float speed = lean_root(wmax(speed2 + 0.0025f * wave_speed2, 1.0e-20f)); // no less than a twentieth of that of waves
        float kept = wmax(0.0f, 1.0f - lean_divide_or_zero(friction * thinning, (speed + thinning) * speed));
        left = thinning > 0.0f ? kept : 1.0f;
    }
    return left;
}

#endif
