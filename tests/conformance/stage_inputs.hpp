// What a stage finds in its buffers: the pilot state where it may read, NaN where it may not.
#pragma once
#include "tests/conformance/bench.hpp"
#include "tests/conformance/stage_reference.hpp"

namespace wadi::conformance {

std::vector<BenchBuffer> stage_buffers(const compute::StageInfo& stage, const Scene& scene, const Pilot& pilot,
                                       const WorldParams& params);

/// The range of a field that a stage writes: its values, and for open_sides also the water outside.
compute::Range2 written_range(const std::string& stage, const std::string& base, const WorldParams& params);

/// Words of a ledger before a case: low words close to their carry.
std::uint32_t ledger_start(std::size_t word);

} // namespace wadi::conformance
