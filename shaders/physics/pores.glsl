// How much water sand takes up and where its surface then stands: the one place that knows pores (NUMERICS 2.23). Every stage asks here.
#ifndef PHYSICS_PORES
#define PHYSICS_PORES
#include "../physics/scalar.glsl"

// Water in a cell.
struct PoreWater {
    float mixed; // M: of it in pores [m of water]
    float depth; // from the ground to its surface as it stands: in full pores or above the sand [m]
    float lifts; // by how much a depth of water that comes lifts that surface
};

// P: depth of water that the pores of so much sand hold, in whole quanta. No branch spares a porosity of 1 here: on GPUs branches cost more
// than what they spare.
FN float pore_room(float sand, float porosity, float quantum, float inv_quantum) {
    return whole_quanta(porosity * sand, quantum, inv_quantum);
}

// M alone.
FN float mixed_water(float water, float sand, float porosity, float quantum, float inv_quantum) {
    return wmin(water, pore_room(sand, porosity, quantum, inv_quantum));
}

// Depth from the ground to the water's surface, 0 where there is none. With a porosity of 1 it is the water's own, in every bit.
FN float standing_depth(float water, float sand, float porosity, float inv_porosity, float quantum, float inv_quantum) {
    float room = pore_room(sand, porosity, quantum, inv_quantum);
    float within = wmin(water * inv_porosity, sand);
    float above = water > 0.0f ? water + (sand - room) : 0.0f; // some quanta of sand have room for none
    return water < room ? within : above;
}

FN PoreWater pore_water(float water, float sand, float porosity, float inv_porosity, float quantum, float inv_quantum) {
    PoreWater w;
    w.mixed = mixed_water(water, sand, porosity, quantum, inv_quantum);
    w.depth = standing_depth(water, sand, porosity, inv_porosity, quantum, inv_quantum);
    w.lifts = water < pore_room(sand, porosity, quantum, inv_quantum) ? inv_porosity : 1.0f;
    return w;
}

// The same but for rounding to quanta, cheaper: for what asks for no level surface.
FN float standing_depth_roughly(float water, float sand, float porosity, float inv_porosity) {
    return wmin(water * inv_porosity, water + (1.0f - porosity) * sand);
}

// Where pores fill at a rate (NUMERICS 2.24): what they hold at most, by the field water_in_pores.
FN float most_in_pores(float held) { return held < 0.0f ? 1.0e9f : held; }

// They then hold `held` at most, and what is more than that waits above, on top of the sand.
// What is in them stands in their lower part until they are full.
FN PoreWater waiting_water(float water, float sand, float held, float porosity, float inv_porosity, float quantum, float inv_quantum) {
    float room = pore_room(sand, porosity, quantum, inv_quantum);
    PoreWater w;
    w.mixed = wmin(wmin(water, room), most_in_pores(held));
    bool full = w.mixed >= room;
    float within = wmin(w.mixed * inv_porosity, sand);
    float above = water > 0.0f ? water + (sand - room) : 0.0f;
    w.depth = full ? above : within;
    w.lifts = full ? 1.0f : inv_porosity;
    return w;
}

// Depth from the ground to the surface that is seen: that of water which waits above, else of what is in the sand.
FN float standing_on_sand(float water, float sand, float held, float porosity, float inv_porosity, float quantum, float inv_quantum) {
    PoreWater w = waiting_water(water, sand, held, porosity, inv_porosity, quantum, inv_quantum);
    return water > w.mixed ? sand + (water - w.mixed) : w.depth;
}

// The depth whose waves water above and inside the sand has together.
FN float coupled_depth(float water, float mixed, float inv_porosity) { return mixed * inv_porosity + (water - mixed); }

// The least depth of sand whose pores hold so much, but for a quantum.
FN float sand_holding(float mixed, float porosity, float inv_porosity, float quantum, float inv_quantum) {
    float sand = whole_quanta(mixed * inv_porosity, quantum, inv_quantum);
    sand = sand + (pore_room(sand, porosity, quantum, inv_quantum) < mixed ? quantum : 0.0f);
    return sand + (pore_room(sand, porosity, quantum, inv_quantum) < mixed ? quantum : 0.0f);
}

// The water whose surface stands so deep above the ground: standing_depth backwards, not rounded.
FN float water_standing(float depth, float sand, float porosity, float quantum, float inv_quantum) {
    float room = pore_room(sand, porosity, quantum, inv_quantum);
    return depth < sand ? porosity * depth : depth - (sand - room);
}

#endif
