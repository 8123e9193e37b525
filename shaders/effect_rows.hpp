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
    {EFFECT_OPEN_SIDES, "open_sides", 0, "sides that let water through: discharge, level, waves, outflow, brink"},
    {EFFECT_BED_FRICTION, "bed_friction", EFFECT_WATER, "friction of pure water on its bed"},
    {EFFECT_BED_SHEAR, "bed_shear", EFFECT_MIXTURE, "pure water drags the sand under it along: bed load"},
    {EFFECT_SLOPE_NORMAL, "slope_normal", EFFECT_SAND,
     "weight and friction of sand normal to its slope, pushes no steeper than Coulomb's wedge"},
    {EFFECT_INTERNAL_FRICTION, "internal_friction", EFFECT_SAND,
     "sand that spreads or shears in its plane is slowed from within"},
    {EFFECT_RETENTION, "retention", EFFECT_MIXTURE | EFFECT_DRAG, "pores hold back a share of the water: damp sand stays damp"},
    {EFFECT_ROUGHNESS, "roughness", EFFECT_BED_FRICTION, "Manning's n from cell to cell"},
    {EFFECT_RAIN_MAP, "rain_map", EFFECT_RAIN, "how much of the rain falls on each cell"},
    {EFFECT_FOAM, "foam", EFFECT_WATER, "foam is born where water breaks, drifts, fades and is left on the shore"},
    {EFFECT_WETNESS, "wetness", EFFECT_WATER, "ground that water has left stays wet and dries"},
    {EFFECT_SILT, "silt", EFFECT_WATER | EFFECT_SAND, "water that runs over sand gets muddy, carries that along and clears"},
};

/// Choices: bits of the same mask above those, from settings and never from content. Without what it needs a choice has nothing
/// to act on.
inline constexpr EffectRow choice_rows[] = {
    {EFFECT_PUBLISHED, "published", 0, "the paper's own method, Algorithm 1, in stages of its own"},
    {EFFECT_DIRECT_STRAIN, "direct_strain", EFFECT_PUBLISHED | EFFECT_ELASTOPLASTIC,
     "F is moved as it is, not as angle and stretch"},
    {EFFECT_SECOND_ORDER_WATER, "second_order_water", EFFECT_WATER,
     "heights and flux-form velocities of water move by limited slopes"},
    {EFFECT_SECOND_ORDER_SAND, "second_order_sand", EFFECT_SAND,
     "heights and flux-form velocities of sand move by limited slopes"},
    {EFFECT_SHOCK_VISCOSITY, "shock_viscosity", EFFECT_WATER,
     "numerical viscosity of water where it is compressed: bores do not ring"},
    {EFFECT_FLOW_FRICTION, "flow_friction", EFFECT_SAND | EFFECT_SLOPE_NORMAL,
     "friction of sand rises with its speed, and where it is thin"},
    {EFFECT_INFILTRATION, "infiltration", EFFECT_MIXTURE | EFFECT_SLOPE_NORMAL,
     "water that stands on sand enters its pores at a rate"},
};

inline constexpr std::uint32_t all_effects = (1u << std::size(effect_rows)) - 1;

/// What is only seen and moves nothing.
inline constexpr std::uint32_t only_seen = EFFECT_FOAM | EFFECT_WETNESS | EFFECT_SILT;

/// The paper's own stages know nothing of these.
inline constexpr std::uint32_t never_published = EFFECT_SLOPE_NORMAL | EFFECT_INTERNAL_FRICTION | EFFECT_RETENTION |
                                                 EFFECT_SECOND_ORDER_SAND | EFFECT_SHOCK_VISCOSITY | EFFECT_FLOW_FRICTION |
                                                 EFFECT_INFILTRATION;

/// The mask with all that its effects and choices need.
constexpr std::uint32_t with_needs(std::uint32_t mask) {
    for (std::uint32_t before = ~mask; before != mask;) {
        before = mask;
        for (const auto& row : effect_rows) mask |= (mask & row.bit) != 0 ? row.needs : 0;
        for (const auto& row : choice_rows) mask |= (mask & row.bit) != 0 ? row.needs : 0;
    }
    return mask;
}

/// True when every effect and choice in the mask has what it needs, and the paper's method nothing that it is without.
constexpr bool is_legal(std::uint32_t mask) {
    return with_needs(mask) == mask && ((mask & EFFECT_PUBLISHED) == 0 || (mask & never_published) == 0);
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
