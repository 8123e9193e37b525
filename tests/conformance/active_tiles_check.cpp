#include "tests/conformance/active_tiles_check.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

namespace wadi::conformance {

namespace {

constexpr int step = 100;

// Stamps of the step before the last but one, which is too old, among some that are just young enough.
std::uint32_t stamp(std::size_t tile) { return tile % 13 == 5 ? step - 2 : tile % 7 == 3 ? step - 3 : 4; }
std::uint32_t flag(std::size_t tile) { return tile * 5 % 3 == 0 ? 1 : 0; }
// Of what there is for water and for sand, the sand's: other tiles.
std::size_t shifted(const compute::StageBinding& binding, std::size_t tile) {
    const bool sand = binding.name.ends_with("_sand") || binding.name.starts_with("active_sand");
    return sand ? tile + 4 : tile;
}
// Steps in which tiles were looked into, and in which something was seen there.
constexpr std::uint32_t looked = 90;
std::uint32_t seen(std::size_t tile) { return tile % 5 == 2 ? looked : looked - 1; }

struct TileGrid {
    std::size_t columns, rows;
    explicit TileGrid(const WorldParams& p)
        : columns(static_cast<std::size_t>(p.tile_columns)), rows(static_cast<std::size_t>(p.tile_rows)) {}
    std::uint32_t flags_of(std::size_t row) const {
        std::uint32_t count = 0;
        for (std::size_t column = 0; column < columns; ++column) count += flag(row * columns + column);
        return count;
    }
};

// Tile (i, j) within `rings` of a woken rectangle.
bool woken(const StepInput& input, int i, int j, int rings) {
    for (int n = 0; n < input.wake_count; ++n) {
        const vec4& w = input.wake[n];
        const auto near = [&](int at, float low, float high) {
            return at + rings >= static_cast<int>(low) && at - rings <= static_cast<int>(high);
        };
        if (near(i, w.x, w.z) && near(j, w.y, w.w)) return true;
    }
    return false;
}

Verdict wrong(const char* what, std::size_t at) {
    return failed(std::string(what) + "[" + std::to_string(at) + "] is not what it should be");
}

Verdict check_mark(const StageRun& run) {
    const auto& p = run.params;
    for (int j = 0; j < p.tile_rows; ++j) {
        for (int i = 0; i < p.tile_columns; ++i) {
            bool wanted = woken(run.pilot.input, i, j, p.tile_rings);
            for (int b = 0; b < p.tile_rows; ++b)
                for (int a = 0; a < p.tile_columns; ++a)
                    wanted |= std::max(std::abs(a - i), std::abs(b - j)) <= p.tile_rings &&
                              stamp(static_cast<std::size_t>(b * p.tile_columns + a)) + 2 >= step;
            const auto at = static_cast<std::size_t>(j * p.tile_columns + i);
            if (run.buffer("active_tiles").words()[at] != (wanted ? 1U : 0U)) return wrong("active_tiles", at);
        }
    }
    return {};
}

Verdict check_choose(const StageRun& run) {
    const auto& p = run.params;
    for (int j = 0; j < p.tile_rows; ++j) {
        for (int i = 0; i < p.tile_columns; ++i) {
            const bool woke = woken(run.pilot.input, i, j, p.tile_rings);
            bool water = woke, sand = woke, holds_water = false, holds_sand = false;
            for (int b = 0; b < p.tile_rows; ++b) {
                for (int a = 0; a < p.tile_columns; ++a) {
                    if (std::max(std::abs(a - i), std::abs(b - j)) > p.tile_rings) continue;
                    const auto at = static_cast<std::size_t>(b * p.tile_columns + a);
                    water |= stamp(at) + 2 >= step;
                    sand |= stamp(at + 4) + 2 >= step;
                    holds_water |= seen(at) == looked;
                    holds_sand |= seen(at + 4) == looked;
                }
            }
            const auto at = static_cast<std::size_t>(j * p.tile_columns + i);
            if (run.buffer("active_tiles_water").words()[at] != (water || (sand && holds_water) ? 1U : 0U))
                return wrong("active_tiles_water", at);
            if (run.buffer("active_tiles_sand").words()[at] != (sand || (water && holds_sand) ? 1U : 0U))
                return wrong("active_tiles_sand", at);
            const bool both = (water || (sand && holds_water)) && (sand || (water && holds_sand));
            if ((run.scene.effects & EFFECT_MIXTURE) != 0 && run.buffer("active_tiles_mixture").words()[at] != (both ? 1U : 0U))
                return wrong("active_tiles_mixture", at);
        }
    }
    return {};
}

// Whether a tile, with the ghosts beside it, holds anything of a material.
bool holds(const StageRun& run, const char* height, int column, int row) {
    const auto& p = run.params;
    for (int j = row > 0 ? row * 8 : -1; j < (row + 1) * 8 && j <= p.ny; ++j)
        for (int i = column > 0 ? column * 8 : -1; i <= p.nx && (i < (column + 1) * 8 || (i == p.nx && i == (column + 1) * 8));
             ++i)
            if (run.before(height, i, j) != 0) return true;
    return false;
}

Verdict check_look(const StageRun& run) {
    const TileGrid grid(run.params);
    for (std::size_t at = 0; at < grid.columns * grid.rows; ++at) {
        const int column = static_cast<int>(at % grid.columns), row = static_cast<int>(at / grid.columns);
        const bool looks = flag(at) + flag(at + 4) != 0;
        const bool water = looks && holds(run, "water_height", column, row),
                   sand = looks && holds(run, "sand_height", column, row);
        if (run.buffer("active_looked").words()[at] != (looks ? step : looked)) return wrong("active_looked", at);
        if (run.buffer("active_water_seen").words()[at] != (water ? step : seen(at))) return wrong("active_water_seen", at);
        if (run.buffer("active_sand_seen").words()[at] != (sand ? step : seen(at + 4))) return wrong("active_sand_seen", at);
    }
    return {};
}

// Whether water passes the face below a cell, by its velocities or by diffusion, or would if a quantum were less.
bool passes(const StageRun& run, int i, int j, bool is_y) {
    const int low_i = is_y ? i : i - 1, low_j = is_y ? j - 1 : j;
    const std::string axis = is_y ? "_y" : "_x";
    const float water = run.before("water_height", i, j), below = run.before("water_height", low_i, low_j);
    if (!(std::max(water, below) > 0)) return false;
    if (run.before(("water_velocity" + axis).c_str(), i, j) != 0 || run.before(("mixed_velocity" + axis).c_str(), i, j) != 0)
        return true;
    if ((run.scene.effects & EFFECT_DIFFUSION) == 0) return false;
    const float sand = run.before("sand_height", i, j), sand_below = run.before("sand_height", low_i, low_j);
    const float fall = (run.before("terrain", i, j) + water) - (run.before("terrain", low_i, low_j) + below);
    const float rise = std::min(water, sand) - std::min(below, sand_below);
    const float dry = run.params.dry_threshold;
    if (!(sand > dry && sand_below > dry && std::abs(fall) > run.params.rest_surface) || fall * rise <= 0) return false;
    const bool down = fall > 0; // what diffuses leaves the higher cell
    const float from = down ? water : below, in = down ? sand : sand_below;
    return (run.scene.effects & EFFECT_RETENTION) == 0 || from >= in || from / in > run.params.retained;
}

Verdict check_keep(const StageRun& run) {
    const auto& p = run.params;
    for (int row = 0; row < p.tile_rows; ++row)
        for (int column = 0; column < p.tile_columns; ++column) {
            bool flows = false;
            for (int j = row * 8; j < (row + 1) * 8 && j <= p.ny; ++j)
                for (int i = column * 8; i < (column + 1) * 8 && i <= p.nx; ++i)
                    flows = flows || passes(run, i, j, false) || passes(run, i, j, true);
            const auto at = static_cast<std::size_t>(row * p.tile_columns + column);
            const std::uint32_t wanted = flag(at) != 0 && flows ? step : stamp(at);
            if (run.buffer("activity").words()[at] != wanted) return wrong("activity", at);
        }
    return {};
}

Verdict check_count(const StageRun& run) {
    const TileGrid grid(run.params);
    for (std::size_t at = 0; at < grid.columns * grid.rows; ++at) {
        const bool woke = woken(run.pilot.input, static_cast<int>(at % grid.columns), static_cast<int>(at / grid.columns), 0);
        if (run.buffer("activity").words()[at] != (woke ? step : stamp(at))) return wrong("activity", at);
    }
    for (std::size_t row = 0; row < grid.rows; ++row)
        if (run.buffer("active_counts").words()[row] != grid.flags_of(row)) return wrong("active_counts", row);
    return {};
}

Verdict check_list(const StageRun& run) {
    const TileGrid grid(run.params);
    std::uint32_t count = 0;
    const auto list = run.buffer("active_list").words(), dispatch = run.buffer("active_dispatch").words();
    for (std::size_t tile = 0; tile < grid.columns * grid.rows; ++tile)
        if (flag(tile) != 0 && list[count++] != tile) return wrong("active_list", count - 1);
    const std::array<std::uint32_t, 7> groups = {count, 1, 1, 0, count, 1, 1}; // 8 x 8 threads are one group, fused or not
    for (std::size_t n = 0; n < groups.size(); ++n)
        if (n != 3 && dispatch[n] != groups[n]) return wrong("active_dispatch", n);
    return {};
}

} // namespace

bool lists_active_tiles(const std::string& stage) {
    return stage == "mark_active_tiles" || stage == "choose_active_tiles" || stage == "look_into_tiles" ||
           stage == "keep_water_awake" || stage == "count_active_tiles" || stage == "list_active_tiles";
}

void add_active_tiles(Scene& scene, StepInput& input) {
    scene.settings.active_tiles = 8;
    input.step = step;
    const int columns = FieldLayout::active_tiles(scene.settings.grid.nx, 8),
              rows = FieldLayout::active_tiles(scene.settings.grid.ny, 8);
    const auto f = [](int n) { return static_cast<float>(n); };
    input.wake[input.wake_count++] = {f(columns / 2), f(rows / 2), f(columns / 2), f(rows - 1)};
    input.wake[input.wake_count++] = {f(0), f(0), f(columns / 3), f(0)};
}

bool fill_active_tiles(BenchBuffer& buffer, const compute::StageBinding& binding, const WorldParams& params) {
    if (!binding.name.starts_with("activ")) return false;
    const TileGrid grid(params);
    const std::size_t words = binding.name == "active_counts"     ? grid.rows
                              : binding.name == "active_dispatch" ? 8
                                                                  : grid.columns * grid.rows;
    buffer.before.assign(words, std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN()));
    buffer.may_change.assign(words, binding.access != compute::Access::in);
    buffer.must_change.assign(words, binding.access == compute::Access::out);
    for (std::size_t at = 0; at < words; ++at) {
        if (binding.name.starts_with("activity")) buffer.before[at] = stamp(shifted(binding, at));
        if (binding.name == "active_looked") buffer.before[at] = looked;
        if (binding.name.ends_with("_seen")) buffer.before[at] = seen(shifted(binding, at));
        if (binding.access != compute::Access::in) continue;
        if (binding.name.starts_with("active_tiles")) buffer.before[at] = flag(shifted(binding, at));
        if (binding.name == "active_counts") buffer.before[at] = grid.flags_of(at);
    }
    return true;
}

Verdict check_active_tiles(const StageRun& run) {
    return run.stage.name == "mark_active_tiles"     ? check_mark(run)
           : run.stage.name == "choose_active_tiles" ? check_choose(run)
           : run.stage.name == "look_into_tiles"     ? check_look(run)
           : run.stage.name == "keep_water_awake"    ? check_keep(run)
           : run.stage.name == "count_active_tiles"  ? check_count(run)
                                                     : check_list(run);
}

} // namespace wadi::conformance
