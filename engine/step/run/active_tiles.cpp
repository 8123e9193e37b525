#include "engine/step/run/active_tiles.hpp"
#include <algorithm>
#include <cmath>
#include <cstring>

namespace wadi {

namespace {

constexpr double margin = 2; // cells: for faces, and for roundings of the stages

int to_cell(double at, int cells) { return static_cast<int>(std::clamp(std::floor(at), -1.0, static_cast<double>(cells) + 1)); }

} // namespace

ActiveTiles::ActiveTiles(const Settings& settings)
    : settings_(settings), size_(settings.tile_side()),
      columns_(size_ > 0 ? FieldLayout::active_tiles(settings.grid.nx, size_) : 0),
      rows_(size_ > 0 ? FieldLayout::active_tiles(settings.grid.ny, size_) : 0) {}

void ActiveTiles::wake(int i0, int j0, int i1, int j1) {
    if (size_ == 0 || i1 <= i0 || j1 <= j0) return;
    const auto tile = [&](int at, int count) { return std::clamp(at / size_, 0, count - 1); };
    const Box box = {tile(i0, columns_), tile(j0, rows_), tile(i1 - 1, columns_), tile(j1 - 1, rows_)};
    if (std::find(wakes_.begin(), wakes_.end(), box) != wakes_.end()) return;
    if (wakes_.size() < MAX_WAKES) {
        wakes_.push_back(box);
        return;
    }
    for (std::size_t n = 0; n < 4; ++n) wakes_[0][n] = n < 2 ? std::min(wakes_[0][n], box[n]) : std::max(wakes_[0][n], box[n]);
}

void ActiveTiles::wake_all() { wake(0, 0, settings_.grid.nx + 1, settings_.grid.ny + 1); }

// From (x0, y0) to (x1, y1), in cells, and the margin around them.
void ActiveTiles::wake_around(double x0, double y0, double x1, double y1) {
    const auto& grid = settings_.grid;
    wake(to_cell(x0 - margin, grid.nx), to_cell(y0 - margin, grid.ny), to_cell(x1 + margin, grid.nx) + 1,
         to_cell(y1 + margin, grid.ny) + 1);
}

void ActiveTiles::wake_edits(const StepInput& input) {
    for (int n = 0; n < input.edit_count; ++n) {
        const EditInput& edit = input.edit[n];
        const auto wide = [](float value) { return static_cast<double>(value); };
        const double x = wide(edit.from_x), y = wide(edit.from_y), r = wide(edit.radius);
        const double dx = wide(edit.along_x), dy = wide(edit.along_y);
        wake_around(std::min(x, x + dx) - r, std::min(y, y + dy) - r, std::max(x, x + dx) + r, std::max(y, y + dy) + r);
    }
}

void ActiveTiles::wake_inputs(const StepInput& input) {
    if (size_ == 0) return;
    if (input.rain > 0 || input.mapped_rain.x > 0 || input.evaporation > 0) wake_all();
    wake_sources(input);
    wake_sides(input);
    before_ = input;
}

void ActiveTiles::wake_sources(const StepInput& input) {
    const double dx = settings_.grid.dx;
    for (std::size_t n = 0; n < settings_.sources.size(); ++n) {
        const auto& s = settings_.sources[n];
        if (input.source[n].x == 0) continue;
        const bool box = s.shape == SourceShape::box;
        const double r = s.shape == SourceShape::disc ? s.radius : 0;
        const auto low = [&](std::size_t axis) { return (box ? s.box[axis] : s.center[axis] - r) / dx; };
        const auto high = [&](std::size_t axis) { return (box ? s.box[axis + 2] : s.center[axis] + r) / dx; };
        wake_around(low(0), low(1), high(0), high(1));
    }
}

void ActiveTiles::wake_sides(const StepInput& input) {
    const double nx = settings_.grid.nx, ny = settings_.grid.ny;
    for (std::size_t n = 0; n < 4; ++n) {
        if (settings_.sides[n].kind == SideKind::wall) continue;
        if (before_ && std::memcmp(&before_->side[n], &input.side[n], sizeof(vec4)) == 0) continue;
        const bool along_y = n == SIDE_WEST || n == SIDE_EAST;
        const double at = n == SIDE_EAST ? nx : n == SIDE_NORTH ? ny : 0;
        along_y ? wake_around(at, 0, at, ny) : wake_around(0, at, nx, at);
    }
}

void ActiveTiles::put(StepInput& input) const {
    for (const auto& box : wakes_) {
        const auto at = [&](std::size_t n) { return static_cast<float>(box[n]); };
        input.wake[input.wake_count++] = {at(0), at(1), at(2), at(3)};
    }
}

} // namespace wadi
