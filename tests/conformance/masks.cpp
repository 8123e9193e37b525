#include "tests/conformance/masks.hpp"
#include "engine/settings/effects.hpp"
#include "engine/step/step_plan.hpp"
#include <algorithm>
#include <bit>
#include <map>
#include <set>

namespace wadi::conformance {

namespace {

using ByTested = std::map<std::uint32_t, std::uint32_t>; // tested bits -> the smallest whole mask that has them

// Effects and choices of method.
std::vector<std::pair<std::uint32_t, const char*>> named_bits() {
    std::vector<std::pair<std::uint32_t, const char*>> bits;
    for (const auto& effect : effect_table()) bits.emplace_back(effect.bit, effect.name);
    for (const auto& choice : choice_table()) bits.emplace_back(choice.bit, choice.name);
    return bits;
}

bool smaller(std::uint32_t a, std::uint32_t b) {
    return std::popcount(a) != std::popcount(b) ? std::popcount(a) < std::popcount(b) : a < b;
}

std::vector<ByTested> find_masks() {
    const auto table = compute::stage_table();
    std::vector<ByTested> seen(table.size());
    std::vector<bool> planned(table.size(), false);
    const auto note = [&](std::size_t stage, std::uint32_t mask) {
        const auto [at, added] = seen[stage].emplace(mask & table[stage].tested_effects, mask);
        if (!added && smaller(mask, at->second)) at->second = mask;
    };
    std::uint32_t all = 0;
    for (const auto& effect : effect_table()) all |= effect.bit;
    for (const auto& choice : choice_table()) all |= choice.bit;
    std::vector<std::uint32_t> legal;
    for (std::uint32_t mask = 0; mask <= all; ++mask)
        if ((mask & ~all) == 0 && is_legal(mask)) legal.push_back(mask);
    for (const std::uint32_t mask : legal) {
        const StepPlan plan = make_step_plan(mask, 1);
        for (const auto* passes : {&plan.water_passes, &plan.substep_passes}) {
            for (const auto& pass : *passes) {
                planned[static_cast<std::size_t>(pass.stage)] = true;
                note(static_cast<std::size_t>(pass.stage), mask);
            }
        }
    }
    for (std::size_t stage = 0; stage < table.size(); ++stage) {
        if (planned[stage]) continue;
        for (const std::uint32_t mask : legal) {
            const bool fits = (mask & table[stage].needs) == table[stage].needs && (mask & table[stage].without) == 0;
            if (fits) note(stage, mask);
        }
    }
    return seen;
}

} // namespace

std::string effects_text(std::uint32_t mask) {
    std::string text;
    for (const auto& [bit, name] : named_bits()) {
        if ((mask & bit) == 0) continue;
        if (!text.empty()) text += '+';
        text += name;
    }
    return text.empty() ? "none" : text;
}

Result<std::uint32_t> parse_effects(const std::string& text) {
    std::uint32_t mask = 0;
    for (std::size_t at = 0; text != "none" && at <= text.size();) {
        const std::size_t end = std::min(text.find('+', at), text.size());
        const std::string name = text.substr(at, end - at);
        const auto bits = named_bits();
        const auto found = std::find_if(bits.begin(), bits.end(), [&](const auto& bit) { return name == bit.second; });
        if (found == bits.end()) return error(Code::bad_argument, "effects=" + text + ": no effect \"" + name + "\"");
        mask |= found->first;
        at = end + 1;
    }
    if (!is_legal(mask)) return error(Code::bad_argument, "effects=" + text + ": an effect lacks what it needs");
    return mask;
}

std::vector<std::uint32_t> stage_masks(int stage) {
    static const std::vector<ByTested> found = find_masks();
    std::vector<std::uint32_t> masks;
    for (const auto& [tested, mask] : found[static_cast<std::size_t>(stage)]) masks.push_back(mask);
    std::sort(masks.begin(), masks.end(), smaller);
    return masks;
}

} // namespace wadi::conformance
