#include "engine/accuracy_presets.hpp"

namespace wadi {

namespace {

// More cells buy accuracy, a smaller dt than the cells ask for buys none, and beyond two sand steps neither do more of those.
constexpr AccuracyPreset presets[] = {
    {"draft", 0.5, 2, 2.2, 0.5, 0.14},
    {"balanced", 1, 2, 1, 1, 1},
    {"accurate", 2, 2, 0.4, 2.1, 7.5},
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
