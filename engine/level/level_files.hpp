// The files that a level names, what they may hold together, and the work that drawing may take.
#pragma once
#include "engine/image/map.hpp"
#include "engine/level/progress.hpp"

namespace wadi {

/// Values of maps and bytes of series: whatever the grid, and per cell of it.
inline constexpr std::int64_t LEVEL_VALUES = std::int64_t{8192} * 8192, LEVEL_VALUES_PER_CELL = 16;

/// draw_work.hpp: whatever the grid, and per cell of it. Seconds of one thread on small grids.
inline constexpr std::int64_t LEVEL_WORK = 200'000'000, LEVEL_WORK_PER_CELL = 256;

struct LevelFiles {
    FileReader read;
    FileRoom room{LEVEL_VALUES};
    int own_nx = 0, own_ny = 0; // cells of the level's own grid: a map of that size has its samples in their middles
    std::int64_t work_most = LEVEL_WORK, work = 0;
    Progress* progress = nullptr; // null: nobody asks
    /// Errors: bad_file, with the sum and the limit.
    Status take_work(std::int64_t more);
    /// Throws Cancelled.
    void did(std::int64_t more) const {
        if (progress != nullptr) progress->add(more);
    }
};

} // namespace wadi
