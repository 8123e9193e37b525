// The files that a level names, and what they may hold together.
#pragma once
#include "engine/image/map.hpp"

namespace wadi {

/// Values of maps and bytes of series: whatever the grid, and per cell of it.
inline constexpr std::int64_t LEVEL_VALUES = std::int64_t{8192} * 8192, LEVEL_VALUES_PER_CELL = 16;

struct LevelFiles {
    FileReader read;
    FileRoom room{LEVEL_VALUES};
};

} // namespace wadi
