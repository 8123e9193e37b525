// Negative controls: the tests must fail where it should.
#pragma once
#include "tests/conformance/report.hpp"

namespace wadi::conformance {

/// Runs stage cases on the CPU, tampers with what came back and adds a failure for every case that still passes.
void run_self_check(Report& report);

} // namespace wadi::conformance
