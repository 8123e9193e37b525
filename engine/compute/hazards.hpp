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
    bool groups = false; // read, too, by the device itself: how many groups to run (a dispatch over active tiles)
};

/// What an operation reads and writes; timestamps touch nothing. Conditional bindings that are off are left out.
std::vector<BufferUse> buffer_uses(const Op& op);

/// What must stand before an operation.
struct Barrier {
    /// It must see every write and outlast every read since the last barrier that it conflicts with (read after write, write
    /// after read, write after write).
    bool memory = false;
    /// It is the first to read its groups since they were written or the program began. For devices that read groups ahead of the
    /// stage: such a barrier costs them more than others, so later dispatches have none.
    bool groups = false;
    friend bool operator==(Barrier, Barrier) = default;
};

/// One per operation. Planned greedily, so the number of memory barriers is least for the given order. A barrier separates
/// everything before it from everything after it.
std::vector<Barrier> plan_barriers(const std::vector<Op>& ops);

/// Edges for graph backends: for each operation the earlier operations it must wait for (transitively reduced
/// only as far as the last writer and the readers since).
std::vector<std::vector<int>> plan_dependencies(const std::vector<Op>& ops);

} // namespace wadi::compute
