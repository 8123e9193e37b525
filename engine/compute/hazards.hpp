// The barrier planner: from the access table alone it decides before which operations a barrier is needed.
#pragma once
#include "engine/compute/program.hpp"
#include <vector>

namespace wadi::compute {

/// One buffer as an operation touches it.
struct BufferUse {
    Buffer buffer;
    bool reads = false;
    bool writes = false;
};

/// What an operation reads and writes; timestamps touch nothing. Conditional bindings that are off are left out.
std::vector<BufferUse> buffer_uses(const Op& op);

/// barrier_before[n]: operation n must see every write and outlast every read since the last barrier that it
/// conflicts with (read after write, write after read, write after write). Planned greedily, so the number of
/// barriers is least for the given order. A barrier separates everything before it from everything after it.
std::vector<bool> plan_barriers(const std::vector<Op>& ops);

/// Edges for graph backends: for each operation the earlier operations it must wait for (transitively reduced
/// only as far as the last writer and the readers since).
std::vector<std::vector<int>> plan_dependencies(const std::vector<Op>& ops);

} // namespace wadi::compute
