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

// The water whose surface stands so deep above the ground: standing_depth backwards, not rounded.
FN float water_standing(float depth, float sand, float porosity, float quantum, float inv_quantum) {
    float room = pore_room(sand, porosity, quantum, inv_quantum);
    return depth < sand ? porosity * depth : depth - (sand - room);
}

#endif
