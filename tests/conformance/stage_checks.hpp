// Stages and outputs that the reference solver does not have: ledgers, published fields and limit marks, checked by their
// definitions in double precision.
#pragma once
#include "tests/conformance/bench.hpp"
#include "tests/conformance/compare.hpp"
#include "tests/conformance/stage_reference.hpp"
#include <algorithm>

namespace wadi::conformance {

/// What a check sees of a case: the buffers before and after, and both references in front of the stage.
struct StageRun {
    const compute::StageInfo& stage;
    const Scene& scene;
    const Pilot& pilot; // as it was before the stage
    const WorldParams& params;
    const std::vector<BenchBuffer>& buffers;

    const BenchBuffer& buffer(const char* binding) const;
    float before(const char* binding, int i, int j) const; // 0 where the mask lacks the binding
};

/// NUMERICS 2.23: water that the pores of so much sand hold.
double pore_room(const WorldParams& params, double sand);
/// The water whose surface stands so deep over the ground, in whole quanta.
double water_standing(const WorldParams& params, double depth, double sand);
/// How deep a cell's water stands, from the ground to its surface.
template <class Real> Real standing_water(const StageRun& run, int i, int j) {
    const auto sand = static_cast<double>(run.before("sand_height", i, j)),
               water = static_cast<double>(run.before("water_height", i, j));
    const double room = pore_room(run.params, sand), held = static_cast<double>(run.before("water_in_pores", i, j));
    if (water <= 0) return 0;
    if ((run.scene.effects & EFFECT_INFILTRATION) != 0 && held >= 0 && held < room) { // 2.24: the rest stands on the sand
        const double table = std::min(std::min(water, held) / static_cast<double>(run.params.porosity), sand);
        return static_cast<Real>(water > held ? sand + (water - held) : table);
    }
    return static_cast<Real>(water < room ? std::min(water / static_cast<double>(run.params.porosity), sand)
                                          : water + (sand - room));
}

bool has_definition(const std::string& stage);
/// The direct check of a stage; ok where it has none.
Verdict check_definition(const StageRun& run);

Verdict check_marks(const StageRun& run);        // marks_check.cpp
Verdict check_limit_counts(const StageRun& run); // marks_check.cpp
Verdict check_limit_folds(const StageRun& run);  // marks_check.cpp
Verdict check_published(const StageRun& run);    // published_check.cpp
Verdict check_strips(const StageRun& run);       // tiles_check.cpp
Verdict check_tiles(const StageRun& run);        // tiles_check.cpp

/// Words of fold_tiles' inputs, in the layout of measure_strips' outputs.
std::vector<std::uint32_t> strip_ranges(const FieldLayout& layout);
std::vector<std::uint32_t> strip_changes(const FieldLayout& layout);
Verdict check_samples(const StageRun& run); // samples_check.cpp

} // namespace wadi::conformance
