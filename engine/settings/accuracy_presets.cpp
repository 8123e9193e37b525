#include "engine/settings/accuracy_presets.hpp"

namespace wadi {

namespace {

// More cells buy accuracy, a smaller dt than the cells ask for buys none, and beyond two sand substeps neither do more of those.
// Second order for water lies on the frontier of every scene with water. Errors: mean of island, heap and wall on 32, 64 and 128
// cells (samples/report/sweep at tag ablation-2026-11); costs: dam_break, balanced on 1024² (tests/lab/report/timings). The
// CPU's are of 16 threads on 512², 1024² and 2048² with order 1, for accurate times 1.15, what order 2 takes there.
constexpr AccuracyPreset presets[] = {
    {"draft", 0.5, 2, 0, 1.8, 0.27, 0.15},
    {"balanced", 1, 2, 0, 1, 1, 1},
    {"accurate", 2, 2, 2, 0.51, 10.8, 9.3},
};

} // namespace

std::span<const AccuracyPreset> accuracy_presets() { return presets; }

const AccuracyPreset* find_accuracy_preset(const std::string& name) {
    for (const AccuracyPreset& preset : presets)
        if (name == preset.name) return &preset;
    return nullptr;
}

std::vector<std::string> accuracy_names() {
    std::vector<std::string> names;
    for (const AccuracyPreset& preset : presets) names.emplace_back(preset.name);
    return names;
}

} // namespace wadi
