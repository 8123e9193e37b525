// How sources' boxes are cut into pieces for apply_sources: engine/step/plan/source_shapes.hpp.
#include "engine/step/plan/source_shapes.hpp"
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace wadi;

namespace {

Source source_disc(double x, double y, double radius) {
    Source s;
    s.shape = SourceShape::disc;
    s.center = {x, y};
    s.radius = radius;
    return s;
}

Source source_strip(double y0, double y1, double width) {
    Source s;
    s.shape = SourceShape::box;
    s.box = {0, y0, width, y1};
    return s;
}

Settings grid_with_sources(int nx, int ny, std::vector<Source> sources) {
    Settings s;
    s.grid.nx = nx;
    s.grid.ny = ny;
    s.grid.dx = 0.5;
    s.sources = std::move(sources);
    return s;
}

// Pieces that take in each cell, as apply_sources finds the cells of a piece.
std::vector<int> owners(const Settings& s, const SourcePieces& p) {
    std::vector<int> owners(static_cast<std::size_t>(s.grid.nx) * static_cast<std::size_t>(s.grid.ny));
    for (int piece = 0; piece < p.count; ++piece) {
        std::size_t box = 0;
        while (box + 1 < p.boxes.size() && piece >= p.first[box + 1]) ++box;
        const CellBox& cells = p.boxes[box];
        const int columns = cells.i1 - cells.i0, i = cells.i0 + (piece - p.first[box]) % columns;
        const int from = cells.j0 + (piece - p.first[box]) / columns * p.rows;
        for (int j = from; j < std::min(from + p.rows, cells.j1); ++j)
            ++owners[static_cast<std::size_t>(j) * static_cast<std::size_t>(s.grid.nx) + static_cast<std::size_t>(i)];
    }
    return owners;
}

// Every cell under a source, and those whose faces it covers, in one piece; no cell in two; a counter for each piece.
void check_pieces(const Settings& s) {
    const auto pieces = source_pieces(s);
    const FieldLayout layout{s.grid.nx, s.grid.ny};
    CHECK(pieces.count <= layout.strips() * layout.pitch());
    CHECK(pieces.boxes.size() <= MAX_SOURCES);
    const auto owned = owners(s, pieces);
    CHECK(*std::max_element(owned.begin(), owned.end()) == 1);
    int missed = 0;
    for (int j = 0; j < s.grid.ny; ++j) {
        for (int i = 0; i < s.grid.nx; ++i) {
            const double x = i * s.grid.dx, y = j * s.grid.dx; // low corner
            const bool covered = std::any_of(s.sources.begin(), s.sources.end(), [&](const Source& source) {
                if (source.shape == SourceShape::disc)
                    return std::hypot(x - source.center[0], y - source.center[1]) <= source.radius;
                return x >= source.box[0] && x <= source.box[2] && y >= source.box[1] && y <= source.box[3];
            });
            missed += covered &&
                      owned[static_cast<std::size_t>(j) * static_cast<std::size_t>(s.grid.nx) + static_cast<std::size_t>(i)] == 0;
        }
    }
    CHECK(missed == 0);
}

} // namespace

TEST_CASE("source pieces: small sources have a piece for each cell, far ones boxes of their own") {
    const auto s = grid_with_sources(200, 200, {source_disc(10, 10, 3), source_disc(90, 90, 3), source_disc(12, 11, 2)});
    const auto pieces = source_pieces(s);
    CHECK(pieces.rows == 1);
    CHECK(pieces.boxes.size() == 2);
    CHECK(pieces.box_of == std::vector{0, 1, 0});
    CHECK(pieces.count < 20 * 20 * 2);
    check_pieces(s);
}

TEST_CASE("source pieces: boxes larger than the counters get rows, many flat ones become one") {
    const auto whole = grid_with_sources(100, 100, {source_strip(0, 50, 50)});
    CHECK(source_pieces(whole).rows > 1);
    CHECK(source_pieces(whole).rows <= STRIP);
    check_pieces(whole);
    std::vector<Source> strips;
    for (int n = 0; n < 24; ++n) strips.push_back(source_strip(2.5 * n + 0.1, 2.5 * n + 0.4, 50));
    const auto flat = grid_with_sources(100, 125, strips);
    CHECK(source_pieces(flat).boxes.size() == 1);
    check_pieces(flat);
}

TEST_CASE("source pieces: at the rim of the grid, and beyond it") {
    check_pieces(grid_with_sources(33, 17, {source_disc(0, 0, 2), source_disc(16.5, 8.5, 1)}));
    const auto outside = grid_with_sources(33, 17, {source_disc(-40, -40, 2), source_disc(8, 4, 1)});
    CHECK(source_pieces(outside).box_of == std::vector{-1, 0});
    check_pieces(outside);
    CHECK(source_pieces(grid_with_sources(8, 8, {})).count == 0);
}
