#include "engine/level/crests.hpp"
#include "engine/threads/bands.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <utility>

namespace wadi {
namespace {

constexpr double LOST_OF_CREST = 0.4;  // of a crest's height: at a ridge of even slopes a third is lost, at its corners 0.36
constexpr double OUT_OF_FLANKS = 0.5;  // of its height over the next cells: how far a crest stands above where flanks would meet
constexpr double ONE_SAMPLE = 0.4;     // of a crest one sample wide, half in each of two cells and some to spare
constexpr double TO_CREST = 1.5;       // cells from the middle of the next one to the crest
constexpr double CREST_OF_CELL = 0.03; // what is lost at least, of a cell's width
constexpr std::size_t BENDS = 65536;   // samples that are asked for the usual one
constexpr float NO_CREST = -std::numeric_limits<float>::infinity();

/// First sample of each of n cells along an axis of m samples, and their number behind the last.
std::vector<int> samples_of_cells(int m, int n, bool corners) {
    std::vector<int> first(static_cast<std::size_t>(n) + 1, m);
    for (int k = m - 1; k >= 0; --k) {
        const double place = corners ? static_cast<double>(k) * n / (m - 1) : (k + 0.5) * n / m;
        first[static_cast<std::size_t>(std::clamp(static_cast<int>(place), 0, n - 1))] = k;
    }
    return first;
}

/// Samples of two cells, a part of the map.
struct Patch {
    int x0, y0, x1, y1;
    int width() const { return x1 - x0; }
    int count() const { return (x1 - x0) * (y1 - y0); }
};

class Crests {
  public:
    Crests(const Map& map, double scale, double offset, const LevelGrid& grid, std::vector<float>& heights)
        : map_(map), scale_(scale), offset_(offset), grid_(grid), heights_(heights),
          columns_(samples_of_cells(map.nx, grid.nx, map.corners)), rows_(samples_of_cells(map.ny, grid.ny, map.corners)),
          single_(map.nx < 2 * grid.nx || map.ny < 2 * grid.ny) {}

    KeptCrests keep() {
        look_into_cells();
        least_ = std::max({usual_bend(), CREST_OF_CELL * grid_.dx, 4 * grid_.quantum});
        Ways ways{std::vector<float>(heights_.size(), NO_CREST), std::vector<float>(heights_.size(), NO_CREST)};
        look_between(ways, {});
        const std::vector<char> near = around_crests(ways);
        if (!near.empty()) look_between(ways, near);
        return raise(ways);
    }

  private:
    struct Searched {
        std::vector<char> seen;
        std::vector<int> open;
    };

    /// From each cell to the next one along x and along y.
    struct Ways {
        std::vector<float> x, y;
    };

    /// Finds the crests between neighbours: without `near` those that stand out, with it also what they go on as beside.
    void look_between(Ways& ways, const std::vector<char>& near) const {
        const auto width = static_cast<std::size_t>(grid_.nx), height = static_cast<std::size_t>(grid_.ny);
        in_bands(height, row_band(width), [&](std::size_t, std::size_t begin, std::size_t end) {
            Searched searched;
            const auto look = [&](std::size_t a, std::size_t step, std::size_t before, std::size_t behind, float& way) {
                if (near.empty())
                    way = standing_crest(a, step, least_of_crest(a, step, before, behind), searched);
                else if (way == NO_CREST && (near[a] != 0 || near[a + step] != 0))
                    way = over_crest(a, a + step, mean_of(a, a + step) + least_, searched);
            };
            for (std::size_t j = begin; j < end; ++j)
                for (std::size_t i = 0; i < width; ++i) {
                    const std::size_t c = j * width + i;
                    if (i + 1 < width) look(c, 1, i, width - i - 2, ways.x[c]);
                    if (j + 1 < height) look(c, width, j, height - j - 2, ways.y[c]);
                }
        });
    }

    /// Cells beside which crests were found, and those around them; empty if there are none.
    std::vector<char> around_crests(const Ways& ways) const {
        std::vector<char> near;
        const int nx = grid_.nx, ny = grid_.ny;
        for (std::size_t c = 0; c < heights_.size(); ++c) {
            if (ways.x[c] == NO_CREST && ways.y[c] == NO_CREST) continue;
            near.resize(heights_.size(), 0);
            const int i = static_cast<int>(c % static_cast<std::size_t>(nx)),
                      j = static_cast<int>(c / static_cast<std::size_t>(nx));
            for (int y = std::max(j - 1, 0); y <= std::min(j + 2, ny - 1); ++y)
                for (int x = std::max(i - 1, 0); x <= std::min(i + 2, nx - 1); ++x)
                    near[static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x)] = 1;
        }
        return near;
    }

    float sample(std::size_t n) const { return static_cast<float>(static_cast<double>(map_.values[n]) * scale_ + offset_); }

    void look_into_cells() {
        lowest_.resize(heights_.size());
        highest_.resize(heights_.size());
        const auto width = static_cast<std::size_t>(grid_.nx);
        in_bands(static_cast<std::size_t>(grid_.ny), row_band(width), [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t c = begin * width; c < end * width; ++c) {
                const Patch at = patch_of(c, c);
                float low = std::numeric_limits<float>::infinity(), high = NO_CREST;
                for (int y = at.y0; y < at.y1; ++y)
                    for (int x = at.x0; x < at.x1; ++x) {
                        const std::size_t n = index(x, y);
                        const float value = sample(n);
                        if (value < low) lowest_[c] = n;
                        low = std::min(low, value);
                        high = std::max(high, value);
                    }
                highest_[c] = high;
            }
        });
    }

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(map_.nx) + static_cast<std::size_t>(x);
    }

    /// Of two neighbouring cells, the one further west or south first, or of one cell twice.
    Patch patch_of(std::size_t a, std::size_t b) const {
        const auto width = static_cast<std::size_t>(grid_.nx);
        return {columns_[a % width], rows_[a / width], columns_[b % width + 1], rows_[b / width + 1]};
    }

    /// The median of what samples differ by from the mean of their neighbours, twice: what noise makes, slopes do not.
    double usual_bend() const {
        const auto width = static_cast<std::size_t>(map_.nx), count = map_.values.size();
        const std::size_t stride = std::max<std::size_t>(1, count / BENDS);
        std::vector<float> bends;
        const auto bend = [&](std::size_t n, std::size_t step) {
            bends.push_back(std::fabs(sample(n - step) - 2 * sample(n) + sample(n + step)));
        };
        for (std::size_t n = 0; n < count; n += stride) {
            if (n % width != 0 && (n + 1) % width != 0) bend(n, 1);
            if (n >= width && n + width < count) bend(n, width);
        }
        if (bends.empty()) return 0;
        const auto middle = bends.begin() + static_cast<std::ptrdiff_t>(bends.size() / 2);
        std::nth_element(bends.begin(), middle, bends.end());
        return static_cast<double>(*middle);
    }

    /// The ground beside two neighbouring cells on one side of them.
    struct Flank {
        double next = -std::numeric_limits<double>::infinity(); // of the cell beside them
        double reaches = next;                                  // where the crest is, if it goes on as steeply
    };

    /// Beside a cell, `on` elements further, where there are `cells` in that direction; `across`: elements to the next cell
    /// across it.
    Flank flank(std::size_t of, std::ptrdiff_t on, std::size_t cells, std::size_t across) const {
        if (cells < 1) return {};
        const auto height = [&](std::ptrdiff_t n) { return static_cast<double>(heights_[static_cast<std::size_t>(n)]); };
        const std::ptrdiff_t next = static_cast<std::ptrdiff_t>(of) + on, side = static_cast<std::ptrdiff_t>(across);
        const double here = height(next);
        if (cells < 2) return {here, here};
        // Askew to the crest a flank is steeper than along these cells; two cells away a wall is out of sight.
        const std::ptrdiff_t far = next + on;
        double rise = std::max(here - height(far), 0.0);
        if (far - side >= 0 && far + side < static_cast<std::ptrdiff_t>(heights_.size()))
            rise = std::max({rise, std::fabs(height(far + side) - height(far)), std::fabs(height(far) - height(far - side))});
        return {here, here + TO_CREST * rise};
    }

    /// Of the higher one of two cells.
    double mean_of(std::size_t a, std::size_t b) const { return static_cast<double>(std::max(heights_[a], heights_[b])); }

    /// How high a crest between cell a and the one `step` further on must be to stand out of the ground beside it. There are
    /// `before` cells ahead of a and `behind` after the other.
    struct Least {
        double crest = std::numeric_limits<double>::infinity();
        double next = 0; // the ground beside
    };
    Least least_of_crest(std::size_t a, std::size_t step, std::size_t before, std::size_t behind) const {
        const auto on = static_cast<std::ptrdiff_t>(step);
        const std::size_t across = step == 1 ? static_cast<std::size_t>(grid_.nx) : 1;
        const Flank low = flank(a, -on, before, across), high = flank(a + step, on, behind, across);
        const double next = std::max(low.next, high.next), reaches = std::max(low.reaches, high.reaches);
        if (std::isinf(next)) return {};
        const double here = std::max(mean_of(a, a + step), next);
        // Of what a crest stands above the ground, along or across these cells: a ridge that runs along them is low beside them.
        const double ground = std::min(next, beside(heights_[a] >= heights_[a + step] ? a : a + step, across));
        const double lost = (here - LOST_OF_CREST * ground) / (1 - LOST_OF_CREST);
        // Cells of one sample have it anywhere: on a slope it is off their mean by up to half of what the ground rises in a cell.
        const double off = single_ ? 0.5 * (reaches - next) : 0.0;
        return {std::max(here + least_ + off, std::min(lost, next + (reaches - next) / OUT_OF_FLANKS)), next};
    }

    /// The higher ground of a cell's two neighbours, `across` elements off; infinite at the grid's rim.
    double beside(std::size_t of, std::size_t across) const {
        if (of < across || of + across >= heights_.size()) return std::numeric_limits<double>::infinity();
        return mean_of(of - across, of + across);
    }

    /// over_crest(), but what lifts the cells' means by less than a crest of one sample would is none: on a slope no sample lies
    /// in the middle of its cell.
    float standing_crest(std::size_t a, std::size_t step, const Least& least, Searched& searched) const {
        const float way = over_crest(a, a + step, least.crest, searched);
        const double samples = step == 1 ? static_cast<double>(map_.nx) / grid_.nx : static_cast<double>(map_.ny) / grid_.ny;
        const double lift = ONE_SAMPLE / samples * (static_cast<double>(way) - least.next);
        return way > NO_CREST && mean_of(a, a + step) - least.next < lift ? NO_CREST : way;
    }

    /// The lowest way between the lowest samples of two cells where it rises above `least`, else NO_CREST.
    float over_crest(std::size_t a, std::size_t b, double least, Searched& searched) const {
        if (!(static_cast<double>(std::max(highest_[a], highest_[b])) > least)) return NO_CREST;
        const Patch patch = patch_of(a, b);
        if (joined_below(static_cast<float>(least), lowest_[a], lowest_[b], patch, searched)) return NO_CREST;
        return lowest_way(lowest_[a], lowest_[b], patch, searched);
    }

    /// Samples beside one, within a patch.
    template <class See> void each_beside(int at, const Patch& patch, const See& see) const {
        const int width = patch.width(), x = at % width;
        if (x > 0) see(at - 1);
        if (x + 1 < width) see(at + 1);
        if (at >= width) see(at - width);
        if (at + width < patch.count()) see(at + width);
    }

    float value_in(const Patch& patch, int at) const {
        return sample(index(patch.x0 + at % patch.width(), patch.y0 + at / patch.width()));
    }

    int place_in(const Patch& patch, std::size_t n) const {
        const auto width = static_cast<std::size_t>(map_.nx);
        return (static_cast<int>(n / width) - patch.y0) * patch.width() + static_cast<int>(n % width) - patch.x0;
    }

    bool joined_below(float limit, std::size_t from, std::size_t to, const Patch& patch, Searched& searched) const {
        const int goal = place_in(patch, to);
        searched.seen.assign(static_cast<std::size_t>(patch.count()), 0);
        searched.open.assign(1, place_in(patch, from));
        searched.seen[static_cast<std::size_t>(searched.open[0])] = 1;
        while (!searched.open.empty()) {
            const int at = searched.open.back();
            searched.open.pop_back();
            if (at == goal) return true;
            each_beside(at, patch, [&](int next) {
                char& seen = searched.seen[static_cast<std::size_t>(next)];
                if (seen == 0 && value_in(patch, next) <= limit) searched.open.push_back(next);
                seen = 1;
            });
        }
        return false;
    }

    /// The highest sample on the way whose highest sample is the lowest.
    float lowest_way(std::size_t from, std::size_t to, const Patch& patch, Searched& searched) const {
        const int goal = place_in(patch, to);
        searched.seen.assign(static_cast<std::size_t>(patch.count()), 0);
        std::priority_queue<std::pair<float, int>, std::vector<std::pair<float, int>>, std::greater<>> open;
        open.emplace(sample(from), place_in(patch, from));
        while (true) {
            const auto [highest, at] = open.top();
            if (at == goal) return highest;
            open.pop();
            if (std::exchange(searched.seen[static_cast<std::size_t>(at)], char{1}) != 0) continue;
            each_beside(at, patch, [&, so_far = highest](int next) {
                if (searched.seen[static_cast<std::size_t>(next)] == 0)
                    open.emplace(std::max(so_far, value_in(patch, next)), next);
            });
        }
    }

    /// Of two cells the higher one has more of the crest.
    KeptCrests raise(const Ways& ways) {
        const std::vector<float> before = heights_;
        const auto lift = [&](std::size_t a, std::size_t b, float to) {
            float& height = heights_[before[a] >= before[b] ? a : b];
            height = std::max(height, to);
        };
        for (std::size_t c = 0; c < before.size(); ++c) {
            if (ways.x[c] > NO_CREST) lift(c, c + 1, ways.x[c]);
            if (ways.y[c] > NO_CREST) lift(c, c + static_cast<std::size_t>(grid_.nx), ways.y[c]);
        }
        KeptCrests kept;
        for (std::size_t c = 0; c < before.size(); ++c) {
            const double by = static_cast<double>(heights_[c]) - static_cast<double>(before[c]);
            if (by > 0) ++kept.cells;
            if (by > kept.most) kept.where = c;
            kept.most = std::max(kept.most, by);
        }
        return kept;
    }

    const Map& map_;
    const double scale_, offset_;
    const LevelGrid& grid_;
    std::vector<float>& heights_;
    const std::vector<int> columns_, rows_; // first sample of each cell
    std::vector<std::size_t> lowest_;       // sample of each cell
    std::vector<float> highest_;            // in each cell [m]
    const bool single_;                     // cells may have one sample along an axis
    double least_ = 0;                      // that is lost where a crest is kept [m]
};

} // namespace

KeptCrests keep_crests(const Map& map, double scale, double offset, const LevelGrid& grid, std::vector<float>& heights) {
    const int across = map.corners ? 1 : 0;
    const int mx = map.nx - across, my = map.ny - across; // the map's own cells
    if (mx < grid.nx || my < grid.ny || (mx == grid.nx && my == grid.ny)) return {};
    return Crests(map, scale, offset, grid, heights).keep();
}

} // namespace wadi
