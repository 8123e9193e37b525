// Holes of maps: where a survey ends, water that nobody measured, buildings that were cut out.
#include "engine/image/map.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace wadi {
namespace {

/// Calls visit(neighbour) for those beside a cell.
template <class Visit> void beside(const Map& map, std::size_t cell, const Visit& visit) {
    const auto nx = static_cast<std::size_t>(map.nx);
    if (cell % nx > 0) visit(cell - 1);
    if (cell % nx + 1 < nx) visit(cell + 1);
    if (cell >= nx) visit(cell - nx);
    if (cell + nx < map.values.size()) visit(cell + nx);
}

/// Those of the holes that others join to the map's rim.
std::vector<bool> joined_to_rim(const Map& map) {
    const auto nx = static_cast<std::size_t>(map.nx);
    std::vector<bool> joined(map.holes.size());
    std::vector<std::size_t> front;
    const auto reach = [&](std::size_t cell) {
        if (!map.holes[cell] || joined[cell]) return;
        joined[cell] = true;
        front.push_back(cell);
    };
    for (std::size_t i = 0; i < nx; ++i) reach(i), reach(map.holes.size() - nx + i);
    for (std::size_t cell = 0; cell < map.holes.size(); cell += nx) reach(cell), reach(cell + nx - 1);
    while (!front.empty()) {
        const std::size_t cell = front.back();
        front.pop_back();
        beside(map, cell, reach);
    }
    return joined;
}

/// Steps over sides from each of `holes` to the nearest cell that is none of them; beyond a map's longest side they count no
/// further.
std::vector<std::uint16_t> steps_from_ground(const Map& map, const std::vector<bool>& holes) {
    constexpr std::uint16_t unknown = 65535, most = MAP_LIMIT;
    std::vector<std::uint16_t> steps(holes.size());
    std::vector<std::size_t> front, next;
    for (std::size_t cell = 0; cell < holes.size(); ++cell)
        if (holes[cell]) steps[cell] = unknown;
    for (std::size_t cell = 0; cell < holes.size(); ++cell)
        if (holes[cell])
            beside(map, cell, [&](std::size_t other) {
                if (!holes[other]) front.push_back(other);
            });
    for (std::uint16_t step = 1; !front.empty(); step = std::min<std::uint16_t>(step + 1, most), front.swap(next)) {
        next.clear();
        for (const std::size_t cell : front)
            beside(map, cell, [&](std::size_t other) {
                if (steps[other] != unknown) return;
                steps[other] = step;
                next.push_back(other);
            });
    }
    return steps;
}

/// Evens out what the nearest heights leave of stripes.
void smooth(Map& map, const std::vector<bool>& holes) {
    const auto nx = static_cast<std::size_t>(map.nx);
    std::vector<std::size_t> cells;
    for (std::size_t cell = 0; cell < holes.size(); ++cell)
        if (holes[cell]) cells.push_back(cell);
    // For looks alone: large maps get fewer, so that none takes long.
    const std::size_t passes = cells.empty() ? 0 : std::clamp<std::size_t>(100'000'000 / cells.size(), 2, 64);
    std::vector<float> means(cells.size());
    for (std::size_t pass = 0; pass < passes; ++pass) {
        for (std::size_t n = 0; n < cells.size(); ++n) {
            const std::size_t cell = cells[n];
            const auto value = [&](bool inside, std::size_t other) { return map.values[inside ? other : cell]; };
            means[n] = 0.25f * ((value(cell % nx > 0, cell - 1) + value(cell % nx + 1 < nx, cell + 1)) +
                                (value(cell >= nx, cell - nx) + value(cell + nx < holes.size(), cell + nx)));
        }
        for (std::size_t n = 0; n < cells.size(); ++n) map.values[cells[n]] = means[n];
    }
}

/// Ground beside the map that falls away from it, so that what flows there goes on to the rim.
void slope_away(Map& map, const std::vector<bool>& holes, float drop, double cell) {
    constexpr double slope = 0.02;
    const std::vector<std::uint16_t> steps = steps_from_ground(map, holes);
    smooth(map, holes);
    for (std::size_t n = 0; n < map.values.size(); ++n)
        if (holes[n]) map.values[n] -= drop + static_cast<float>(slope * cell * steps[n]);
}

} // namespace

void raise_holes(Map& map, Holes how, double cell) {
    if (map.holes.empty() || how == Holes::filled) return;
    const auto [low, high] = std::minmax_element(map.values.begin(), map.values.end()); // filled: of the known ones
    const float least = *low, most = *high;
    // Enough for a stream to fall over the edge, without a cliff that is more than the ground around it.
    const float drop = std::max((most - least) / 20, static_cast<float>(cell));
    if (how == Holes::outside) {
        const std::vector<bool> joined = joined_to_rim(map);
        map.filled -= std::count(joined.begin(), joined.end(), true);
        return slope_away(map, joined, drop, cell);
    }
    map.filled = 0;
    for (std::size_t n = 0; n < map.values.size(); ++n)
        if (map.holes[n]) map.values[n] = how == Holes::wall ? most : least - drop;
}

} // namespace wadi
