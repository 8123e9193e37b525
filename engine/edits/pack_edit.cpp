// Edits as apply_edits reads them.
#include "engine/edits/edits.hpp"
#include <algorithm>
#include <cmath>

namespace wadi {

bool pack_edit(const Edit& edit, std::span<const Stamp> stamps, const Grid& grid, EditInput& to) {
    const auto f = [](double x) { return static_cast<float>(x); };
    // Whole 1/256 cells: distances to cell centres are then exact (shaders/physics/edit.glsl).
    const auto cells = [&](double metres) { return std::nearbyint(metres / grid.dx * 256) / 256; };
    const bool is_stamp = edit.kind == EditKind::stamp, line = is_stamp || edit.capsule;
    const double x = cells(edit.x0), y = cells(edit.y0), along_x = line ? cells(edit.x1) - x : 0,
                 along_y = line ? cells(edit.y1) - y : 0;
    const double radius = is_stamp ? 0 : edit.radius / grid.dx;
    if (std::max(x, x + along_x) + radius < 0 || std::min(x, x + along_x) - radius > grid.nx ||
        std::max(y, y + along_y) + radius < 0 || std::min(y, y + along_y) - radius > grid.ny)
        return false;
    to = {};
    to.from_x = f(x);
    to.from_y = f(y);
    to.along_x = f(along_x);
    to.along_y = f(along_y);
    to.kind = static_cast<int>(edit.kind);
    to.layer = static_cast<int>(edit.layer);
    if (is_stamp) {
        if (along_x <= 0 || along_y <= 0) return false; // narrower than 1/256 cell
        const auto& stamp = stamps[edit.stamp - 1];
        to.amount = f(edit.amount);
        to.columns = stamp.nx;
        to.rows = stamp.ny;
        to.page = static_cast<int>(stamp.page);
        return true;
    }
    // A fade narrower than a cell would hit or miss middles of cells: a hard rim in its middle, by the share that it covers.
    const double fade = edit.softness * radius;
    const bool hard = edit.kind == EditKind::brush && fade < 1;
    const double rim = hard ? radius - fade / 2 : radius;
    const double length2 = along_x * along_x + along_y * along_y;
    constexpr double sharp = 1e30; // no falloff: weight 1 up to the radius
    to.radius = f(rim);
    to.inv_fade = edit.softness > 0 ? f(std::min(sharp, 1 / (edit.softness * radius))) : f(sharp);
    to.inv_length2 = length2 > 0 ? f(1 / length2) : 0.0F;
    if (edit.kind == EditKind::brush) {
        constexpr double small = 2; // cells: below it the rim bends within a cell
        constexpr int parts = 8;
        to.amount = f(edit.amount);
        to.rim_parts = !hard ? 0 : rim < small ? parts : 1;
    } else {
        to.amount = f(edit.strength);
        to.velocity_x = f(edit.velocity_x);
        to.velocity_y = f(edit.velocity_y);
    }
    return true;
}

} // namespace wadi
