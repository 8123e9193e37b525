// Kinds of sand, as numbers of the material.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace viewer {

struct MaterialPreset {
    const char* name;
    float wetness; // of sand that is poured
    std::vector<std::pair<const char*, double>> numbers;
};
const std::vector<MaterialPreset>& material_presets();
/// Throws std::runtime_error naming the presets.
const MaterialPreset& material_preset(const std::string& name);

} // namespace viewer
