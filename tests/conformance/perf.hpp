// Measurements: time per stage and per whole step, the bytes they move, and how near that is to what the device can copy.
#pragma once
#include "tests/conformance/target.hpp"
#include <string>
#include <vector>

namespace wadi::conformance {

struct PerfOptions {
    int min_size = 128, max_size = 1024; // doubled from one to the other
    int repeats = 20;
    std::string stage;            // "" = all stages and whole steps
    std::string scene = "random"; // hardest: every cell moves, at the clamps and limits
    bool csv = false;
};

/// Measures one device and prints its rows; CSV with a header when `first`.
Status run_perf(Session& session, const PerfOptions& options, bool first);

} // namespace wadi::conformance
