#include "engine/level/stream_speeds.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/messages.hpp"
#include <algorithm>
#include <cmath>
#include <numbers>

namespace wadi {
namespace {

double largest(const TimeSeries& series) {
    double most = 0;
    for (const auto& sample : series.samples) most = std::max(most, sample.second);
    return most;
}

/// Water that enters: per width of its shape, seen where it is widest [m2/s].
struct Stream {
    std::string name;
    double x, y, per_width;
};

Stream stream_of(const Source& source, const Grid& grid, std::size_t n) {
    Stream stream{"sources[" + std::to_string(n) + "]", source.center[0], source.center[1], 0};
    double width = grid.dx, area = grid.dx * grid.dx;
    if (source.shape == SourceShape::disc) {
        width = std::max(2 * source.radius, grid.dx);
        area = std::max(std::numbers::pi * source.radius * source.radius, area);
    } else if (source.shape == SourceShape::box) {
        const double x = source.box[2] - source.box[0], y = source.box[3] - source.box[1];
        stream.x = 0.5 * (source.box[0] + source.box[2]);
        stream.y = 0.5 * (source.box[1] + source.box[3]);
        width = std::max(x, y);
        area = x * y;
    }
    stream.per_width = std::max(largest(source.discharge), largest(source.rate) * area) / width;
    return stream;
}

Stream stream_of(const Side& side, const Grid& grid, std::size_t n) {
    const bool along_y = n == static_cast<std::size_t>(SideName::west) || n == static_cast<std::size_t>(SideName::east);
    const bool high = n == static_cast<std::size_t>(SideName::east) || n == static_cast<std::size_t>(SideName::north);
    const double length = grid.dx * (along_y ? grid.ny : grid.nx), across = high ? grid.dx * (along_y ? grid.nx : grid.ny) : 0;
    const double from = std::max(side.from, 0.0), to = std::min(side.to, length), middle = 0.5 * (from + to);
    return {"sides." + side_names()[n], along_y ? across : middle, along_y ? middle : across,
            largest(side.value) / std::max(to - from, grid.dx)};
}

/// Where a stream of q [m2/s] runs evenly down a slope: g S q/u = (c + g n^2 h^(-1/3)) u^2, h = q/u.
double even_speed(const Settings& s, double q, double slope) {
    const auto driven = [&](double u) {
        const double depth = q / u, n = s.material.manning;
        return s.gravity * slope * depth > (s.material.bed_friction + s.gravity * n * n / std::cbrt(depth)) * u * u;
    };
    double low = 1e-6, high = 1e4;
    for (int n = 0; n < 60; ++n) (driven(std::sqrt(low * high)) ? low : high) = std::sqrt(low * high);
    return low;
}

/// The speed that a stream comes to, and the mean slope that gives it.
struct Run {
    double speed = 0, slope = 0;
};

/// On the way to lower ground a quarter of the grid away or more: shorter falls give it no time. Of the ground that it falls to
/// nearly as steeply in the mean as to any, the lowest: no water is faster than what has fallen so far.
Run run_of(const Settings& s, const std::vector<float>& terrain, const Stream& stream) {
    const Grid& grid = s.grid;
    const auto place = [&](double at, int cells) { return std::clamp(static_cast<int>(at / grid.dx), 0, cells - 1); };
    const auto height = [&](int i, int j) {
        return static_cast<double>(
            terrain[static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.nx) + static_cast<std::size_t>(i)]);
    };
    const int i0 = place(stream.x, grid.nx), j0 = place(stream.y, grid.ny);
    const double least = 0.25 * std::max(grid.nx, grid.ny), from = height(i0, j0);
    const auto each = [&](const auto& see) { // squares spare a root for each cell
        for (int j = 0; j < grid.ny; ++j)
            for (int i = 0; i < grid.nx; ++i) {
                const double down = from - height(i, j), x = i - i0, y = j - j0, cells2 = x * x + y * y;
                if (down > 0 && cells2 >= least * least) see(down, down * down / (cells2 * grid.dx * grid.dx));
            }
    };
    double steepest2 = 0, fall = 0, slope2 = 0;
    each([&](double, double of2) { steepest2 = std::max(steepest2, of2); });
    each([&](double down, double of2) {
        if (of2 < 0.7 * steepest2 || down < fall || (down == fall && of2 <= slope2)) return;
        fall = down;
        slope2 = of2;
    });
    if (fall <= 0) return {};
    const double slope = std::sqrt(slope2);
    return {std::min(even_speed(s, stream.per_width, slope), std::sqrt(2 * s.gravity * fall)), slope};
}

} // namespace

void warn_streams(const Settings& s, const InitialFields& fields, std::vector<std::string>& warnings) {
    if (fields.terrain.empty()) return;
    std::vector<Stream> streams;
    for (std::size_t n = 0; n < s.sources.size(); ++n)
        if (s.sources[n].material == SourceMaterial::water) streams.push_back(stream_of(s.sources[n], s.grid, n));
    for (std::size_t n = 0; n < s.sides.size(); ++n)
        if (s.sides[n].kind == SideKind::discharge) streams.push_back(stream_of(s.sides[n], s.grid, n));
    const double clamp = s.method.velocity_clamp * s.grid.dx / s.water_dt();
    for (const Stream& stream : streams) {
        if (stream.per_width <= 0) continue;
        const Run run = run_of(s, fields.terrain, stream);
        if (run.speed <= clamp) continue;
        const auto rounded = [](double value, double parts) { return number_text(std::round(value * parts) / parts); };
        warnings.push_back(stream.name + ": " + rounded(stream.per_width, 1000) + " m2/s that run down a slope of " +
                           rounded(run.slope, 1000) + " come to some " + rounded(run.speed, 100) +
                           " m/s but will be held at velocity_clamp dx/dt = " + rounded(clamp, 100) + " m/s; use " +
                           longest_dt(s, s.method.velocity_clamp * s.grid.dx / run.speed) +
                           or_water_substeps(s, s.method.velocity_clamp * s.grid.dx / run.speed) +
                           ", or more bed_friction or manning");
    }
}

} // namespace wadi
