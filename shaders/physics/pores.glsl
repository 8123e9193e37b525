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
    return porosity < 1.0f ? whole_quanta(porosity * sand, quantum, inv_quantum) : sand;
}

// M alone.
FN float mixed_water(float water, float sand, float porosity, float quantum, float inv_quantum) {
    return wmin(water, pore_room(sand, porosity, quantum, inv_quantum));
}

FN PoreWater pore_water(float water, float sand, float porosity, float inv_porosity, float quantum, float inv_quantum) {
    float room = pore_room(sand, porosity, quantum, inv_quantum);
    bool part = water < room;
    float above = water > 0.0f ? water + (sand - room) : water; // some quanta of sand have room for none
    PoreWater w;
    w.mixed = wmin(water, room);
    w.depth = part ? wmin(water * inv_porosity, sand) : above;
    w.lifts = part ? inv_porosity : 1.0f;
    return w;
}

// Depth from the ground to the water's surface, 0 where there is none. With a porosity of 1 it is the water's own, in every bit.
FN float standing_depth(float water, float sand, float porosity, float inv_porosity, float quantum, float inv_quantum) {
    return pore_water(water, sand, porosity, inv_porosity, quantum, inv_quantum).depth;
}

// The same but for rounding to quanta, cheaper: for what asks for no level surface.
FN float standing_depth_roughly(float water, float sand, float porosity, float inv_porosity) {
    return wmin(water * inv_porosity, water + (1.0f - porosity) * sand);
}

// The water whose surface stands so deep above the ground: standing_depth backwards, not rounded.
FN float water_standing(float depth, float sand, float porosity, float quantum, float inv_quantum) {
    float room = pore_room(sand, porosity, quantum, inv_quantum);
    return depth < sand ? porosity * depth : depth - (sand - room);
}

#endif
