// Sand that follows the ground round its bends (NUMERICS 2.3): it keeps its speed along the bed, not along the plane, and presses on what
// bends it upward. And how far its head lifts it onto dry ground (2.4c).
#ifndef PHYSICS_BED_BENDS
#define PHYSICS_BED_BENDS
#include "../physics/scalar.glsl"

// Velocities at a face, along its direction and across it, and how far the ground rises there on a cell's length.
struct BedCourse {
    float along, across;
    float rise_along, rise_across;
};

// Rise across a face from those beside its two cells: of two cells' lengths, or of one where the grid ends and the ground goes on level.
FN float rise_across_face(float rise_low, float rise_high, bool whole) { return (rise_low + rise_high) * (whole ? 0.25f : 0.5f); }

// Speed along the bed, squared.
FN float bed_speed2(BedCourse at, float inv_dx) {
    float climb = (at.rise_along * at.along + at.rise_across * at.across) * inv_dx;
    return (at.along * at.along + at.across * at.across) + climb * climb;
}

// What flows into a face: sums over the sides that bring depth, of velocities times that depth over the face's own.
struct BedInflow {
    float along, across;
    float climbs; // upward on the ground it comes from, times a cell's length
    float speed;  // at least that along level ground
};

// Of one side. share: of the face's depth that comes from there, negative: nothing does.
FN BedInflow bed_inflow(float share, BedCourse from) {
    float brought = wmax(share, 0.0f);
    BedInflow flows;
    flows.along = brought * from.along;
    flows.across = brought * from.across;
    flows.climbs = flows.along * from.rise_along + flows.across * from.rise_across;
    flows.speed = wabs(flows.along) + wabs(flows.across);
    return flows;
}

FN BedInflow both_inflows(BedInflow a, BedInflow b) {
    BedInflow sum;
    sum.along = a.along + b.along;
    sum.across = a.across + b.across;
    sum.climbs = a.climbs + b.climbs;
    sum.speed = a.speed + b.speed;
    return sum;
}

// What all that flows in does to a face.
struct BedRide {
    float gain; // of its velocity [m/s]
    float lift; // what the bed adds to gravity [m/s2]
};

// It mixes, is turned into the face's bed, and its length given back. Sand that is asked to fall faster than gravity makes it flies: of the
// bend it follows the share that gravity can. rise_*: of the face's ground on a cell's length.
FN BedRide bed_ride(BedInflow all, float rise_along, float rise_across, float inv_dx, float gravity_dts, float inv_dts) {
    float slope_along = rise_along * inv_dx;
    float slope_across = rise_across * inv_dx;
    float climbs = all.climbs * inv_dx;
    float leaves = climbs - (slope_along * all.along + slope_across * all.across); // the bed, positive: where the ground falls away
    float normal2 = 1.0f + (slope_along * slope_along + slope_across * slope_across);
    float energy = (all.along * all.along + all.across * all.across) + climbs * climbs;
    float whole = normal2 * energy;
    float bend = leaves * leaves; // whole times the square of the bend's sine
    bool follows = both(both(energy > 1.0e-24f, normal2 < 1.0e14f), normal2 * whole < 1.0e30f);
    bool bent = both(follows, bend > 1.0e-9f * whole); // less is rounding of heights
    bool flies = both(bent, leaves > gravity_dts);
    // Over the square of the bed's normal, so that the turn needs no quotient of its own.
    float longer = lean_root(lean_quotient(bent ? energy : 1.0f, bent ? normal2 * wmax(bend, whole - bend) : 1.0f));
    float gain = (normal2 * all.along + slope_along * leaves) * longer - all.along;
    if (UNIFORM(flies)) gain = gain * lean_quotient(flies ? gravity_dts : 1.0f, flies ? leaves : 1.0f);
    BedRide ride;
    ride.gain = bent ? gain : 0.0f;
    ride.lift = bent ? -wclamp(leaves, -all.speed, all.speed) * inv_dts : 0.0f;
    return ride;
}

// Wet/dry rule of sand with a head (NUMERICS 2.4c): a face stands between dry cells, where it would fall from a dry one, or climb onto a dry
// one that is higher than the sand's top and its head. Away from a lower dry cell its velocity brings nothing, and is what holds a wall.
FN bool beyond_head(float u, float height_low, float height_high, float top_low, float top_high, float head2, float gravity, float dry) {
    bool dry_low = height_low <= dry;
    bool dry_high = height_high <= dry;
    float rise = top_high - top_low;
    float head2_up = 2.0f * gravity * rise;
    bool up = both(u > 0.0f, either(both(dry_low, either(dry_high, rise <= 0.0f)), both(dry_high, head2 <= head2_up)));
    bool down = both(u < 0.0f, either(both(dry_high, either(dry_low, rise >= 0.0f)), both(dry_low, head2 <= -head2_up)));
    return either(up, down);
}

#endif
