#include "engine/level/corner_streams.hpp"
#include "engine/settings/rules/messages.hpp"
#include "engine/threads/bands.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

namespace wadi {
namespace {

constexpr double BANK_LEAST = 0.25; // of a cell's width
constexpr int WAY_ROUND = 2;        // cells around a corner in which a way round it is looked for

struct Cell {
    int i, j;
};

/// Corners of a part of the grid.
struct Found {
    std::size_t count = 0;
    double bank = 0; // the highest [m]
    Cell at{};       // there, the cell north and east of the corner
};

class Ground {
  public:
    Ground(const Settings& settings, const InitialFields& fields)
        : nx_(settings.grid.nx), ny_(settings.grid.ny), least_(BANK_LEAST * settings.grid.dx), fields_(fields) {}

    Found find() const {
        const auto rows = static_cast<std::size_t>(ny_ - 1), band = row_band(static_cast<std::size_t>(nx_));
        std::vector<Found> parts(bands_of(rows, band));
        in_bands(rows, band, [&](std::size_t n, std::size_t begin, std::size_t end) {
            for (std::size_t j = begin; j < end; ++j)
                for (int i = 0; i + 1 < nx_; ++i) look(i, static_cast<int>(j), parts[n]);
        });
        Found all;
        for (const Found& part : parts) {
            all.count += part.count;
            if (part.bank > all.bank) std::tie(all.bank, all.at) = std::pair(part.bank, part.at);
        }
        return all;
    }

  private:
    double height(int i, int j) const {
        const std::size_t c = static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(i);
        return static_cast<double>(fields_.terrain[c]) + (fields_.sand.empty() ? 0 : static_cast<double>(fields_.sand[c]));
    }
    bool is_low(Cell at, double limit) const {
        return at.i >= 0 && at.j >= 0 && at.i < nx_ && at.j < ny_ && height(at.i, at.j) < limit;
    }

    /// Both diagonals of four cells.
    void look(int i, int j, Found& found) const {
        const double south_west = height(i, j), south_east = height(i + 1, j), north_west = height(i, j + 1),
                     north_east = height(i + 1, j + 1);
        const auto diagonal = [&](Cell a, Cell b, double top, double bank) {
            if (bank < least_ || !is_stream(a, b, top + least_)) return;
            ++found.count;
            if (bank > found.bank) std::tie(found.bank, found.at) = std::pair(bank, Cell{i + 1, j + 1});
        };
        const double rising = std::max(south_west, north_east), falling = std::max(south_east, north_west);
        diagonal({i, j}, {i + 1, j + 1}, rising, std::min(south_east, north_west) - rising);
        diagonal({i + 1, j}, {i, j + 1}, falling, std::min(south_west, north_east) - falling);
    }

    /// Whether what is lower than a limit is a line that goes on from both cells, one cell wide, and leads no other way from one
    /// to the other.
    bool is_stream(Cell a, Cell b, double limit) const {
        return is_thin(a, limit) && is_thin(b, limit) && goes_on(a, b, limit) && goes_on(b, a, limit) &&
               !leads_round(a, b, limit);
    }

    /// No four cells around a corner of this one are low.
    bool is_thin(Cell at, double limit) const {
        for (const int x : {-1, 1})
            for (const int y : {-1, 1})
                if (is_low({at.i + x, at.j}, limit) && is_low({at.i, at.j + y}, limit) && is_low({at.i + x, at.j + y}, limit))
                    return false;
        return true;
    }

    /// To another low cell, or out of the grid.
    bool goes_on(Cell at, Cell from, double limit) const {
        if (at.i == 0 || at.j == 0 || at.i + 1 == nx_ || at.j + 1 == ny_) return true;
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const Cell next{at.i + x, at.j + y};
                const bool new_one = (x != 0 || y != 0) && (next.i != from.i || next.j != from.j);
                if (new_one && is_low(next, limit)) return true;
            }
        return false;
    }

    bool leads_round(Cell a, Cell b, double limit) const {
        const int west = std::min(a.i, b.i) - WAY_ROUND, south = std::min(a.j, b.j) - WAY_ROUND, cells = 2 + 2 * WAY_ROUND;
        std::array<bool, (2 + 2 * WAY_ROUND) * (2 + 2 * WAY_ROUND)> seen{};
        std::vector<Cell> open{a};
        while (!open.empty()) {
            const Cell at = open.back();
            open.pop_back();
            if (at.i == b.i && at.j == b.j) return true;
            for (const auto& [x, y] : {std::pair(-1, 0), std::pair(1, 0), std::pair(0, -1), std::pair(0, 1)}) {
                const Cell next{at.i + x, at.j + y};
                const int column = next.i - west, row = next.j - south;
                if (column < 0 || row < 0 || column >= cells || row >= cells || !is_low(next, limit)) continue;
                bool& met = seen[static_cast<std::size_t>(row * cells + column)];
                if (!met) open.push_back(next);
                met = true;
            }
        }
        return false;
    }

    int nx_, ny_;
    double least_;
    const InitialFields& fields_;
};

bool water_comes(const Settings& s, const InitialFields& fields) {
    const bool poured = std::any_of(s.sources.begin(), s.sources.end(),
                                    [](const Source& source) { return source.material == SourceMaterial::water; });
    const bool enters = std::any_of(s.sides.begin(), s.sides.end(), [](const Side& side) { return !side.value.samples.empty(); });
    const bool there = std::any_of(fields.water.begin(), fields.water.end(), [](float depth) { return depth > 0; });
    return poured || enters || there || !s.rain.samples.empty();
}

} // namespace

void warn_corner_streams(const Settings& s, const InitialFields& fields, std::vector<std::string>& warnings) {
    if (fields.terrain.empty() || !water_comes(s, fields)) return;
    const Found found = Ground(s, fields).find();
    if (found.count == 0) return;
    const auto at = [&](int cells) { return number_text(cells * s.grid.dx); };
    warnings.push_back("a ditch one cell wide (" + number_text(s.grid.dx) + " m) goes over a corner between cells at " +
                       std::to_string(found.count) + " place" + (found.count > 1 ? "s" : "") +
                       ", where water stands up to the bank, most at (" + at(found.at.i) + ", " + at(found.at.j) + ") with " +
                       number_text(std::round(found.bank * 1000) / 1000) +
                       " m; make it two cells wide, lead it over sides of cells, or use a smaller dx");
}

} // namespace wadi
