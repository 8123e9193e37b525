#include "engine/level/source_rates.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/messages.hpp"
#include <algorithm>
#include <cmath>

namespace wadi {
namespace {

/// Cells whose middles lie within `from` ... `to` along an axis.
int cells_within(double from, double to, double dx, int cells) {
    const double first = std::clamp(std::ceil(from / dx - 0.5), 0.0, double(cells));
    const double last = std::clamp(std::floor(to / dx - 0.5), -1.0, cells - 1.0);
    return std::max(static_cast<int>(last - first) + 1, 0);
}

double covered_cells(const Source& source, const Grid& grid) {
    const double dx = grid.dx;
    if (source.shape == SourceShape::box)
        return static_cast<double>(cells_within(source.box[0], source.box[2], dx, grid.nx)) *
               cells_within(source.box[1], source.box[3], dx, grid.ny);
    if (source.shape == SourceShape::disc) return std::max(std::acos(-1.0) * source.radius * source.radius / (dx * dx), 1.0);
    return 1;
}

} // namespace

void warn_discharges(const Settings& s, std::vector<std::string>& warnings) {
    for (std::size_t n = 0; n < s.sources.size(); ++n) {
        const double area = covered_cells(s.sources[n], s.grid) * s.grid.dx * s.grid.dx;
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
