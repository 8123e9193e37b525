#include "engine/step/plan/source_shapes.hpp"
#include <algorithm>
#include <cmath>
#include <cstring>

namespace wadi {

namespace {

int cell_of(double metres, double dx, int cells) {
    return static_cast<int>(std::clamp(std::floor(metres / dx), -2.0, cells + 2.0));
}

// The cells whose centres or low faces a source may cover, one more all around for the roundings of the stage.
CellBox box_around(const Source& source, const Grid& grid) {
    const bool box = source.shape == SourceShape::box;
    const double r = source.shape == SourceShape::disc ? source.radius : 0;
    const auto low = [&](std::size_t axis, int cells) {
        return std::max(cell_of(box ? source.box[axis] : source.center[axis] - r, grid.dx, cells) - 1, 0);
    };
    const auto high = [&](std::size_t axis, int cells) {
        return std::min(cell_of(box ? source.box[axis + 2] : source.center[axis] + r, grid.dx, cells) + 2, cells);
    };
    return {low(0, grid.nx), low(1, grid.ny), high(0, grid.nx), high(1, grid.ny)};
}

bool empty(const CellBox& box) { return box.i1 <= box.i0 || box.j1 <= box.j0; }

bool overlap(const CellBox& a, const CellBox& b) { return a.i0 < b.i1 && b.i0 < a.i1 && a.j0 < b.j1 && b.j0 < a.j1; }

CellBox hull(const CellBox& a, const CellBox& b) {
    return {std::min(a.i0, b.i0), std::min(a.j0, b.j0), std::max(a.i1, b.i1), std::max(a.j1, b.j1)};
}

// Boxes that overlap become one, until none do.
std::vector<CellBox> merged(std::vector<CellBox> boxes) {
    for (std::size_t a = 0; a < boxes.size(); ++a) {
        for (std::size_t b = a + 1; b < boxes.size(); ++b) {
            if (!overlap(boxes[a], boxes[b])) continue;
            boxes[a] = hull(boxes[a], boxes[b]);
            boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(b));
            return merged(std::move(boxes));
        }
    }
    return boxes;
}

void number(SourcePieces& pieces) {
    pieces.first.clear();
    pieces.count = 0;
    for (const CellBox& box : pieces.boxes) {
        pieces.first.push_back(pieces.count);
        pieces.count += (box.i1 - box.i0) * ((box.j1 - box.j0 + pieces.rows - 1) / pieces.rows);
    }
}

} // namespace

SourcePieces source_pieces(const Settings& settings) {
    const FieldLayout layout{settings.grid.nx, settings.grid.ny};
    const int counters = layout.strips() * layout.pitch();
    std::vector<CellBox> all;
    for (const auto& source : settings.sources) all.push_back(box_around(source, settings.grid));
    SourcePieces pieces;
    std::copy_if(all.begin(), all.end(), std::back_inserter(pieces.boxes), [](const CellBox& box) { return !empty(box); });
    pieces.boxes = merged(std::move(pieces.boxes));
    number(pieces);
    while (pieces.count > counters && pieces.rows < STRIP) {
        ++pieces.rows;
        number(pieces);
    }
    if (pieces.count > counters) { // many flat boxes; strips of one box always fit
        CellBox one = pieces.boxes.front();
        for (const CellBox& box : pieces.boxes) one = hull(one, box);
        pieces.boxes = {one};
        number(pieces);
    }
    for (const CellBox& box : all) {
        const auto found = std::find_if(pieces.boxes.begin(), pieces.boxes.end(),
                                        [&](const CellBox& b) { return !empty(box) && overlap(b, box); });
        pieces.box_of.push_back(found == pieces.boxes.end() ? -1 : static_cast<int>(found - pieces.boxes.begin()));
    }
    return pieces;
}

std::vector<vec4> source_shapes(const Settings& settings) {
    const SourcePieces pieces = source_pieces(settings);
    std::vector<vec4> shapes(SOURCE_VECTORS, vec4{0, 0, 0, 0});
    const double dx = settings.grid.dx;
    for (std::size_t n = 0; n < settings.sources.size(); ++n) {
        const auto& s = settings.sources[n];
        auto& shape = shapes[2 * n];
        const auto set = [&](double x, double y, double z, double w) {
            shape = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), static_cast<float>(w)};
        };
        float kind = SOURCE_BOX;
        if (s.shape == SourceShape::disc) {
            kind = SOURCE_DISC;
            set(s.center[0], s.center[1], s.radius * s.radius, 0);
        } else if (s.shape == SourceShape::box) {
            set(s.box[0], s.box[1], s.box[2], s.box[3]);
        } else { // the cell that holds the point and its four faces: a quarter cell of margin, clear of every other centre
            const double x = std::floor(s.center[0] / dx) * dx, y = std::floor(s.center[1] / dx) * dx;
            set(x - 0.25 * dx, y - 0.25 * dx, x + 1.25 * dx, y + 1.25 * dx);
        }
        shapes[2 * n + 1] = {kind, static_cast<float>(s.material == SourceMaterial::water ? MATERIAL_WATER : MATERIAL_SAND),
                             static_cast<float>(pieces.box_of[n]), s.level.samples.empty() ? 0.0F : 1.0F};
    }
    for (std::size_t n = 0; n < pieces.boxes.size(); ++n) {
        const CellBox& box = pieces.boxes[n];
        const auto at = 2 * (MAX_SOURCES + n);
        shapes[at] = {static_cast<float>(box.i0), static_cast<float>(box.j0), static_cast<float>(box.i1),
                      static_cast<float>(box.j1)};
        shapes[at + 1] = {static_cast<float>(pieces.first[n]), 0, 0, 0};
    }
    return shapes;
}

bool same_source_shapes(const Settings& a, const Settings& b) {
    if (a.sources.size() != b.sources.size()) return false;
    const auto of_a = source_shapes(a), of_b = source_shapes(b); // boxes, their pieces and rows follow from the shapes
    return std::memcmp(of_a.data(), of_b.data(), of_a.size() * sizeof(vec4)) == 0;
}

} // namespace wadi
