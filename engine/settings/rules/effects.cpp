#include "engine/settings/rules/effects.hpp"
#include <algorithm>

namespace wadi {

namespace {

bool any_above_zero(const std::vector<float>& field) {
    return std::any_of(field.begin(), field.end(), [](float x) { return x > 0.0F; });
}

} // namespace

const std::vector<std::string>& effect_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> found;
        for (const Effect& effect : effect_table()) found.emplace_back(effect.name);
        return found;
    }();
    return names;
}

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
        Why want = effect.why(settings, content);
        // What is only seen waits for what it needs, so that a world may begin or run dry.
        if (force == Force::on && (lacking == 0 || (effect.bit & only_seen) == 0)) {
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
        if (made.chosen(settings) && (choice.mask & made.needs) == made.needs) choice.mask |= made.bit;
    const std::uint32_t unknown = choice.mask & never_published;
    if ((choice.mask & EFFECT_PUBLISHED) != 0 && unknown != 0)
        return error(Code::bad_argument, "method.name: \"published\" goes only without " + effect_names(unknown));
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
