// Stages and outputs that the reference solver does not have: ledgers, published fields and limit marks, checked by their
// definitions in double precision.
#pragma once
#include "tests/conformance/bench.hpp"
#include "tests/conformance/compare.hpp"
#include "tests/conformance/stage_reference.hpp"

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

bool has_definition(const std::string& stage);
/// The direct check of a stage; ok where it has none.
Verdict check_definition(const StageRun& run);

Verdict check_marks(const StageRun& run);        // marks_check.cpp
Verdict check_limit_counts(const StageRun& run); // marks_check.cpp
Verdict check_published(const StageRun& run);    // published_check.cpp
Verdict check_strips(const StageRun& run);       // tiles_check.cpp
Verdict check_tiles(const StageRun& run);        // tiles_check.cpp

/// Words of fold_tiles' inputs, in the layout of measure_strips' outputs.
std::vector<std::uint32_t> strip_ranges(const FieldLayout& layout);
std::vector<std::uint32_t> strip_changes(const FieldLayout& layout);
Verdict check_samples(const StageRun& run); // samples_check.cpp

} // namespace wadi::conformance
