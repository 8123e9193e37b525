// Accuracy presets: draft, balanced, accurate and fine, chosen from the measured frontier of error against time
// (tests/lab/report); what one costs on a machine, wadi-tune measures there.
#pragma once
#include <span>
#include <string>
#include <vector>

namespace wadi {

/// What a preset changes.
struct AccuracyPreset {
    const char* name;
    double cells;    // factor on the level's cells along x and y; dt follows the cells' size; 0 = the level's fine_grid
    int substeps;    // sand substeps per water step; 0 = the level's
    int water_order; // method.water_transport_order; 0 = the level's
};

/// By rising accuracy.
std::span<const AccuracyPreset> accuracy_presets();
/// Null for an unknown name.
const AccuracyPreset* find_accuracy_preset(const std::string& name);
std::vector<std::string> accuracy_names();

} // namespace wadi
