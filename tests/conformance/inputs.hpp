// Inputs of the cases: grids, scenes and choices of method, by the names that case strings use.
#pragma once
#include "engine/compute/status.hpp"
#include "engine/settings/data/settings.hpp"
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace wadi::conformance {

struct Scene {
    std::string name;
    Settings settings;
    InitialFields fields;
    std::uint32_t effects = 0;
    bool rough_stretch = false; // the pilot state gets a random strain that yields
    int pilot_steps = 3;        // steps before a stage is looked at; 0 keeps the raw fields
};

std::span<const char* const> grid_names(); // "1x1" ... "70x50"
std::span<const char* const> scene_names();
std::span<const char* const> method_names_of_cases();

/// A scene under exactly this mask. Sources, rain and open sides are there where the mask has them.
/// Errors: bad_argument for an unknown grid, scene or method.
Result<Scene> make_scene(const std::string& grid, const std::string& scene, const std::string& method, std::uint32_t effects);

/// A scene of 256 x 256 cells laid side by side over size x size, for measurements: cheap to make at any size.
/// Errors: bad_argument for an unknown scene.
Result<Scene> make_large_scene(int size, const std::string& scene, std::uint32_t effects);

/// Deterministic noise in [-1, 1] made of eight waves with at least four cells per wavelength.
float band_limited(std::uint32_t seed, int i, int j);

} // namespace wadi::conformance
