// Momentum that goes with water from one layer to the other (paper 3.4.2; NUMERICS 2.4a).
#ifndef PHYSICS_LAYER_EXCHANGE
#define PHYSICS_LAYER_EXCHANGE
#include "../physics/scalar.glsl"

// Momentum exchange between pure and mixed water when the boundary between them moves (paper 3.4.2; convex form,
// NUMERICS 2.4a): gained_* = mixed height after the split less before, of the two cells of the face.
FN void layer_exchange(REF(float) pure, REF(float) mixed, float gained_low, float gained_high, float pure_height, float mixed_height, float dry) {
    float to_mixed = 0.5f * (wmax(gained_low, 0.0f) + wmax(gained_high, 0.0f));
    float to_pure = 0.5f * (wmax(-gained_low, 0.0f) + wmax(-gained_high, 0.0f));
    float keep_mixed = wmax(mixed_height - to_pure, 0.0f);
    float keep_pure = wmax(pure_height - to_mixed, 0.0f);
    float mixed_total = keep_mixed + to_mixed;
    float pure_total = keep_pure + to_pure;
    // As increments: where nothing is exchanged both keep every bit, so a scene without sand has the same bits whether the
    // mixture is compiled in or not.
    float difference = pure - mixed;
    float to_mixed_share = lean_divide_or_zero(to_mixed, mixed_total) * difference;
    float to_pure_share = lean_divide_or_zero(to_pure, pure_total) * difference;
    mixed = mixed_total > dry ? mixed + to_mixed_share : mixed;
    pure = pure_total > dry ? pure - to_pure_share : pure;
}

// The same, passed over where nothing is exchanged.
FN void layer_exchange_if_any(REF(float) pure, REF(float) mixed, float gained_low, float gained_high, float pure_height, float mixed_height, float dry) {
    if (UNIFORM(wabs(gained_low) + wabs(gained_high) > 0.0f)) layer_exchange(pure, mixed, gained_low, gained_high, pure_height, mixed_height, dry);
}

// Water that enters sand through its side and not from above (NUMERICS 2.4f): how much of the depth of pure water in either cell of a
// face has the other cell's sand in front of it, while that has room in its pores.
struct Beside {
    float low, high;
};

// That depth of one cell. surface, top: of its water and of its sand; next_*: the same, and the ground, of the cell in front.
FN float depth_beside(float surface, float top, float next_surface, float next_top, float next_ground) {
    float facing = wmax(wmin(surface, next_top) - wmax(top, next_ground), 0.0f);
    return next_surface < next_top ? facing : 0.0f;
}

// What flows into sand from beside it is one with the water in there: both share their momentum. pure_*: depths of pure water;
// mixed_height: the face's mean depth of mixed water. A velocity that is to be flushed flows nowhere: it may be a denormal, 0 on some GPUs.
FN void enter_sand(REF(float) pure, REF(float) mixed, Beside beside, float pure_low, float pure_high, float mixed_height) {
    float facing = wmax(pure > 1.0e-20f ? beside.low : 0.0f, pure < -1.0e-20f ? beside.high : 0.0f);
    float donor = pure > 0.0f ? pure_low : pure_high;
    float share = donor > 1.0e-20f ? wmin(lean_quotient(facing, wmax(donor, 1.0e-20f)), 1.0f) : 0.0f; // less may be a denormal
    float entering = share * (0.5f * (pure_low + pure_high));
    float difference = share > 0.0f ? (pure - mixed) * lean_reciprocal(wmax(mixed_height + entering, 1.0e-20f)) : 0.0f;
    mixed = mixed + entering * difference;
    pure = pure - share * (mixed_height * difference);
}

#endif
