// mark_limits by its definition: counts of faces beside wet cells, at the clamp and with capped gravity, and whether the outflow
// of a cell's layers exceeds what they hold, columns above the largest height. Where a float may fall on either side of a limit,
// both answers pass. count_limits: its counts are those of the marks, its floats by their definitions in double precision.
// fold_limits: what it folds, word by word.
#include "shaders/physics/limit_marks.glsl"
#include "tests/conformance/stage_checks.hpp"
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace wadi::conformance {

namespace {

struct Marks {
    const StageRun& run;

    double at(const char* binding, int i, int j) const { return static_cast<double>(run.before(binding, i, j)); }
    bool has(std::uint32_t bits) const { return (run.scene.effects & bits) == bits; }

    // Count between `least` and `most`: value > limit for sure, or perhaps.
    struct Range {
        unsigned least = 0, most = 0;
        void add(double value, double limit) {
            least += value > limit * (1 + 1e-5) ? 1 : 0;
            most += value > limit * (1 - 1e-5) ? 1 : 0;
        }
        bool holds(unsigned n) const { return n >= least && n <= most; }
    };

    double height(char layer, int i, int j) const {
        const double water = has(EFFECT_WATER) ? at("water_height", i, j) : 0,
                     sand = has(EFFECT_SAND) ? at("sand_height", i, j) : 0;
        if (layer == 's') return sand;
        double mixed = has(EFFECT_MIXTURE) ? std::min(water, static_cast<double>(run.params.porosity) * sand) : 0;
        if (has(EFFECT_INFILTRATION) && at("water_in_pores", i, j) >= 0) mixed = std::min(mixed, at("water_in_pores", i, j));
        return layer == 'm' ? mixed : water - mixed;
    }
    static std::string velocity(char layer, char axis) {
        return std::string(layer == 's' ? "sand" : layer == 'm' ? "mixed" : "water") + "_velocity_" + axis;
    }
    double u(char layer, int i, int j) const { return at(velocity(layer, 'x').c_str(), i, j); }
    double v(char layer, int i, int j) const { return at(velocity(layer, 'y').c_str(), i, j); }

    // The two inner faces of (i, j): beside a cell deeper than the dry threshold.
    void wet(const char* name, int i, int j, Range& range) const {
        const WorldParams& p = run.params;
        const double own = at(name, i, j), dry = static_cast<double>(p.dry_threshold);
        if (i > 0 && i < p.nx && j < p.ny) range.add(std::max(own, at(name, i - 1, j)), dry);
        if (j > 0 && i < p.nx && j < p.ny) range.add(std::max(own, at(name, i, j - 1)), dry);
    }

    // The west and the south face: by the size of the velocity there, a hundredth of its square below the clamp's.
    void clamp(char layer, int i, int j, double limit, Range& range) const {
        const double v_west = (v(layer, i - 1, j) + v(layer, i - 1, j + 1) + v(layer, i, j) + v(layer, i, j + 1)) / 4,
                     u_south = (u(layer, i, j - 1) + u(layer, i + 1, j - 1) + u(layer, i, j) + u(layer, i + 1, j)) / 4;
        range.add(std::pow(u(layer, i, j), 2) + std::pow(v_west, 2), 0.99 * limit * limit);
        range.add(std::pow(v(layer, i, j), 2) + std::pow(u_south, 2), 0.99 * limit * limit);
    }

    void outflow(char layer, int i, int j, double k, Range& range) const {
        const double h = height(layer, i, j);
        const double out = std::max(-u(layer, i, j), 0.0) + std::max(u(layer, i + 1, j), 0.0) + std::max(-v(layer, i, j), 0.0) +
                           std::max(v(layer, i, j + 1), 0.0);
        if (h > 0) range.add(k * out * h, h);
    }

    // The two faces of cell (i, j): capped where the cap [m2/s2 per metre of depth] is below gravity.
    void gravity(int i, int j, bool sand, Range& range) const {
        const WorldParams& p = run.params;
        for (const bool y : {false, true}) {
            const bool inner = y ? j > 0 && j < p.ny && i < p.nx : i > 0 && i < p.nx && j < p.ny;
            if (!inner) continue;
            const auto deep = [&](int a, int b) { return sand ? at("sand_height", a, b) : standing_water<double>(run, a, b); };
            const double deepest = std::max(deep(i, j), y ? deep(i, j - 1) : deep(i - 1, j));
            double cap = static_cast<double>(p.sand_gravity_cap);
            if (!sand) {
                double speed = std::abs(y ? v('w', i, j) : u('w', i, j));
                if (has(EFFECT_MIXTURE)) speed = std::max(speed, std::abs(y ? v('m', i, j) : u('m', i, j)));
                const double room = std::max(static_cast<double>(LEAST_GRAVITY_CAP),
                                             static_cast<double>(p.gravity_cap_base) - static_cast<double>(p.k) * speed);
                cap = room * room * static_cast<double>(p.inv_k2);
            }
            range.add(static_cast<double>(p.gravity) * deepest, cap);
        }
    }
};

/// Of one layer.
struct LayerMarks {
    Marks::Range wet, clamped, capped, limited;
    bool holds(unsigned marks) const {
        return wet.holds(marks & 3u) && clamped.holds((marks >> 2 & 3u) + (marks >> 4 & 3u)) &&
               capped.holds((marks >> 6 & 1u) + (marks >> 7 & 1u)) && limited.holds(marks >> 8 & 1u);
    }
    std::string text() const {
        return std::to_string(wet.least) + " wet, " + std::to_string(clamped.least) + " clamped, " +
               std::to_string(capped.least) + " capped, " + std::to_string(limited.least) + " limited";
    }
};

} // namespace

Verdict check_marks(const StageRun& run) {
    const Marks marks{run};
    const WorldParams& p = run.params;
    const FieldLayout layout{p.nx, p.ny};
    for (int j = 0; j <= p.ny; ++j) {
        for (int i = 0; i <= p.nx; ++i) {
            const bool cell = i < p.nx && j < p.ny;
            LayerMarks water, sand;
            Marks::Range high;
            if (cell)
                high.add(marks.at("terrain", i, j) + marks.height('s', i, j) +
                             (marks.has(EFFECT_WATER) ? marks.at("water_height", i, j) : 0),
                         static_cast<double>(p.largest_height));
            if (marks.has(EFFECT_WATER)) {
                marks.wet("water_height", i, j, water.wet);
                marks.clamp('w', i, j, static_cast<double>(p.water_velocity_clamp), water.clamped);
                if (marks.has(EFFECT_MIXTURE)) marks.clamp('m', i, j, static_cast<double>(p.water_velocity_clamp), water.clamped);
                if (cell) marks.outflow('w', i, j, static_cast<double>(p.k), water.limited);
                if (cell && marks.has(EFFECT_MIXTURE)) marks.outflow('m', i, j, static_cast<double>(p.k), water.limited);
                water.limited.least = std::min(water.limited.least, 1u); // one mark for both layers of water
                water.limited.most = std::min(water.limited.most, 1u);
                marks.gravity(i, j, false, water.capped);
            }
            if (marks.has(EFFECT_SAND)) {
                marks.wet("sand_height", i, j, sand.wet);
                marks.clamp('s', i, j, static_cast<double>(p.sand_velocity_clamp), sand.clamped);
                if (cell) marks.outflow('s', i, j, static_cast<double>(p.ks), sand.limited);
                marks.gravity(i, j, true, sand.capped);
            }
            const std::uint32_t got = run.buffer("limit_marks").words()[layout.index(i, j)];
            if (water.holds(got & 511u) && sand.holds(got >> 16) && high.holds(got >> 9 & 127u)) continue;
            return failed("limit_marks(" + std::to_string(i) + ", " + std::to_string(j) + ") is " + std::to_string(got) +
                          "; expected of water " + water.text() + ", of sand " + sand.text() + "; " + std::to_string(high.least) +
                          " high");
        }
    }
    return {};
}

namespace {

/// What count_limits reads, and its definitions.
struct Limits {
    const StageRun& run;
    const WorldParams& p = run.params;

    double height(const char* name, int i, int j) const { return static_cast<double>(run.before(name, i, j)); }
    double surface(int i, int j) const {
        return height("terrain", i, j) + std::max(standing_water<double>(run, i, j), height("sand_height", i, j));
    }
    /// Friction of the bed against the fall of the surface: u^2 = g S h/(c + g n^2 h^(-1/3)), at most 1e8.
    double driven2(int i, int j, double depth) const {
        if ((run.scene.effects & EFFECT_BED_FRICTION) == 0) return 1e8;
        const double n = static_cast<double>(p.manning) + height("roughness", i, j);
        const double grip = static_cast<double>(p.bed_friction_dt) + static_cast<double>(p.gravity_dt) * n * n / std::cbrt(depth);
        const auto fall = [&](int a, int b) {
            const bool inside = a >= 0 && a < p.nx && b >= 0 && b < p.ny;
            return inside ? std::abs(surface(a, b) - surface(i, j)) : 0.0;
        };
        const double slope = std::hypot(std::max(fall(i - 1, j), fall(i + 1, j)), std::max(fall(i, j - 1), fall(i, j + 1))) /
                             static_cast<double>(p.dx);
        return grip > 0 ? std::min(static_cast<double>(p.gravity_dt) * slope * depth / grip, 1e8) : 1e8;
    }
};

} // namespace

Verdict check_limit_counts(const StageRun& run) {
    const Limits limits{run};
    const WorldParams& p = run.params;
    const FieldLayout layout{p.nx, p.ny};
    const auto& marks = run.buffer("limit_marks").before;
    const bool water = (run.scene.effects & EFFECT_WATER) != 0;
    const auto plane = static_cast<std::size_t>(layout.pitch()) * static_cast<std::size_t>(layout.strips());
    for (int n = 0; n < (p.nx + 1) * layout.strips(); ++n) {
        std::array<std::uint32_t, LIMIT_SUMS> counts{};
        double driven2 = 0, wave = 0, top = -1e30, bottom = 1e30, deep_sand = 0, highest = -1e30;
        const int i = n % (p.nx + 1), strip = n / (p.nx + 1);
        for (int j = strip * STRIP; j < std::min((strip + 1) * STRIP, p.ny + 1); ++j) {
            const auto marked = [&](int a, int b, std::size_t layer) { return marks[layout.index(a, b)] >> (16 * layer); };
            for (std::size_t layer = 0; layer < 2; ++layer) {
                const std::uint32_t of = marked(i, j, layer);
                const std::uint32_t found[] = {of & 3u, (of >> 2 & 3u) + (of >> 4 & 3u), (of >> 6 & 1u) + (of >> 7 & 1u),
                                               of >> 8 & 1u};
                for (std::size_t kind = 0; kind < 4; ++kind) counts[4 * layer + kind] += found[kind];
            }
            if (i == p.nx || j == p.ny) continue;
            // Any of the cell's four faces: bits of the west and south one at its own place.
            const auto beside = [&](std::size_t layer, std::uint32_t x, std::uint32_t y) {
                return ((marked(i, j, layer) & (x | y)) | (marked(i + 1, j, layer) & x) | (marked(i, j + 1, layer) & y)) != 0;
            };
            const double w = limits.height("water_height", i, j), s = limits.height("sand_height", i, j);
            if (beside(1, 64, 128)) deep_sand = std::max(deep_sand, s);
            if (water && beside(0, 64, 128)) {
                const auto size = [&](const char* name, int a, int b) { return std::abs(limits.height(name, a, b)); };
                const double speed = std::max({size("water_velocity_x", i, j), size("water_velocity_x", i + 1, j),
                                               size("water_velocity_y", i, j), size("water_velocity_y", i, j + 1)});
                wave = std::max(wave, speed + std::sqrt(static_cast<double>(p.gravity) * standing_water<double>(run, i, j)));
            }
            counts[8] += marked(i, j, 0) >> 9 & 1u;
            highest = std::max(highest, limits.height("terrain", i, j) + s + w);
            const double depth = std::max(standing_water<double>(run, i, j) - s, 0.0);
            if (!water || depth <= static_cast<double>(p.dry_threshold)) continue;
            top = std::max(top, limits.surface(i, j));
            if (!beside(0, 12, 48)) continue;
            bottom = std::min(bottom, limits.surface(i, j));
            driven2 = std::max(driven2, limits.driven2(i, j, depth));
        }
        const auto all = run.buffer("limit_columns").words();
        const std::string of_column = " of column " + std::to_string(i) + ", strip " + std::to_string(strip) + " is ";
        std::array<std::uint32_t, LIMIT_WORDS> got{};
        for (std::size_t word = 0; word < got.size(); ++word)
            got[word] = all[word * plane + static_cast<std::size_t>(strip * layout.pitch() + i)];
        for (std::size_t word = 0; word < counts.size(); ++word) {
            if (got[word] == counts[word]) continue;
            return failed("word " + std::to_string(word) + of_column + std::to_string(got[word]) + ", counted " +
                          std::to_string(counts[word]));
        }
        const double numbers[] = {driven2, wave, top, bottom, deep_sand, highest};
        for (std::size_t word = LIMIT_SUMS; word < got.size(); ++word) {
            const double value = static_cast<double>(std::bit_cast<float>(got[word])), wanted = numbers[word - LIMIT_SUMS];
            if (std::abs(value - wanted) <= 1e-4 * std::max(std::abs(wanted), 1e-3)) continue;
            return failed("word " + std::to_string(word) + of_column + std::to_string(value) + ", by its definition " +
                          std::to_string(wanted));
        }
    }
    return {};
}

Verdict check_limit_folds(const StageRun& run) {
    const FieldLayout layout{run.params.nx, run.params.ny};
    const auto& columns = run.buffer("limit_columns").before;
    const auto got = run.buffer("limit_counts").words();
    for (int tile = 0; tile < layout.tile_columns() * layout.strips(); ++tile) {
        const int first = tile % layout.tile_columns() * STRIP, strip = tile / layout.tile_columns();
        for (int word = 0; word < LIMIT_WORDS; ++word) {
            std::uint32_t sum = 0;
            float least = 1e30F, most = -1e30F;
            for (int i = first; i < std::min(first + STRIP, layout.nx + 1); ++i) {
                const std::uint32_t found =
                    columns[static_cast<std::size_t>((word * layout.strips() + strip) * layout.pitch() + i)];
                sum += found;
                least = std::min(least, std::bit_cast<float>(found));
                most = std::max(most, std::bit_cast<float>(found));
            }
            const std::uint32_t wanted =
                word < LIMIT_SUMS ? sum : std::bit_cast<std::uint32_t>(word == LIMIT_LEAST ? least : most);
            const std::uint32_t is = got[static_cast<std::size_t>(tile * LIMIT_WORDS + word)];
            if (is != wanted)
                return failed("word " + std::to_string(word) + " of tile " + std::to_string(tile) + " is " + std::to_string(is) +
                              ", not " + std::to_string(wanted));
        }
    }
    return {};
}

} // namespace wadi::conformance
