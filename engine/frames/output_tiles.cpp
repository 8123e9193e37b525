#include "engine/frames/output_tiles.hpp"
#include "engine/step/run/step_number.hpp"
#include <algorithm>
#include <array>
#include <cstring>

namespace wadi {

Tile Tiles::operator[](int n) const {
    const int i = n % columns(), j = n / columns();
    const auto at = static_cast<std::size_t>(j * layout.tile_columns() + i);
    std::array<float, 4> range;
    std::int32_t changed;
    std::memcpy(range.data(), ranges.data() + at * sizeof range, sizeof range);
    std::memcpy(&changed, changes.data() + at * sizeof changed, sizeof changed);
    const Region cells = {i * STRIP, j * STRIP, std::min(STRIP, layout.nx - i * STRIP), std::min(STRIP, layout.ny - j * STRIP)};
    return {cells, range[0], range[1], range[2], range[3], step_behind(changed, step)};
}

} // namespace wadi
