// Effects: what a scene calls for, and nothing else. One table says what each bit is, what it needs and why it is on.
#pragma once
#include "engine/compute/params.hpp"
#include "engine/settings/settings.hpp"
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace wadi {

struct Effect {
    std::uint32_t bit;
    const char* name;    // as level files write it
    std::uint32_t needs; // bits that must be on as well
    const char* meaning; // one sentence
};

/// All effects, dependencies first.
std::span<const Effect> effect_table();
/// "sand, water": the effects of a mask, without the choices of method.
std::string effect_names(std::uint32_t mask);

/// A choice of method that has a bit in the same mask; a level makes it in `method`, not in `effects`.
struct Choice {
    std::uint32_t bit;
    const char* name;    // as level files write it
    std::uint32_t needs; // bits that must be on as well; without them the choice has nothing to act on
    bool (*chosen)(const Method& method);
    void (*choose)(Method& method); // what makes `chosen` true
};

std::span<const Choice> choice_table();

/// What a world holds, or an edit is about to bring.
struct Content {
    bool sand = false, water = false;
    friend bool operator==(Content, Content) = default;
};
Content content_of(const InitialFields& fields);

struct EffectChoice {
    std::uint32_t mask = 0;
    std::vector<std::string> reasons; // one per effect of the table: why it is on or off
};

/// The mask that settings and content call for, with what the level forces. Errors: an unknown name, or an effect forced on
/// whose needs are off.
Result<EffectChoice> effects_required(const Settings& settings, Content content);

/// ok, or bad_argument where the level forces off what this content needs.
Status check_allowed(const Settings& settings, Content content);

/// The mask with all that its effects and choices need.
std::uint32_t with_needs(std::uint32_t mask);
/// True when every effect in the mask and choice in the mask has what it needs, and half storage no choice that is without it.
bool is_legal(std::uint32_t mask);

} // namespace wadi
