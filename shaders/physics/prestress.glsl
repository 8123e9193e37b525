// Strain of sand that lies in balance with its own weight (NUMERICS 2.20).
#ifndef PHYSICS_PRESTRESS
#define PHYSICS_PRESTRESS
#include "../physics/drag.glsl"
#include "../physics/pore_pressure.glsl"
#include "../physics/pores.glsl"
#include "../physics/slope_push.glsl"
#include "../physics/strain.glsl"
#include "../physics/velocity.glsl"

// Least share of its whole push that slope and wedge leave to a cliff of this cohesive share; level_least: C behind the steepest face.
FN float least_cliff_push(float held, float level_least) { return held * (level_least + held * (1.0f - level_least)); }

// Mean tension in a column of sand at which depth times tension takes up, face by face, what gravity pushes with. weight: what pushes, as a
// share of the sand's own. No tension holds down what is lighter than the water around it.
FN float balancing_tension(float height, float weight, float gravity, float sand_density) {
    return 0.5f * sand_density * gravity * height * wmax(0.0f, weight);
}

// What pushes by 2.7: water that is free to move stands level and carries its share of the sand, water that pores hold back leans on it.
FN float level_weight(float wet, float free, bool dragged, float density_ratio, float porosity) {
    float leans = dragged ? 1.0f - free : 0.0f;
    return 1.0f + density_ratio * (porosity * square(wet)) * (leans - free);
}

// V - I of equal tension all around: tr of (lambda + mu) tr/J = tension with J = exp(tr), by Newton's method, which from below closes
// in from below; no further than `largest_tr`. inv_bulk: 1/(lambda + mu).
FN float stretch_under(float tension, float inv_bulk, float largest_tr) {
    float strain = wmin(tension * inv_bulk, 0.36f); // 1/e is the most that any tr gives
    float tr = strain;
    for (int n = 0; n < 4; ++n) {
        float grown = strain * square(1.0f + exp_minus_one(0.5f * tr));
        tr = wdiv(grown * (1.0f - tr), 1.0f - grown);
    }
    return exp_minus_one(0.5f * wmin(tr, largest_tr));
}

// V - I of sand at rest and in balance, where its cohesion can hold it; 0 without prestress. cohesive: its cohesion follows the
// saturation, here the cell's own.
FN float in_balance(WorldParams world, float height, float water, bool cohesive) {
    if (world.prestress == 0.0f) return 0.0f;
    PoreWater within = pore_water(water, height, world.porosity, world.inv_porosity, world.quantum, world.inv_quantum);
    float saturation = cohesive ? divide_or_zero(within.depth, within.depth + height) : 0.0f;
    float c = cohesion(saturation, world.cohesion0, world.cohesion1, world.phi1, world.phi2, world.phi3, world.slope01, world.slope12,
                       world.slope23);
    c = wmin(c, world.cohesion_cap * height);
    float inv_height = divide_or_zero(1.0f, height);
    PoreShares pores = pore_shares(full_depth(within.depth, height, world.retained, world.inv_drainable), within.mixed, inv_height, world.porosity);
    float weight = effective_weight(pores, world.density_ratio, world.buoyancy);
    if (world.slope_normal == 0.0f) {
        weight = level_weight(divide_or_zero(wmin(within.depth, height), height),
                              relative_permeability(within.depth, height, world.retained, world.inv_drainable), world.drag_kd > 0.0f,
                              world.density_ratio, world.porosity);
    }
    float pushed = balancing_tension(height, weight, sand_gravity(world.gravity, height, world.sand_gravity_cap), world.sand_density);
    float least = least_cliff_push(wmin(1.0f, cohesive_share_of(c, lean_reciprocal_or_zero(height), world.cliff_share)), world.wedge_weight);
    return stretch_under(wmin(pushed * least, c * world.tip_pressure), world.inv_bulk, c * world.inv_yield_slope);
}

#endif
