#include "material_presets.hpp"
#include <stdexcept>

namespace viewer {

// Units and meanings: samples/levels/README.md, "Material". A number stays where a preset leaves it out.
const std::vector<MaterialPreset>& material_presets() {
    static const std::vector<MaterialPreset> presets = {
        // Runs and heaps at 31 degrees, holds nothing.
        {"dry",
         0,
         {{"friction", 0.6},
          {"cohesion_dry", 0},
          {"cohesion_wet", 0},
          {"cohesion_capillary", 0},
          {"retention", 0.4925},
          {"exchange_rate", 1e5},
          {"diffusion_rate", 0.01},
          {"internal_friction", 0.4},
          {"sand_viscosity", 0.05},
          {"grain_size", 0.001}}},
        // Holds a wall of a metre or two while it is damp, slumps when it is soaked.
        {"damp",
         0.25f,
         {{"friction", 0.6},
          {"cohesion_dry", 210},
          {"cohesion_wet", 8500},
          {"cohesion_capillary", 8500},
          {"retention", 0.4925},
          {"exchange_rate", 1e5},
          {"diffusion_rate", 0.01},
          {"internal_friction", 0.4},
          {"sand_viscosity", 0.05},
          {"grain_size", 0.001}}},
        // Slides on slopes of 9 degrees, slowly, and hardly lets water through.
        {"mud",
         1,
         {{"friction", 0.15},
          {"cohesion_dry", 100},
          {"cohesion_wet", 300},
          {"cohesion_capillary", 300},
          {"retention", 0.4925},
          {"exchange_rate", 1e6},
          {"diffusion_rate", 0.001},
          {"internal_friction", 0.4},
          {"sand_viscosity", 0.5},
          {"grain_size", 0.0001}}},
        // Steep, drains at once, and only fast water moves it.
        {"gravel",
         0,
         {{"friction", 0.8},
          {"cohesion_dry", 0},
          {"cohesion_wet", 0},
          {"cohesion_capillary", 0},
          {"retention", 0},
          {"exchange_rate", 1e4},
          {"diffusion_rate", 0.05},
          {"internal_friction", 0.4},
          {"sand_viscosity", 0.05},
          {"grain_size", 0.02}}}};
    return presets;
}

const MaterialPreset& material_preset(const std::string& name) {
    for (const MaterialPreset& preset : material_presets()) {
        if (name == preset.name) return preset;
    }
    throw std::runtime_error("no kind of sand \"" + name + "\": there are dry, damp, mud and gravel");
}

} // namespace viewer
