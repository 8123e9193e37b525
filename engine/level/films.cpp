#include "engine/level/films.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/messages.hpp"
#include <algorithm>
#include <cmath>

namespace wadi {
namespace {

double largest(const TimeSeries& series) {
    double most = 0;
    for (const auto& [time, value] : series.samples) most = std::max(most, value);
    return most;
}

/// Cells whose middles lie within `from` ... `to` along an axis.
int cells_within(double from, double to, double dx, int cells) {
    const double first = std::clamp(std::ceil(from / dx - 0.5), 0.0, double(cells));
    const double last = std::clamp(std::floor(to / dx - 0.5), -1.0, cells - 1.0);
    return std::max(static_cast<int>(last - first) + 1, 0);
}

/// Cells that a source covers: along x and y, and in all.
struct Covered {
    double along = 1, across = 1, cells = 1;
};

Covered covered(const Source& source, const Grid& grid) {
    const double dx = grid.dx;
    Covered c;
    if (source.shape == SourceShape::box) {
        c.along = cells_within(source.box[0], source.box[2], dx, grid.nx);
        c.across = cells_within(source.box[1], source.box[3], dx, grid.ny);
        c.cells = c.along * c.across;
    } else if (source.shape == SourceShape::disc) {
        c.along = c.across = std::max(2 * source.radius / dx, 1.0);
        c.cells = std::max(std::acos(-1.0) * source.radius * source.radius / (dx * dx), 1.0);
    }
    return c;
}

/// Depth [m] that a source adds to a cell in a step, times the cells that it covers the shorter way: what leaves downhill at
/// least.
double depth_below(const Source& source, const Settings& s) {
    const Covered over = covered(source, s.grid);
    const bool by_volume = !source.discharge.samples.empty();
    const double rate =
        by_volume && over.cells > 0 ? largest(source.discharge) / (over.cells * s.grid.dx * s.grid.dx) : largest(source.rate);
    return rate * s.dt * std::min(over.along, over.across);
}

} // namespace

void warn_films(const Settings& s, const FilmGround& ground, std::vector<std::string>& warnings) {
    const double quantum = height_quantum(s.method);
    if (!ground.mostly_dry) return;
    // Depth of a steady film down a slope by Manning's law: q^0.6. `moved`: depth that should pass a face in a step, where it is
    // most or as `where` says.
    const auto warn = [&](const std::string& path, double moved, const std::string& where) {
        if (!(moved > 0 && moved < quantum)) return;
        std::string text = path + ": brings " + number_text(moved) + " m through a face in a step" + where +
                           ", and less than a quantum of height, " + number_text(quantum) +
                           " m, does not move: on dry ground the water runs about " +
                           number_text(std::round(10 * std::pow(quantum / moved, 0.6)) / 10) +
                           " times too deep and late; use dt >= " + at_least(s.dt * quantum / moved) + " s";
        const double height = std::exp2(24 + std::floor(std::log2(moved)));
        if (s.method.quantum < 0 && height > ground.highest_column) text += " or method.largest_height <= " + number_text(height);
        warnings.push_back(text);
    };
    const Grid& grid = s.grid;
    warn("rain", largest(s.rain) * s.dt * std::max(grid.nx, grid.ny) / 2, " half the grid's length downhill");
    for (std::size_t n = 0; n < s.sides.size(); ++n) {
        const Side& side = s.sides[n];
        const bool along_y = n == static_cast<std::size_t>(SideName::west) || n == static_cast<std::size_t>(SideName::east);
        const int faces = cells_within(side.from, side.to, grid.dx, along_y ? grid.ny : grid.nx);
        if (side.kind == SideKind::discharge && faces > 0)
            warn("sides." + side_names()[n] + ".value", largest(side.value) / (faces * grid.dx) * s.dt / grid.dx, "");
    }
    for (std::size_t n = 0; n < s.sources.size(); ++n)
        if (s.sources[n].material == SourceMaterial::water)
            warn("sources[" + std::to_string(n) + "]", depth_below(s.sources[n], s), "");
}

void warn_discharges(const Settings& s, std::vector<std::string>& warnings) {
    for (std::size_t n = 0; n < s.sources.size(); ++n) {
        const double area = covered(s.sources[n], s.grid).cells * s.grid.dx * s.grid.dx;
        double most = 0; // drains as well
        for (const auto& [time, value] : s.sources[n].discharge.samples) most = std::max(most, std::fabs(value));
        if (area > 0 && most > RATE_MOST * area)
            warnings.push_back("sources[" + std::to_string(n) + "].discharge: " + number_text(most) + " m3/s on " +
                               number_text(area) + " m2 is more than " + number_text(RATE_MOST) +
                               " m/s of depth, and what is beyond does not flow; use at most " + at_most(RATE_MOST * area) +
                               " m3/s, or a larger shape");
    }
}

} // namespace wadi
