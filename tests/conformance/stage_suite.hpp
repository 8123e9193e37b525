// Suite 2: each stage under each mask it can tell apart, alone on the device, against the references.
#pragma once
#include "tests/conformance/bench.hpp"
#include "tests/conformance/target.hpp"
#include <functional>

namespace wadi::conformance {

/// Changes what came back before it is judged: for the tests' own negative controls.
using Tamper = std::function<void(const compute::StageInfo& stage, std::vector<BenchBuffer>& buffers)>;

Verdict run_stage_case(const CaseSpec& spec, compute::Device& device, const Tamper& tamper);

} // namespace wadi::conformance
