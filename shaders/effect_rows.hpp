// What each bit of effects.h is to a user, and what it needs: a row per effect and per choice of method. stagec compiles no mask
// that lacks what it needs; the engine adds when each is on (engine/settings/rules/effect_table.cpp).
#pragma once
#include "effects.h"
#include <cstddef>
#include <cstdint>
#include <iterator>

namespace wadi {

struct EffectRow {
    std::uint32_t bit;
    const char* name;    // as level files write it
    std::uint32_t needs; // bits that must be on as well
    const char* meaning;
};

/// Effects of a level's content, in the order of their bits; what a row needs stands above it.
inline constexpr EffectRow effect_rows[] = {
    {EFFECT_WATER, "water", 0, "water that flows over the ground"},
    {EFFECT_SAND, "sand", 0, "sand that flows, with Coulomb friction on the ground"},
    {EFFECT_MIXTURE, "mixture", EFFECT_WATER | EFFECT_SAND, "a second water layer inside the sand with its own velocity"},
    {EFFECT_DIFFUSION, "diffusion", EFFECT_MIXTURE, "water spreads inside sand"},
    {EFFECT_DRAG, "drag", EFFECT_WATER | EFFECT_SAND, "momentum exchange between water and sand"},
    {EFFECT_ELASTOPLASTIC, "elastoplastic", EFFECT_SAND, "sand holds its shape: strain, stress and yield"},
    {EFFECT_COHESION, "cohesion", EFFECT_ELASTOPLASTIC | EFFECT_WATER, "cohesion follows the saturation of the sand"},
    {EFFECT_SOURCES, "sources", 0, "points, discs and boxes that add or take water or sand"},
    {EFFECT_RAIN, "rain", EFFECT_WATER, "rain and evaporation"},
    {EFFECT_OPEN_SIDES, "open_sides", 0, "sides with discharge, level or outflow"},
    {EFFECT_BED_FRICTION, "bed_friction", EFFECT_WATER, "friction of pure water on its bed"},
    {EFFECT_BED_SHEAR, "bed_shear", EFFECT_MIXTURE, "pure water drags the sand under it along: bed load"},
    {EFFECT_SLOPE_NORMAL, "slope_normal", EFFECT_SAND,
     "weight and friction of sand normal to its slope, pushes no steeper than Coulomb's wedge"},
    {EFFECT_INTERNAL_FRICTION, "internal_friction", EFFECT_SAND,
     "sand that spreads or shears in its plane is slowed from within"},
    {EFFECT_RETENTION, "retention", EFFECT_MIXTURE | EFFECT_DRAG, "pores hold back a share of the water: damp sand stays damp"},
    {EFFECT_ROUGHNESS, "roughness", EFFECT_BED_FRICTION, "Manning's n from cell to cell"},
};

/// Choices of method: bits of the same mask above those, from `method` and never from content. Without what it needs a choice has
/// nothing to act on.
inline constexpr EffectRow choice_rows[] = {
    {EFFECT_SEMI_LAGRANGIAN, "semi_lagrangian", 0, "velocities are traced back instead of moved by the mass fluxes"},
    {EFFECT_WHOLE_STRAIN, "whole_strain", EFFECT_ELASTOPLASTIC, "sand keeps F with its rotation and moves it ahead of friction"},
    {EFFECT_DIRECT_STRAIN, "direct_strain", EFFECT_WHOLE_STRAIN, "F is moved as it is, not as angle and stretch"},
    {EFFECT_EXPLICIT_DRAG, "explicit_drag", EFFECT_DRAG, "drag is an explicit step of its own ahead of friction"},
    {EFFECT_LAPLACE_DIFFUSION, "laplace_diffusion", EFFECT_DIFFUSION, "mixed water spreads by the Laplacian of its height"},
    {EFFECT_SECOND_ORDER_WATER, "second_order_water", EFFECT_WATER,
     "heights and flux-form velocities of water move by limited slopes"},
    {EFFECT_HALF_STORAGE, "half_storage", 0, "velocities and stretch lie in memory as 16-bit floats"},
    {EFFECT_SECOND_ORDER_SAND, "second_order_sand", EFFECT_SAND,
     "heights and flux-form velocities of sand move by limited slopes"},
    {EFFECT_SHOCK_VISCOSITY, "shock_viscosity", EFFECT_WATER,
     "numerical viscosity of water where it is compressed: bores do not ring"},
    {EFFECT_WHOLE_PRESSURE, "whole_pressure", EFFECT_MIXTURE, "the water's slope pushes mixed water once a water step"},
    {EFFECT_EXPLICIT_EXCHANGE, "explicit_exchange", EFFECT_MIXTURE | EFFECT_SEMI_LAGRANGIAN | EFFECT_WHOLE_PRESSURE,
     "water that changes layer accelerates both"},
    {EFFECT_DIFFUSION_AHEAD, "diffusion_ahead", EFFECT_LAPLACE_DIFFUSION | EFFECT_SEMI_LAGRANGIAN,
     "mixed water spreads ahead of transport"},
    {EFFECT_ALGORITHM_1, "algorithm_1", EFFECT_SAND | EFFECT_SEMI_LAGRANGIAN,
     "the sand substep of the paper's Algorithm 1, unguarded"},
    {EFFECT_CENTRAL_SHEAR, "central_shear", EFFECT_WHOLE_STRAIN | EFFECT_ALGORITHM_1,
     "shear at corners is the mean of depth times stress"},
    {EFFECT_STRAIN_BEYOND, "strain_beyond", EFFECT_WHOLE_STRAIN | EFFECT_ALGORITHM_1,
     "velocity, angle and stretch go on beyond the rim of the sand"},
};

inline constexpr std::uint32_t all_effects = (1u << std::size(effect_rows)) - 1;

/// Half storage is for worlds that trade accuracy for memory; a method that does the opposite, or the paper's own, has no kernels
/// for it.
inline constexpr std::uint32_t never_half = EFFECT_SEMI_LAGRANGIAN | EFFECT_WHOLE_STRAIN | EFFECT_EXPLICIT_DRAG |
                                            EFFECT_LAPLACE_DIFFUSION | EFFECT_SECOND_ORDER_WATER | EFFECT_SECOND_ORDER_SAND |
                                            EFFECT_WHOLE_PRESSURE;

/// The stages of Algorithm 1 know nothing of these.
inline constexpr std::uint32_t never_algorithm_1 =
    EFFECT_SLOPE_NORMAL | EFFECT_INTERNAL_FRICTION | EFFECT_RETENTION | EFFECT_DIRECT_STRAIN | EFFECT_SECOND_ORDER_SAND;

/// The mask with all that its effects and choices need.
constexpr std::uint32_t with_needs(std::uint32_t mask) {
    for (std::uint32_t before = ~mask; before != mask;) {
        before = mask;
        for (const auto& row : effect_rows) mask |= (mask & row.bit) != 0 ? row.needs : 0;
        for (const auto& row : choice_rows) mask |= (mask & row.bit) != 0 ? row.needs : 0;
    }
    return mask;
}

/// True when every effect in the mask and choice in the mask has what it needs, half storage no choice that is without it, and
/// Algorithm 1 strain and drag as the paper has them.
constexpr bool is_legal(std::uint32_t mask) {
    const auto both_or_neither = [mask](std::uint32_t one, std::uint32_t other) {
        return ((mask & one) != 0) == ((mask & other) != 0);
    };
    const bool algorithm_1 = (mask & never_algorithm_1) == 0 && both_or_neither(EFFECT_ELASTOPLASTIC, EFFECT_WHOLE_STRAIN) &&
                             both_or_neither(EFFECT_DRAG, EFFECT_EXPLICIT_DRAG);
    return with_needs(mask) == mask && ((mask & EFFECT_HALF_STORAGE) == 0 || (mask & never_half) == 0) &&
           ((mask & EFFECT_ALGORITHM_1) == 0 || algorithm_1);
}

constexpr bool rows_follow_bits() {
    std::uint32_t next = 1;
    for (const auto& row : effect_rows) {
        if (row.bit != next || row.needs >= next) return false;
        next *= 2;
    }
    for (const auto& row : choice_rows) {
        if (row.bit != next || row.needs >= next) return false;
        next *= 2;
    }
    return true;
}
static_assert(rows_follow_bits(), "a row for every bit of effects.h, in their order, that needs only rows above it");

} // namespace wadi
