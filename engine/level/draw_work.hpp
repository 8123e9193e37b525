// What drawing a level's layers will cost, known before the first cell is drawn.
#pragma once
#include "engine/level/coverage.hpp"

namespace wadi {

/// Places at which a layer is asked for its height, each counted by the octaves or segments that are looked at there: some
/// nanoseconds each. Counting ends beyond `most`.
std::int64_t drawing_work(const std::vector<const Layer*>& layers, const LevelGrid& grid, std::int64_t most);

/// The same for samples within cut cells.
std::int64_t sampling_work(const std::vector<const Layer*>& layers, const LevelGrid& grid, const CutCells& cut,
                           std::int64_t most);

/// All that draw_layers() takes for these lists on this grid, but for the lakes of maps, which are drawn on grids of their own.
struct LayersWork {
    std::int64_t looks = 0;
    std::int64_t sampling = 0; // of those, in cut cells
    CutCells cut;              // by the edges of sand and water; not looked for beyond `most`
};
LayersWork layers_work(const LayerLists& lists, const LevelGrid& grid, std::int64_t most);

std::vector<const Layer*> pointers(const std::vector<Layer>& first, const std::vector<Layer>& second = {});

} // namespace wadi
