#include "engine/step/wakes.hpp"
#include <algorithm>
#include <cmath>
#include <cstring>

namespace wadi {

namespace {

constexpr double margin = 2; // cells: for faces, and for roundings of the stages

int to_cell(double at, int cells) { return static_cast<int>(std::clamp(std::floor(at), -1.0, static_cast<double>(cells) + 1)); }

// Cells from (x0, y0) to (x1, y1), in cells, and the margin around them.
void wake_box(WorldState& state, double x0, double y0, double x1, double y1) {
    const auto& layout = state.layout();
    state.wake(to_cell(x0 - margin, layout.nx), to_cell(y0 - margin, layout.ny), to_cell(x1 + margin, layout.nx) + 1,
               to_cell(y1 + margin, layout.ny) + 1);
}

} // namespace

void InputWakes::wake(const StepInput& input) {
    if (!state_.plan().active_tiles) return;
    if (input.rain > 0 || input.evaporation > 0) state_.wake_all();
    wake_sources(input);
    wake_sides(input);
    before_ = input;
}

void InputWakes::wake_sources(const StepInput& input) {
    const double dx = state_.settings().grid.dx;
    const auto& sources = state_.settings().sources;
    for (std::size_t n = 0; n < sources.size(); ++n) {
        const auto& s = sources[n];
        if (input.source[n].x == 0) continue;
        const bool box = s.shape == SourceShape::box;
        const double r = s.shape == SourceShape::disc ? s.radius : 0;
        const auto low = [&](std::size_t axis) { return (box ? s.box[axis] : s.center[axis] - r) / dx; };
        const auto high = [&](std::size_t axis) { return (box ? s.box[axis + 2] : s.center[axis] + r) / dx; };
        wake_box(state_, low(0), low(1), high(0), high(1));
    }
}

void InputWakes::wake_sides(const StepInput& input) {
    const auto& layout = state_.layout();
    for (std::size_t n = 0; n < 4; ++n) {
        if (state_.settings().sides[n].kind == SideKind::wall) continue;
        if (before_ && std::memcmp(&before_->side[n], &input.side[n], sizeof(vec4)) == 0) continue;
        const bool along_y = n == SIDE_WEST || n == SIDE_EAST;
        const double at = n == SIDE_EAST ? layout.nx : n == SIDE_NORTH ? layout.ny : 0;
        along_y ? wake_box(state_, at, 0, at, layout.ny) : wake_box(state_, 0, at, layout.nx, at);
    }
}

void wake_edits(WorldState& state, const StepInput& input) {
    for (int n = 0; n < input.edit_count; ++n) {
        const vec4& line = input.edit[EDIT_VECTORS * n];
        const vec4& shape = input.edit[EDIT_VECTORS * n + 1];
        const bool stamp = static_cast<int>(shape.w) == EDIT_STAMP;
        const double x = line.x, y = line.y, r = stamp ? 0.0 : static_cast<double>(shape.x);
        const double dx = line.z, dy = line.w;
        wake_box(state, std::min(x, x + dx) - r, std::min(y, y + dy) - r, std::max(x, x + dx) + r, std::max(y, y + dy) + r);
    }
}

} // namespace wadi
