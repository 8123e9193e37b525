#include "tests/conformance/masks.hpp"
#include "engine/settings/rules/effects.hpp"
#include "engine/step/plan/step_plan.hpp"
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

// Which stages the plan of a mask holds.
class Plans {
  public:
    bool hold(std::uint32_t mask, std::size_t stage) {
        auto& stages = known_[mask];
        if (stages.empty()) {
            stages.resize(compute::stage_table().size());
            const StepPlan plan = make_step_plan(mask, 1);
            for (const auto* passes : {&plan.start_passes, &plan.water_passes, &plan.substep_passes})
                for (const auto& pass : *passes) stages[static_cast<std::size_t>(pass.stage)] = true;
        }
        return stages[stage];
    }
    bool any_holds(std::size_t stage) const {
        return std::any_of(known_.begin(), known_.end(), [&](const auto& entry) { return entry.second[stage]; });
    }

  private:
    std::map<std::uint32_t, std::vector<bool>> known_;
};

std::vector<ByTested> find_masks() {
    const auto table = compute::stage_table();
    std::vector<ByTested> least(table.size());
    Plans plans;
    // Not every bit that a plan wants is one that the stage names, but two beside those are enough.
    const auto bits = named_bits();
    std::set<std::uint32_t> pairs = {0};
    for (const auto& [one, one_name] : bits)
        for (const auto& [other, other_name] : bits) pairs.insert(with_needs(one | other));
    for (const std::uint32_t mask : pairs)
        if (is_legal(mask)) plans.hold(mask, 0);
    for (std::size_t stage = 0; stage < table.size(); ++stage) {
        const std::uint32_t tested = table[stage].tested_effects;
        const bool planned = plans.any_holds(stage);
        std::uint32_t wanted = 0;
        do {
            const auto fits = [&](std::uint32_t mask) {
                return (mask & tested) == wanted && (mask & table[stage].without) == 0 && is_legal(mask);
            };
            // What a mask needs only grows with it: no mask with these bits is smaller than this one.
            const std::uint32_t smallest = with_needs(wanted | table[stage].needs);
            std::vector<std::uint32_t> candidates;
            if (fits(smallest)) candidates.push_back(smallest);
            if (planned && fits(smallest) && !plans.hold(smallest, stage))
                for (const std::uint32_t more : pairs) candidates.push_back(smallest | more);
            std::sort(candidates.begin(), candidates.end(), smaller);
            for (const std::uint32_t mask : candidates)
                if (fits(mask) && (!planned || plans.hold(mask, stage))) least[stage].emplace(wanted, mask);
            wanted = (wanted - tested) & tested;
        } while (wanted != 0);
    }
    return least;
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
