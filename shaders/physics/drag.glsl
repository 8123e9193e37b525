// Momentum exchange (drag) between water and sand (paper 3.4.2, 4.2.3). It is solved in one closed form with Coulomb friction
// (coulomb_friction.glsl), so that sand at rest does not drag the water of a lake at rest (NUMERICS 2.8).
#ifndef PHYSICS_DRAG
#define PHYSICS_DRAG
#include "../physics/scalar.glsl"

// Coupling when one velocity stands for all water (single-layer water): momenta m = rho_w W and rho_s h_s, exchange kd h_m.
FN float drag_coupling_single(float water_height, float mixed_height, float sand_height, float water_density, float sand_density, float kd, float dry) {
    float m = water_density * water_height;
    float d = kd * mixed_height;
    float pair = divide_or_zero(m * d, m + d);
    float kappa = divide_or_zero(pair, sand_density * sand_height);
    return mixed_height > dry ? kappa : 0.0f;
}

// The water's share of it, by its own implicit equation: what the difference of both velocities loses to it.
FN float drag_share_single(float water_height, float mixed_height, float water_density, float kd) {
    float exchange = kd * mixed_height;
    return divide_or_zero(exchange, water_density * water_height + exchange);
}

// Explicit drag (paper 4.2.3, NUMERICS 2.14): impulse = dts c_e h_m, inertia = momentum per velocity of a layer [kg/m2].
FN void explicit_drag(REF(float) sand, REF(float) water, float impulse, float sand_inertia, float water_inertia) {
    float difference = sand - water;
    float lost = divide_or_zero(impulse * difference, sand_inertia);
    float gained = divide_or_zero(impulse * difference, water_inertia);
    sand = wclamp(sand - lost, -1.0e15f, 1.0e15f); // whose square is finite
    water = wclamp(water + gained, -1.0e15f, 1.0e15f);
}

// How freely water moves through sand, 0 up to the share of its pores that hold back and 1 where they are full or there is no sand
// (NUMERICS 2.19). water: the depth at which its surface stands.
FN float relative_permeability(float water, float sand, float retained, float inv_drainable) {
    bool partly = both(water > retained * sand, water < sand);
    float drainable = 0.0f;
    if (UNIFORM(partly)) drainable = partly ? wclamp((lean_divide_or_zero(water, sand) - retained) * inv_drainable, 0.0f, 1.0f) : 0.0f;
    return water < sand ? drainable * drainable * drainable : 1.0f;
}

// At a face: of the cell that the water leaves relative to the sand, of the freer one where it does not move against it.
FN float upstream_permeability(float relative, float low, float high) { return wmax(relative < 0.0f ? 0.0f : low, relative > 0.0f ? 0.0f : high); }

#endif
