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

// Slope across a face from the rises beside its two cells: of two cells' lengths, or of one where the grid ends and the ground goes on level.
FN float slope_across_face(float rise_low, float rise_high, bool whole, float inv_dx) { return (rise_low + rise_high) * ((whole ? 0.25f : 0.5f) * inv_dx); }

// Speed along the bed, squared.
FN float bed_speed2(BedCourse at) {
    float climb = at.slope_along * at.along + at.slope_across * at.across;
    return (at.along * at.along + at.across * at.across) + climb * climb;
}

// What flows into a face, each a sum over the sides that bring depth, times that depth over the face's own.
struct BedInflow {
    float along;  // velocity along the face's direction
    float speed;  // at least that along the bed of level ground
    float energy; // square of the speed along the bed
    float leaves; // how fast it would leave the face's bed, positive: where the ground falls away
    float bend;   // the square of that
};

// Of one side. share: of the face's depth that comes from there, negative: nothing does.
FN BedInflow bed_inflow(float share, BedCourse from, BedCourse own) {
    float brought = wmax(share, 0.0f);
    float leaves = (from.slope_along - own.slope_along) * from.along + (from.slope_across - own.slope_across) * from.across;
    BedInflow flows;
    flows.along = brought * from.along;
    flows.speed = brought * (wabs(from.along) + wabs(from.across));
    flows.energy = brought * bed_speed2(from);
    flows.leaves = brought * leaves;
    flows.bend = flows.leaves * leaves;
    return flows;
}

FN BedInflow both_inflows(BedInflow a, BedInflow b) {
    BedInflow sum;
    sum.along = a.along + b.along;
    sum.speed = a.speed + b.speed;
    sum.energy = a.energy + b.energy;
    sum.leaves = a.leaves + b.leaves;
    sum.bend = a.bend + b.bend;
    return sum;
}

// What all that flows in does to a face.
struct BedRide {
    float gain; // of its velocity [m/s]
    float lift; // what the bed adds to gravity [m/s2]
};

// It is turned into the face's bed, and its length given back. Sand that is asked to fall faster than gravity makes it flies: of the bend it
// follows the share that gravity can.
FN BedRide bed_ride(BedInflow all, BedCourse own, float gravity_dts, float inv_dts) {
    float normal2 = 1.0f + (own.slope_along * own.slope_along + own.slope_across * own.slope_across);
    float whole = normal2 * all.energy;
    bool follows = both(both(all.energy > 1.0e-24f, normal2 < 1.0e14f), normal2 * whole < 1.0e30f);
    bool bent = both(follows, all.bend > 1.0e-9f * whole); // less is rounding of heights
    bool flies = both(bent, all.leaves > gravity_dts);
    float gain = 0.0f;
    if (UNIFORM(bent)) {
        // Over the square of the bed's normal, so that the turn needs no quotient of its own.
        float longer = lean_root(lean_quotient(bent ? all.energy : 1.0f, bent ? normal2 * wmax(all.bend, whole - all.bend) : 1.0f));
        gain = (normal2 * all.along + own.slope_along * all.leaves) * longer - all.along;
        if (UNIFORM(flies)) gain = gain * lean_quotient(flies ? gravity_dts : 1.0f, flies ? all.leaves : 1.0f);
    }
    BedRide ride;
    ride.gain = bent ? gain : 0.0f;
    ride.lift = bent ? -wclamp(all.leaves, -all.speed, all.speed) * inv_dts : 0.0f;
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
