#include "engine/settings/data/accuracy_presets.hpp"

namespace wadi {

namespace {

// More cells buy accuracy, a smaller dt than the cells ask for buys none, and beyond two sand substeps neither do more of those.
// Second order for water lies on the frontier of every scene with water. What a GPU has room for, the level's author says.
constexpr AccuracyPreset presets[] = {
    {"draft", 0.5, 2, 0},
    {"balanced", 1, 2, 0},
    {"accurate", 2, 2, 2},
    {"fine", 0, 0, 0},
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
