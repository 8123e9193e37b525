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

Failure PointTable::add(const wadi_world_info& info, std::uint32_t number, const PointRequest& request) {
    const double width = info.nx * info.dx, depth = info.ny * info.dx;
    for (const auto& [x, y] : {request.from, request.to}) {
        if (x >= 0 && x <= width * ROUNDING && y >= 0 && y <= depth * ROUNDING) continue;
        char text[160];
        std::snprintf(text, sizeof text, ": (%.9g, %.9g) lies outside the grid, (0, 0) ... (%.9g, %.9g) m", x, y, width, depth);
        return {EXIT_BAD_INPUT, request.option + text};
    }
    const double along_x = request.to[0] - request.from[0], along_y = request.to[1] - request.from[1];
    const double length = std::hypot(along_x, along_y);
    const int parts = static_cast<int>(std::ceil(length / info.dx * (1 - 1e-9)));
    for (int n = 0; n <= parts; ++n) {
        const double share = parts > 0 ? static_cast<double>(n) / parts : 0;
        const double x = request.from[0] + share * along_x, y = request.from[1] + share * along_y;
        points_.push_back({number, x, y, share * length});
        xy_.push_back(within_rim(x, width));
        xy_.push_back(within_rim(y, depth));
    }
    return {};
}

Failure PointTable::unwritten() const { return {EXIT_BAD_INPUT, "cannot write " + path_.string()}; }

Failure PointTable::open() {
    file_.open(part_of(path_), std::ios::trunc);
    file_ << "time," << number_name_ << ",x,y,distance,surface,terrain,sand_depth,water_depth,saturation,velocity_x,velocity_y\n";
    return file_ ? Failure{} : unwritten();
}

Failure PointTable::sample(World& world, double time) {
    if (Failure failure = world.read_points(xy_, results_)) return failure;
    char line[320];
    for (std::size_t n = 0; n < points_.size(); ++n) {
        const TablePoint& at = points_[n];
        const wadi_query_result& r = results_[n];
        const auto value = [](float x) { return static_cast<double>(x); };
        std::snprintf(line, sizeof line, "%.9g,%u,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", time, at.number, at.x,
                      at.y, at.distance, value(r.surface), value(r.terrain), value(r.sand_depth), value(r.water_depth),
                      value(r.saturation), value(r.velocity[0]), value(r.velocity[1]));
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
