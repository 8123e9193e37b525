// Sand that follows the ground round its bends (NUMERICS 2.3): it keeps its speed along the bed, not along the plane, and presses on what
// bends it upward. And how far its head lifts it onto dry ground (2.4c).
#ifndef PHYSICS_BED_BENDS
#define PHYSICS_BED_BENDS
#include "../physics/scalar.glsl"

// Velocities and slopes of the ground at a face, along its direction and across it.
struct BedCourse {
    float along, across;
    float slope_along, slope_across;
};

// Slope across a face from the rises to the four cells beside its own two; those beyond the grid, 0 there, do not count.
FN float slope_across_face(float left_rises, float right_rises, bool inside_left, bool inside_right, float inv_dx) {
    return (left_rises + right_rises) * ((both(inside_left, inside_right) ? 0.25f : 0.5f) * inv_dx);
}

// Speed along the bed, squared.
FN float bed_speed2(BedCourse at) {
    float climb = at.slope_along * at.along + at.slope_across * at.across;
    return (square(at.along) + square(at.across)) + square(climb);
}

// What bends bring beside the velocities that flow in: to the face's velocity, times depth, and of vertical velocity that the ground takes.
struct BedBend {
    float gain;
    float asked;   // negative where the ground falls away
    float pressed; // the same, of steep bends no more than what comes
};

// inflow: depth that comes from the neighbour `from`, negative: nothing does. normal2: 1 + the square of the face's own slope.
FN BedBend bed_bend(float inflow, BedCourse from, BedCourse own, float normal2, float inv_normal2) {
    float brought = wmax(inflow, 0.0f);
    float leaves = (from.slope_along - own.slope_along) * from.along + (from.slope_across - own.slope_across) * from.across;
    float whole = normal2 * bed_speed2(from);
    leaves = square(leaves) > 1.0e-9f * whole ? leaves : 0.0f; // less is rounding of heights
    float off = square(leaves); // over the whole: square of the sine of the bend
    bool follows = both(whole > 1.0e-12f, whole < 1.0e30f);
    bool bent = both(follows, both(brought > 0.0f, off > 0.0f));
    float longer = 1.0f;
    if (UNIFORM(bent)) longer = lean_root(lean_quotient(bent ? whole : 1.0f, bent ? wmax(off, whole - off) : 1.0f));
    float turned = (from.along + own.slope_along * leaves * inv_normal2) * longer - from.along;
    float most = wabs(from.along) + wabs(from.across);
    BedBend b;
    b.gain = follows ? brought * turned : 0.0f;
    b.asked = -brought * leaves;
    b.pressed = -brought * wclamp(leaves, -most, most);
    return b;
}

FN BedBend both_bends(BedBend a, BedBend b) {
    BedBend sum;
    sum.gain = a.gain + b.gain;
    sum.asked = a.asked + b.asked;
    sum.pressed = a.pressed + b.pressed;
    return sum;
}

// What all that flows in does to a face.
struct BedRide {
    float gain; // of its velocity [m/s]
    float lift; // what the bed adds to gravity [m/s2]
};

// Sand that is asked to fall faster than gravity makes it flies: of the bend it follows the share that gravity can. inv_sum: 1 over the
// depth of both cells, to which the fluxes of all bends, of two faces each, belong.
FN BedRide bed_ride(BedBend bends, float inv_sum, float gravity_dts, float inv_dts) {
    float asked = bends.asked * inv_sum;
    bool flies = asked < wmin(-gravity_dts, -1.0e-20f);
    float share = lean_quotient(flies ? gravity_dts : 1.0f, flies ? -asked : 1.0f);
    BedRide ride;
    ride.gain = bends.gain * inv_sum * share;
    ride.lift = bends.pressed * inv_sum * inv_dts;
    return ride;
}

// Wet/dry rule of sand with a head (NUMERICS 2.4c): a face stands between dry cells, where it would fall from a dry one, or climb onto a dry
// one that is higher than the sand's top and its head. Away from a lower dry cell its velocity brings nothing, and is what holds a wall.
FN bool beyond_head(float u, float height_low, float height_high, float top_low, float top_high, float head2, float gravity, float dry) {
    bool dry_low = height_low <= dry;
    bool dry_high = height_high <= dry;
    float rise = 2.0f * gravity * (top_high - top_low);
    bool up = both(u > 0.0f, either(both(dry_low, either(dry_high, rise <= 0.0f)), both(dry_high, head2 <= rise)));
    bool down = both(u < 0.0f, either(both(dry_high, either(dry_low, rise >= 0.0f)), both(dry_low, head2 <= -rise)));
    return either(up, down);
}

#endif
