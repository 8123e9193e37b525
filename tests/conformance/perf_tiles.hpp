// Measurement: what a step costs where only a part of the world moves, with and without active tiles.
#pragma once
#include "tests/conformance/target.hpp"
#include <vector>

namespace wadi::conformance {

struct PerfTilesOptions {
    int size = 1024;                             // grid side
    std::vector<double> shares = {1, 0.1, 0.01}; // of the world's area that moves
    std::vector<int> tiles = {0, 32, 64};        // sides; 0 = without, tiles_where_they_gain
    int steps = 100;                             // per time
    int repeats = 5;
    bool fused_only = false; // no rows of stages one by one
};

/// Measures one device and prints its rows: sand and water moving in a basin in the middle, bare rock around it.
Status run_perf_tiles(Session& session, const PerfTilesOptions& options);

} // namespace wadi::conformance
