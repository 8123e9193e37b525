#include "points.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace recorder {
namespace {

namespace fs = std::filesystem;

constexpr double ROUNDING = 1 + 1e-9; // 12 cells of 2.4 m are less than 28.8 m

fs::path part_of(fs::path path) { return path += ".part"; }

/// Pulls a coordinate on the far rim in by what its product with 1/dx may be rounded up.
float within_rim(double at, double length) {
    return static_cast<float>(std::min(at, length * (1 - 4 * double{std::numeric_limits<float>::epsilon()})));
}

} // namespace

Failure PointTable::add(const wadi_world_info& info, std::uint32_t number, const PointRequest& request, bool on_map) {
    const double width = info.nx * info.dx, depth = info.ny * info.dx;
    const double west = on_map ? info.origin_x : 0, south = on_map ? info.origin_y : 0;
    for (const auto& [x, y] : {request.from, request.to}) {
        const auto inside = [&](double from_west, double from_south) {
            return from_west >= 0 && from_west <= width * ROUNDING && from_south >= 0 && from_south <= depth * ROUNDING;
        };
        if (inside(x - west, y - south)) continue;
        char text[240];
        std::snprintf(text, sizeof text, ": (%.12g, %.12g) lies outside the grid, (%.12g, %.12g) ... (%.12g, %.12g) m%s", x, y,
                      west, south, west + width, south + depth,
                      !on_map && inside(x - info.origin_x, y - info.origin_y) ? "; on its map it lies inside: --map-coordinates"
                                                                              : "");
        return {EXIT_BAD_INPUT, request.option + text};
    }
    const double along_x = request.to[0] - request.from[0], along_y = request.to[1] - request.from[1];
    const double length = std::hypot(along_x, along_y);
    const int parts = static_cast<int>(std::ceil(length / info.dx * (1 - 1e-9)));
    for (int n = 0; n <= parts; ++n) {
        const double share = parts > 0 ? static_cast<double>(n) / parts : 0;
        const double x = request.from[0] + share * along_x, y = request.from[1] + share * along_y;
        xy_.push_back(within_rim(x - west, width));
        xy_.push_back(within_rim(y - south, depth));
        points_.push_back({number, x, y, share * length, add_cells_around(info, x - west, y - south)});
    }
    return {};
}

std::array<double, 4> PointTable::add_cells_around(const wadi_world_info& info, double x, double y) {
    const auto along = [&](double at, int cells) { return std::clamp(at / info.dx - 0.5, 0.0, cells - 1.0); };
    const double place[2] = {along(x, info.nx), along(y, info.ny)}, first[2] = {std::floor(place[0]), std::floor(place[1])};
    std::array<double, 4> weights{};
    for (std::size_t n = 0; n < weights.size(); ++n) {
        const bool east = n % 2 == 1, north = n / 2 == 1;
        xy_.push_back(static_cast<float>((std::min(first[0] + east, info.nx - 1.0) + 0.5) * info.dx));
        xy_.push_back(static_cast<float>((std::min(first[1] + north, info.ny - 1.0) + 0.5) * info.dx));
        const double share[2] = {place[0] - first[0], place[1] - first[1]};
        weights[n] = (east ? share[0] : 1 - share[0]) * (north ? share[1] : 1 - share[1]);
    }
    return weights;
}

/// Of the water, from those of the four cells around that hold it: beside a wall the surface between cells is half wall. Not a
/// number where none does; a film on a wall does not count.
double PointTable::water_surface(std::size_t point) const {
    const wadi_query_result* const around = &results_[QUERIES * point + 1];
    const auto depth = [&](std::size_t n) { return static_cast<double>(around[n].water_depth); };
    const double film = 0.01 * std::max({depth(0), depth(1), depth(2), depth(3)});
    double sum = 0, weight = 0, any = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t n = 0; n < 4; ++n) {
        if (!(depth(n) > film)) continue;
        const double surface = static_cast<double>(around[n].terrain) + static_cast<double>(around[n].sand_depth) + depth(n);
        const double own = points_[point].weights[n];
        sum += own * surface;
        weight += own;
        any = surface;
    }
    return weight > 0 ? sum / weight : any;
}

Failure PointTable::unwritten() const { return {EXIT_BAD_INPUT, "cannot write " + path_.string()}; }

Failure PointTable::open() {
    file_.open(part_of(path_), std::ios::trunc);
    file_ << "time," << number_name_
          << ",x,y,distance,surface,terrain,sand_depth,water_depth,saturation,velocity_x,velocity_y,water_surface\n";
    return file_ ? Failure{} : unwritten();
}

Failure PointTable::sample(World& world, double time) {
    if (Failure failure = world.read_points(xy_, results_)) return failure;
    char line[320];
    for (std::size_t n = 0; n < points_.size(); ++n) {
        const TablePoint& at = points_[n];
        const wadi_query_result& r = results_[QUERIES * n];
        const auto value = [](float x) { return static_cast<double>(x); };
        std::snprintf(line, sizeof line, "%.9g,%u,%.12g,%.12g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", time, at.number,
                      at.x, at.y, at.distance, value(r.surface), value(r.terrain), value(r.sand_depth), value(r.water_depth),
                      value(r.saturation), value(r.velocity[0]), value(r.velocity[1]), water_surface(n));
        file_ << line;
    }
    return file_.flush() ? Failure{} : unwritten();
}

Failure PointTable::close() {
    if (!file_.is_open()) return {};
    file_.close();
    std::error_code error;
    if (file_) fs::rename(part_of(path_), path_, error);
    if (file_ && !error) return {};
    fs::remove(part_of(path_), error);
    return unwritten();
}

} // namespace recorder
