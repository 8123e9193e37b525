// Accuracy presets: draft, balanced, accurate, chosen from the measured frontier of error against time (tests/lab/report).
#pragma once
#include <span>
#include <string>
#include <vector>

namespace wadi {

/// What a preset changes, and what that was measured to err and cost, each as a factor on `balanced`.
struct AccuracyPreset {
    const char* name;
    double cells;    // factor on the level's cells along x and y; dt follows the cells' size
    int substeps;    // sand substeps per water step
    int water_order; // method.water_transport_order; 0 = the level's
    double error;    // mean absolute error of sand and water surface
    double gpu_cost; // time per simulated second, one H100
    double cpu_cost; // the same, 16 threads of its host
};

/// By rising accuracy.
std::span<const AccuracyPreset> accuracy_presets();
/// Null for an unknown name.
const AccuracyPreset* find_accuracy_preset(const std::string& name);
std::vector<std::string> accuracy_names();

} // namespace wadi
