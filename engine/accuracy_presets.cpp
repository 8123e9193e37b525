#include "engine/accuracy_presets.hpp"

namespace wadi {

namespace {

// More cells buy accuracy, a smaller dt than the cells ask for buys none, and beyond two sand steps neither do more of those.
// Errors: mean of island, heap and wall on 32, 64 and 128 cells (samples/report/h100); costs: dam_break on 512², 1024² and 2048²
// (samples/report/timings), times the steps per second.
constexpr AccuracyPreset presets[] = {
    {"draft", 0.5, 2, 2.1, 0.14, 0.15},
    {"balanced", 1, 2, 1, 1, 1},
    {"accurate", 2, 2, 0.41, 7.7, 8.1},
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
