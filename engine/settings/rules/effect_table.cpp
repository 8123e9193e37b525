// When each effect is on by itself, and which choice of method sets which bit: a rule beside each row of shaders/effect_rows.hpp.
#include "engine/settings/rules/effects.hpp"
#include <algorithm>
#include <iterator>

namespace wadi {

namespace {

bool ever_above_zero(const TimeSeries& series) {
    return std::any_of(series.samples.begin(), series.samples.end(), [](const auto& s) { return s.second > 0; });
}

bool source_adds(const Settings& s, SourceMaterial material) {
    return std::any_of(s.sources.begin(), s.sources.end(), [&](const Source& source) {
        const Content added = content_of(source);
        return material == SourceMaterial::sand ? added.sand : added.water;
    });
}

consteval EffectRow row(std::uint32_t bit) {
    for (const auto& row : effect_rows)
        if (row.bit == bit) return row;
    for (const auto& row : choice_rows)
        if (row.bit == bit) return row;
    throw "no such row"; // is no constant: the build stops
}

// The paper's method has stages of its own, without these laws.
Why unless_published(const Settings& s, Why why) {
    if (s.method.published()) return {false, "the method is published"};
    return why;
}

Why above_zero(const char* name, double value) { return {value > 0, name + std::string(value > 0 ? " is above 0" : " is 0")}; }

// Without cohesion the yield surface leaves sand nothing that friction and Coulomb's wedge do not. Not by whether there is water
// yet: sand that gets damp later would go another way after a roll-back to before.
Why holds_shape(const Settings& s, Content) {
    const auto& m = s.material;
    if (m.young_modulus <= 0) return {false, "young_modulus is 0"};
    const bool cohesive = std::max({m.cohesion_dry, m.cohesion_wet, m.cohesion_capillary}) > 0;
    return {cohesive, cohesive ? "young_modulus is above 0" : "the sand has no cohesion"};
}

// Of what is only seen: it costs something and moves nothing.
Why drawn(const Settings& s, std::uint32_t effect) {
    const bool on = (s.drawn_effects & effect) != 0;
    return {on, on ? "the host draws it" : "neither the level nor the host asks for it"};
}

constexpr Effect effects[] = {
    {row(EFFECT_WATER), "the level, a source, rain or a side (discharge, level, waves) brings water",
     [](const Settings& s, Content content) -> Why {
         if (content.water) return {true, "the world holds water"};
         if (source_adds(s, SourceMaterial::water)) return {true, "a source adds water"};
         if (ever_above_zero(s.rain)) return {true, "it rains"};
         for (const auto& side : s.sides)
             if (side.kind == SideKind::discharge || side.has_level()) return {true, "water enters through a side"};
         return {false, "no water in the world, its sources or its sides"};
     }},
    {row(EFFECT_SAND), "the level or a source brings sand",
     [](const Settings& s, Content content) -> Why {
         if (content.sand) return {true, "the world holds sand"};
         if (source_adds(s, SourceMaterial::sand)) return {true, "a source adds sand"};
         return {false, "no sand in the world or its sources"};
     }},
    {row(EFFECT_MIXTURE), "both are on",
     [](const Settings&, Content) -> Why {
         return {true, "water and sand can meet"};
     }},
    {row(EFFECT_DIFFUSION), "diffusion_rate > 0",
     [](const Settings& s, Content) { return above_zero("diffusion_rate", s.material.diffusion_rate); }},
    {row(EFFECT_DRAG), "exchange_rate > 0",
     [](const Settings& s, Content) { return above_zero("exchange_rate", s.material.exchange_rate); }},
    {row(EFFECT_ELASTOPLASTIC), "young_modulus > 0 and the sand has cohesion", holds_shape},
    {row(EFFECT_COHESION), "both are on",
     [](const Settings&, Content) -> Why {
         return {true, "sand can get wet"};
     }},
    {row(EFFECT_SOURCES), "the level has sources",
     [](const Settings& s, Content) -> Why {
         return {!s.sources.empty(), s.sources.empty() ? "no sources" : std::to_string(s.sources.size()) + " sources"};
     }},
    {row(EFFECT_RAIN), "rain or evaporation ever above 0",
     [](const Settings& s, Content) -> Why {
         const bool on = ever_above_zero(s.rain) || ever_above_zero(s.evaporation);
         return {on, on ? "rain or evaporation is above 0" : "no rain, no evaporation"};
     }},
    {row(EFFECT_OPEN_SIDES), "a side is no wall",
     [](const Settings& s, Content) -> Why {
         const bool on =
             std::any_of(s.sides.begin(), s.sides.end(), [](const Side& side) { return side.kind != SideKind::wall; });
         return {on, on ? "a side is open" : "all sides are walls"};
     }},
    {row(EFFECT_BED_FRICTION), "bed_friction or manning > 0, or the level has roughness",
     [](const Settings& s, Content) -> Why {
         if (s.material.manning > 0) return above_zero("manning", s.material.manning);
         if (!s.roughness.empty()) return {true, "the level has roughness"};
         return above_zero("bed_friction", s.material.bed_friction);
     }},
    {row(EFFECT_BED_SHEAR), "bed_shear > 0",
     [](const Settings& s, Content) { return above_zero("bed_shear", s.material.bed_shear); }},
    {row(EFFECT_SLOPE_NORMAL), "slope_normal > 0",
     [](const Settings& s, Content) { return unless_published(s, above_zero("slope_normal", s.material.slope_normal)); }},
    {row(EFFECT_INTERNAL_FRICTION), "internal_friction or sand_viscosity > 0",
     [](const Settings& s, Content) {
         const auto& m = s.material;
         return unless_published(s, m.internal_friction > 0 ? above_zero("internal_friction", m.internal_friction)
                                                            : above_zero("sand_viscosity", m.sand_viscosity));
     }},
    {row(EFFECT_RETENTION), "retention > 0",
     [](const Settings& s, Content) { return unless_published(s, above_zero("retention", s.material.retention)); }},
    {row(EFFECT_ROUGHNESS), "the level has roughness",
     [](const Settings& s, Content) -> Why {
         return {!s.roughness.empty(), s.roughness.empty() ? "the level has none" : "the level has roughness"};
     }},
    {row(EFFECT_RAIN_MAP), "the level has a rain map and it rains",
     [](const Settings& s, Content) -> Why {
         if (s.rain_map.empty()) return {false, "the level has none"};
         return {ever_above_zero(s.rain), ever_above_zero(s.rain) ? "the level has a rain map" : "it never rains"};
     }},
    {row(EFFECT_FOAM), "the host draws it (`draws`)", [](const Settings& s, Content) { return drawn(s, EFFECT_FOAM); }},
    {row(EFFECT_WETNESS), "the host draws it (`draws`)", [](const Settings& s, Content) { return drawn(s, EFFECT_WETNESS); }},
    {row(EFFECT_SILT), "the host draws it (`draws`)", [](const Settings& s, Content) { return drawn(s, EFFECT_SILT); }},
};

constexpr Choice choices[] = {
    {row(EFFECT_PUBLISHED), "name published", [](const Settings& s) { return s.method.published(); },
     [](Settings& s) { s.method.name = "published"; }},
    {row(EFFECT_DIRECT_STRAIN), "strain_transport direct",
     [](const Settings& s) { return s.method.strain_transport == StrainTransport::direct; },
     [](Settings& s) { s.method.strain_transport = StrainTransport::direct; }},
    {row(EFFECT_SECOND_ORDER_WATER), "water_transport_order 2",
     [](const Settings& s) { return s.method.water_transport_order == 2; },
     [](Settings& s) { s.method.water_transport_order = 2; }},
    {row(EFFECT_SECOND_ORDER_SAND), "sand_transport_order 2",
     [](const Settings& s) { return s.method.sand_transport_order == 2; },
     [](Settings& s) { s.method.sand_transport_order = 2; }},
    {row(EFFECT_SHOCK_VISCOSITY), "shock_viscosity > 0", [](const Settings& s) { return s.method.shock_viscosity > 0; },
     [](Settings& s) { s.method.shock_viscosity = Method{}.shock_viscosity; }},
    {row(EFFECT_FLOW_FRICTION), "flow_length > 0", [](const Settings& s) { return s.material.flow_length > 0; },
     [](Settings& s) { s.material.flow_length = 2e-3; }},
    {row(EFFECT_INFILTRATION), "conductivity > 0", [](const Settings& s) { return s.material.conductivity > 0; },
     [](Settings& s) { s.material.conductivity = 1e-3; }},
};

constexpr bool has_rule(const Effect& effect) { return effect.why != nullptr; }
constexpr bool has_rule(const Choice& choice) { return choice.chosen != nullptr && choice.choose != nullptr; }

template <class Ruled, std::size_t RULED, std::size_t ROWS>
constexpr bool rule_for_each(const Ruled (&ruled)[RULED], const EffectRow (&rows)[ROWS]) {
    for (std::size_t n = 0; n < ROWS; ++n)
        if (RULED != ROWS || ruled[n].bit != rows[n].bit || !has_rule(ruled[n])) return false;
    return true;
}
static_assert(rule_for_each(effects, effect_rows), "each row of effect_rows has a rule of its own here, in their order");
static_assert(rule_for_each(choices, choice_rows), "each row of choice_rows has a rule of its own here, in their order");

} // namespace

Content content_of(const Source& source) {
    const bool adds = ever_above_zero(source.rate) || ever_above_zero(source.discharge) || !source.level.samples.empty();
    return {adds && source.material == SourceMaterial::sand, adds && source.material == SourceMaterial::water};
}

std::span<const Effect> effect_table() { return effects; }

std::span<const Choice> choice_table() { return choices; }

std::string effect_names(std::uint32_t bits) {
    std::string names;
    for (const auto& effect : effects) {
        if ((bits & effect.bit) != 0) names += (names.empty() ? "" : ", ") + std::string(effect.name);
    }
    return names;
}

} // namespace wadi
