// Banks that run across the grid, as stairs of cells (NUMERICS 2.3).
#ifndef PHYSICS_STAIRS
#define PHYSICS_STAIRS
#include "../physics/velocity.glsl"

// Whether the corner of an upright bank stands beside a face (1, else 0): what comes past it from the left or right keeps the face's own
// velocity; any: that, or a corner at the end of one of its cells, where water must turn.
struct Stairs {
    float left, right, any;
};

// A face through which nothing runs stands at exactly 0.
FN float shut(float velocity) { return velocity == 0.0f ? 1.0f : 0.0f; }

// Whether a face around may be shut: without one no corner stands beside. A product of creeping ones may come to nothing, too.
FN bool touches_bank(Around at, float left_low, float left_high, float right_low, float right_high) {
    float along = (at.low * at.high) * (at.left * at.right);
    float across = (left_low * left_high) * (right_low * right_high);
    return either(along == 0.0f, across == 0.0f);
}

// Whether anything goes through the four sides of a face's control volume.
FN bool flows_through(float low, float high, float left, float right) { return (wabs(low) + wabs(high)) + (wabs(left) + wabs(right)) > 0.0f; }

// left_low, left_high, right_low, right_high: velocities across, at the faces on both sides of the face's two cells (NUMERICS 2.3).
FN Stairs stairs_beside(Around at, float left_low, float left_high, float right_low, float right_high) {
    float shut_left_low = shut(left_low);
    float shut_left_high = shut(left_high);
    float shut_right_low = shut(right_low);
    float shut_right_high = shut(right_high);
    float turns = wmax(shut(at.low) * wmax(shut_left_low, shut_right_low), shut(at.high) * wmax(shut_left_high, shut_right_high));
    float past_left = shut(at.left) * wabs(shut_left_low - shut_left_high);
    float past_right = shut(at.right) * wabs(shut_right_low - shut_right_high);
    Stairs bank;
    bank.left = wmax(turns, past_left);
    bank.right = wmax(turns, past_right);
    bank.any = wmax(bank.left, bank.right);
    return bank;
}

// What water that has turned into the axis within a cell brings beyond what comes from `near`, the velocity of the cell's far face: its speed,
// up to the face's own velocity. inflow, turned: what comes through the cell's middle, and what the cell gains across, as fluxes of
// advect_velocity; across_a, across_b: velocities at its faces across.
FN float turned_gain(float inflow, float turned, float own, float near, float across_a, float across_b) {
    float along = wabs(near);
    float across = wmax(wabs(across_a), wabs(across_b));
    float speed = wmax(along, across) + 0.25f * wmin(along, across); // of both, from 12 % below to 3 % above
    float faster = wclamp(own, -speed, speed) - near;
    float with_own = (own * 1.0e20f) * faster > 0.0f ? faster : 0.0f; // no product of both is next to nothing
    return wmin(wmax(turned, 0.0f), wmax(inflow, 0.0f)) * with_own;
}

#endif
