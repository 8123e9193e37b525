#include "engine/effects.hpp"
#include <algorithm>
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

constexpr std::array<Choice, 6> choices = {{
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
}};

bool ever_above_zero(const TimeSeries& series) {
    return std::any_of(series.samples.begin(), series.samples.end(), [](const auto& s) { return s.second > 0; });
}

bool any_above_zero(const std::vector<float>& field) {
    return std::any_of(field.begin(), field.end(), [](float x) { return x > 0.0F; });
}

struct Wanted {
    bool on;
    std::string reason;
};

Wanted wanted(const Effect& effect, std::uint32_t mask, const Settings& s, Content content) {
    const auto& m = s.material;
    switch (effect.bit) {
    case EFFECT_WATER: {
        if (content.water) return {true, "the world holds water"};
        for (const auto& source : s.sources) {
            if (source.material == SourceMaterial::water && ever_above_zero(source.rate)) return {true, "a source adds water"};
        }
        if (ever_above_zero(s.rain)) return {true, "it rains"};
        for (const auto& side : s.sides) {
            if (side.kind == SideKind::discharge || side.kind == SideKind::level) return {true, "water enters through a side"};
        }
        return {false, "no water in the world, its sources or its sides"};
    }
    case EFFECT_SAND: {
        if (content.sand) return {true, "the world holds sand"};
        for (const auto& source : s.sources) {
            if (source.material == SourceMaterial::sand && ever_above_zero(source.rate)) return {true, "a source adds sand"};
        }
        return {false, "no sand in the world or its sources"};
    }
    case EFFECT_MIXTURE:
        return {(mask & effect.needs) == effect.needs, "water and sand can meet"};
    case EFFECT_DIFFUSION:
        return {m.diffusion_rate > 0, m.diffusion_rate > 0 ? "diffusion_rate is above 0" : "diffusion_rate is 0"};
    case EFFECT_DRAG:
        return {m.exchange_rate > 0, m.exchange_rate > 0 ? "exchange_rate is above 0" : "exchange_rate is 0"};
    case EFFECT_ELASTOPLASTIC:
        return {m.young_modulus > 0, m.young_modulus > 0 ? "young_modulus is above 0" : "young_modulus is 0"};
    case EFFECT_COHESION:
        return {true, "sand can get wet"};
    case EFFECT_SOURCES:
        return {!s.sources.empty(), s.sources.empty() ? "no sources" : std::to_string(s.sources.size()) + " sources"};
    case EFFECT_RAIN: {
        const bool on = ever_above_zero(s.rain) || ever_above_zero(s.evaporation);
        return {on, on ? "rain or evaporation is above 0" : "no rain, no evaporation"};
    }
    case EFFECT_OPEN_SIDES: {
        const bool on = std::any_of(s.sides.begin(), s.sides.end(), [](const Side& side) { return side.kind != SideKind::wall; });
        return {on, on ? "a side is open" : "all sides are walls"};
    }
    case EFFECT_BED_SHEAR:
        return {m.bed_shear > 0, m.bed_shear > 0 ? "bed_shear is above 0" : "bed_shear is 0"};
    default:
        return {m.bed_friction > 0, m.bed_friction > 0 ? "bed_friction is above 0" : "bed_friction is 0"};
    }
}

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

bool is_legal(std::uint32_t mask) {
    return std::all_of(table.begin(), table.end(),
                       [&](const Effect& e) { return (mask & e.bit) == 0 || (mask & e.needs) == e.needs; }) &&
           std::all_of(choices.begin(), choices.end(),
                       [&](const Choice& c) { return (mask & c.bit) == 0 || (mask & c.needs) == c.needs; });
}

Result<EffectChoice> effects_required(const Settings& settings, Content content) {
    for (const auto& forced : settings.effects) {
        if (std::none_of(table.begin(), table.end(), [&](const Effect& e) { return forced.first == e.name; })) {
            return error(Code::bad_argument, "effects." + forced.first + ": no such effect; known: " + effect_names(~0u));
        }
    }
    EffectChoice choice;
    for (const auto& effect : table) {
        Force force = Force::automatic;
        for (const auto& [name, wish] : settings.effects) {
            if (name == effect.name) force = wish;
        }
        const std::uint32_t lacking = effect.needs & ~choice.mask;
        auto want = wanted(effect, choice.mask, settings, content);
        if (force == Force::on) {
            if (lacking != 0)
                return error(Code::bad_argument,
                             std::string("effects.") + effect.name + ": on, but it needs " + effect_names(lacking));
            want = {true, "forced on by the level"};
        } else if (force == Force::off) {
            want = {false, "forced off by the level"};
        } else if (lacking != 0) {
            want = {false, "needs " + effect_names(lacking)};
        }
        if (want.on) choice.mask |= effect.bit;
        choice.reasons.push_back(want.reason);
    }
    for (const auto& made : choices)
        if (made.chosen(settings.method) && (choice.mask & made.needs) == made.needs) choice.mask |= made.bit;
    return choice;
}

Content content_of(const InitialFields& fields) { return {any_above_zero(fields.sand), any_above_zero(fields.water)}; }

Status check_allowed(const Settings& settings, Content content) {
    for (const auto& [name, force] : settings.effects) {
        if (force == Force::off && ((content.sand && name == "sand") || (content.water && name == "water")))
            return error(Code::bad_argument, "effects." + name + " is forced off by the level");
    }
    return ok_status();
}

} // namespace wadi
