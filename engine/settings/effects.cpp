#include "engine/settings/effects.hpp"
#include <algorithm>

namespace wadi {

namespace {

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

Result<EffectChoice> effects_required(const Settings& settings, Content content) {
    for (const auto& forced : settings.effects) {
        if (std::none_of(effect_table().begin(), effect_table().end(), [&](const Effect& e) { return forced.first == e.name; })) {
            return error(Code::bad_argument, "effects." + forced.first + ": no such effect; known: " + effect_names(~0u));
        }
    }
    EffectChoice choice;
    for (const auto& effect : effect_table()) {
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
    for (const auto& made : choice_table())
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
