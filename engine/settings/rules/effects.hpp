// Effects: what a scene calls for, and nothing else. shaders/effect_rows.hpp says what each bit is and what it needs,
// effect_table.cpp beside it when it is on.
#pragma once
#include "engine/settings/data/settings.hpp"
#include "shaders/effect_rows.hpp"
#include "shaders/params.hpp"
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace wadi {

/// What a world holds, or an edit is about to bring.
struct Content {
    bool sand = false, water = false;
    friend bool operator==(Content, Content) = default;
};
Content content_of(const InitialFields& fields);
/// What a source may ever add.
Content content_of(const Source& source);

/// Whether an effect is on by itself, all that it needs being on, and why or why not.
struct Why {
    bool on;
    std::string reason;
};

struct Effect : EffectRow {
    const char* when; // what `why` asks, for people
    Why (*why)(const Settings& settings, Content content);
};

/// All effects, dependencies first.
std::span<const Effect> effect_table();
/// Their names, as level files write them.
const std::vector<std::string>& effect_names();
/// "sand, water": the effects of a mask, without the choices of method.
std::string effect_names(std::uint32_t mask);

/// A choice that has a bit in the same mask; a level makes it in `method` or `material`, not in `effects`.
struct Choice : EffectRow {
    const char* when; // the setting that makes it
    bool (*chosen)(const Settings& settings);
    void (*choose)(Settings& settings); // what makes `chosen` true
};

std::span<const Choice> choice_table();

struct EffectChoice {
    std::uint32_t mask = 0;
    std::vector<std::string> reasons; // one per effect of the table: why it is on or off
};

/// The mask that settings and content call for, with what the level forces. Errors: an unknown name, or an effect forced on
/// whose needs are off.
Result<EffectChoice> effects_required(const Settings& settings, Content content);

/// ok, or bad_argument where the level forces off what this content needs.
Status check_allowed(const Settings& settings, Content content);

} // namespace wadi
