// The effects and choices of method: what each needs. stagec reads this too, and compiles no mask that lacks what it needs.
#include "engine/settings/effects.hpp"
#include <array>

namespace wadi {

namespace {

constexpr std::array<Effect, 12> table = {{
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
    {EFFECT_BED_FRICTION, "bed_friction", EFFECT_WATER, "Manning-like friction of pure water on its bed"},
    {EFFECT_BED_SHEAR, "bed_shear", EFFECT_MIXTURE, "pure water drags the sand under it along: bed load"},
}};

constexpr std::array<Choice, 7> choices = {{
    {EFFECT_SEMI_LAGRANGIAN, "semi_lagrangian", 0,
     [](const Method& m) { return m.velocity_transport == VelocityTransport::semi_lagrangian; },
     [](Method& m) { m.velocity_transport = VelocityTransport::semi_lagrangian; }},
    {EFFECT_WHOLE_STRAIN, "whole_strain", EFFECT_ELASTOPLASTIC,
     [](const Method& m) { return m.strain_transport != StrainTransport::left_stretch; },
     [](Method& m) { m.strain_transport = StrainTransport::polar; }},
    {EFFECT_DIRECT_STRAIN, "direct_strain", EFFECT_WHOLE_STRAIN,
     [](const Method& m) { return m.strain_transport == StrainTransport::direct; },
     [](Method& m) { m.strain_transport = StrainTransport::direct; }},
    {EFFECT_EXPLICIT_DRAG, "explicit_drag", EFFECT_DRAG,
     [](const Method& m) { return m.drag_friction == DragFriction::sequence; },
     [](Method& m) { m.drag_friction = DragFriction::sequence; }},
    {EFFECT_LAPLACE_DIFFUSION, "laplace_diffusion", EFFECT_DIFFUSION,
     [](const Method& m) { return m.diffusion == Diffusion::laplacian; }, [](Method& m) { m.diffusion = Diffusion::laplacian; }},
    {EFFECT_SECOND_ORDER_WATER, "second_order_water", EFFECT_WATER, [](const Method& m) { return m.water_transport_order == 2; },
     [](Method& m) { m.water_transport_order = 2; }},
    {EFFECT_HALF_STORAGE, "half_storage", 0, [](const Method& m) { return m.half_storage; },
     [](Method& m) { m.half_storage = true; }},
}};

// Half storage is for worlds that trade accuracy for memory; a method that does the opposite, or the paper's own, has no kernels
// for it.
constexpr std::uint32_t never_half =
    EFFECT_SEMI_LAGRANGIAN | EFFECT_WHOLE_STRAIN | EFFECT_EXPLICIT_DRAG | EFFECT_LAPLACE_DIFFUSION | EFFECT_SECOND_ORDER_WATER;

} // namespace

std::span<const Effect> effect_table() { return table; }

std::span<const Choice> choice_table() { return choices; }

std::string effect_names(std::uint32_t bits) {
    std::string names;
    for (const auto& effect : table) {
        if ((bits & effect.bit) != 0) names += (names.empty() ? "" : ", ") + std::string(effect.name);
    }
    return names;
}

std::uint32_t with_needs(std::uint32_t mask) {
    for (std::uint32_t before = ~mask; before != mask;) {
        before = mask;
        for (const auto& effect : table) mask |= (mask & effect.bit) != 0 ? effect.needs : 0;
        for (const auto& choice : choices) mask |= (mask & choice.bit) != 0 ? choice.needs : 0;
    }
    return mask;
}

bool is_legal(std::uint32_t mask) {
    return with_needs(mask) == mask && ((mask & EFFECT_HALF_STORAGE) == 0 || (mask & never_half) == 0);
}

} // namespace wadi
