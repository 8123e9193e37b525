#include "engine/level/lakes.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace wadi {
namespace {

constexpr double FLATTER = 0.5;       // of the bed's rise: what the surface of a lake may rise from sample to sample
constexpr double STILL = 1e-4;        // and this besides: what rounding and ripples are [m]
constexpr double SAME_SURFACE = 1e-3; // of pore water and the lake beside it [m]

/// One sample's column.
struct LakeColumn {
    double ground = 0; // top of the terrain or sand
    double water = 0;
    double surface = 0; // H + W, of the water in pores, too
    bool pure = false;
};

class Lakes {
  public:
    Lakes(const ColumnFields& fields, int mx, int my) : fields_(fields), mx_(mx), my_(my) {
        const std::size_t count = fields.water.size();
        lake_.resize(count);
        for (std::size_t n = 0; n < count; ++n) lake_[n] = is_flat(n) ? 1 : 0;
        for (std::size_t n = 0; n < count; ++n)
            if (lake_[n] != 0) joined_.push_back(n);
        while (!joined_.empty()) join_beside();
        deepest_ = static_cast<std::size_t>(std::max_element(fields.water.begin(), fields.water.end()) - fields.water.begin());
    }

    bool lake(std::size_t n) const { return lake_[n] != 0; }
    /// Of the deepest water: surfaces are carried over as differences from it, which keep their digits.
    double reference() const { return at(deepest_).surface; }

    LakeColumn at(std::size_t n) const {
        const auto part = [n](const std::vector<float>& field) { return field.empty() ? 0 : static_cast<double>(field[n]); };
        const double terrain = part(fields_.terrain), sand = part(fields_.sand), water = part(fields_.water);
        return {terrain + sand, water, terrain + water, water > sand};
    }

    /// Whether this sample lies open to a lake beside it that stands higher.
    bool front(std::size_t n) const {
        const LakeColumn here = at(n);
        const double top = std::max(here.ground, here.surface) + STILL;
        const auto beside = neighbours(n);
        return !lake(n) && std::any_of(beside.begin(), beside.end(),
                                       [&](std::size_t m) { return lake(m) && at(m).pure && at(m).surface > top; });
    }

  private:
    /// West, east, south, north; the sample itself beyond the rim.
    std::array<std::size_t, 4> neighbours(std::size_t n) const {
        const auto width = static_cast<std::size_t>(mx_);
        const std::size_t i = n % width, j = n / width;
        return {i > 0 ? n - 1 : n, i + 1 < width ? n + 1 : n, j > 0 ? n - width : n,
                j + 1 < static_cast<std::size_t>(my_) ? n + width : n};
    }

    bool is_flat(std::size_t n) const {
        const LakeColumn here = at(n);
        if (!here.pure) return false;
        const auto beside = neighbours(n);
        return std::all_of(beside.begin(), beside.end(), [&](std::size_t m) {
            const LakeColumn there = at(m);
            return !there.pure ||
                   std::fabs(there.surface - here.surface) <= FLATTER * std::fabs(there.ground - here.ground) + STILL;
        });
    }

    /// The water beside the last joined sample joins where it stands as high.
    void join_beside() {
        const std::size_t n = joined_.back();
        joined_.pop_back();
        for (const std::size_t m : neighbours(n)) {
            const LakeColumn there = at(m);
            if (lake(m) || !(there.water > 0) || std::fabs(there.surface - at(n).surface) > SAME_SURFACE) continue;
            lake_[m] = 1;
            joined_.push_back(m);
        }
    }

    const ColumnFields fields_;
    const int mx_, my_;
    std::vector<char> lake_;
    std::vector<std::size_t> joined_; // whose neighbours are still to be looked at
    std::size_t deepest_ = 0;
};

} // namespace

void level_lakes(const ColumnFields& samples, int mx, int my, const ColumnFields& cells, int nx, int ny) {
    const Lakes lakes(samples, mx, my);
    const double reference = lakes.reference();
    const auto carried = [&](const auto& value) {
        Map map;
        map.nx = mx;
        map.ny = my;
        for (std::size_t n = 0; n < samples.water.size(); ++n) map.values.push_back(static_cast<float>(value(n)));
        return resample(map, nx, ny);
    };
    const auto share = carried([&](std::size_t n) { return lakes.lake(n) ? 1.0 : 0.0; });
    const auto rise = carried([&](std::size_t n) { return lakes.lake(n) ? lakes.at(n).surface - reference : 0.0; });
    const auto others = carried([&](std::size_t n) { return lakes.lake(n) ? 0.0 : lakes.at(n).water; });
    const auto open = carried([&](std::size_t n) { return lakes.front(n) ? 1.0 : 0.0; });
    for (std::size_t cell = 0; cell < cells.water.size(); ++cell) {
        const double lake = static_cast<double>(share[cell]);
        if (!(lake > 0) || open[cell] > 0) continue;
        const auto part = [cell](const std::vector<float>& field) {
            return field.empty() ? 0 : static_cast<double>(field[cell]);
        };
        const double depth = reference + static_cast<double>(rise[cell]) / lake - part(cells.terrain);
        const bool damp = others[cell] > 0 && depth <= part(cells.sand); // and stands out of the lake
        cells.water[cell] = static_cast<float>(damp ? static_cast<double>(others[cell]) / (1 - lake) : std::max(depth, 0.0));
    }
}

} // namespace wadi
