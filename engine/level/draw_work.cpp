#include "engine/level/draw_work.hpp"
#include "engine/level/thin_lines.hpp"
#include <algorithm>
#include <cmath>

namespace wadi {
namespace {

constexpr int WORK_BLOCK = 64; // cells, as rows are drawn in pieces

/// Calls visit(i, j, n) for every block that layer n may change; it says whether to go on.
template <class Visit> void in_blocks(const std::vector<const Layer*>& layers, const LevelGrid& grid, const Visit& visit) {
    for (std::size_t n = 0; n < layers.size(); ++n) {
        const CellRange range = reach_of(*layers[n], grid);
        for (int j = range.begin_y / WORK_BLOCK; j * WORK_BLOCK < range.end_y; ++j)
            for (int i = range.begin_x / WORK_BLOCK; i * WORK_BLOCK < range.end_x; ++i)
                if (!visit(i, j, n)) return;
    }
}

/// Octaves or segments that count at a place of this block.
std::int64_t looks_per_place(const Layer& layer, const LevelGrid& grid, int i, int j) {
    if (layer.map || layer.shape.kind == ShapeKind::plane) return 1;
    if (layer.shape.kind == ShapeKind::noise) return layer.shape.octaves;
    if (layer.shape.kind != ShapeKind::ridge) return 1;
    const double size = WORK_BLOCK * grid.dx, height = size / grid.stretch_y;
    const Point middle = {(i + 0.5) * size, (j + 0.5) * height};
    return static_cast<std::int64_t>(segments_near(layer.shape, middle, std::hypot(size, height) / 2).size());
}

std::int64_t segments(const Layer& layer) { return static_cast<std::int64_t>(layer.shape.points.size()); }

} // namespace

std::int64_t drawing_work(const std::vector<const Layer*>& layers, const LevelGrid& grid, std::int64_t most) {
    std::int64_t work = 0;
    in_blocks(layers, grid, [&](int i, int j, std::size_t n) {
        const std::int64_t width = std::min(WORK_BLOCK, grid.nx - i * WORK_BLOCK),
                           rows = std::min(WORK_BLOCK, grid.ny - j * WORK_BLOCK);
        work += rows * (width * looks_per_place(*layers[n], grid, i, j) + segments(*layers[n]));
        return work <= most;
    });
    return work;
}

std::int64_t sampling_work(const std::vector<const Layer*>& layers, const LevelGrid& grid, const CutCells& cut,
                           std::int64_t most) {
    struct Near {
        std::int64_t layers = 0, looks = 0, segments = 0;
    };
    const auto columns = static_cast<std::size_t>((grid.nx + WORK_BLOCK - 1) / WORK_BLOCK);
    const auto width = static_cast<std::size_t>(grid.nx);
    std::vector<Near> near(columns * static_cast<std::size_t>((grid.ny + WORK_BLOCK - 1) / WORK_BLOCK));
    const auto block_of = [&](std::size_t cell) { return cell / width / WORK_BLOCK * columns + cell % width / WORK_BLOCK; };
    std::vector<char> needed(near.size());
    for (const std::size_t cell : cut.cells) needed[block_of(cell)] = 1;
    in_blocks(layers, grid, [&](int i, int j, std::size_t n) {
        const std::size_t block = static_cast<std::size_t>(j) * columns + static_cast<std::size_t>(i);
        if (needed[block] == 0) return true;
        ++near[block].layers;
        near[block].looks += looks_per_place(*layers[n], grid, i, j);
        near[block].segments += segments(*layers[n]);
        return true;
    });
    constexpr std::int64_t parts = CELL_PARTS * CELL_PARTS;
    std::int64_t work = 0;
    for (std::size_t n = 0; n < cut.cells.size() && work <= most; ++n) {
        const Near& here = near[block_of(cut.cells[n])];
        work += here.segments + parts * (here.looks + (1 + cut.edges[n]) * here.layers);
    }
    return work;
}

std::vector<const Layer*> pointers(const std::vector<Layer>& first, const std::vector<Layer>& second) {
    std::vector<const Layer*> layers;
    for (const auto* list : {&first, &second})
        for (const Layer& layer : *list) layers.push_back(&layer);
    return layers;
}

LayersWork layers_work(const LayerLists& lists, const LevelGrid& grid, std::int64_t most) {
    LayersWork work;
    for (const auto* list : {&lists.terrain, &lists.sand, &lists.water}) {
        work.looks += drawing_work(pointers(*list), grid, most);
        if (work.looks > most) return work;
    }
    for (const Layer& layer : lists.terrain) work.looks += thin_line_work(layer, grid);
    if (work.looks > most) return work;
    work.cut = cut_cells(pointers(lists.sand, lists.water), grid);
    // Sand's samples are taken again with those of water.
    const std::int64_t times = lists.sand.empty() || lists.water.empty() ? 1 : 2;
    work.sampling = times * sampling_work(pointers(lists.sand, lists.water), grid, work.cut, most);
    work.looks += work.sampling;
    return work;
}

} // namespace wadi
