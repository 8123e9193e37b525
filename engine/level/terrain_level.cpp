#include "engine/image/map.hpp"
#include "engine/image/plausible.hpp"
#include "engine/level/layer_map.hpp"
#include "engine/level/layers.hpp"
#include "engine/level/level.hpp"
#include "engine/level/overrides.hpp"
#include "engine/level/read_level.hpp"
#include "engine/settings/data/quanta.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/checks.hpp"
#include "engine/settings/rules/messages.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <new>

namespace wadi {
namespace {

constexpr double CELL = 1;           // where the map does not say [m]
constexpr double DT = 0.02;          // per metre of cell size: streams of 17 m/s and waves of 27 keep their speed [s]
constexpr double RELIEF = 0.125;     // height_range of integer maps, as a share of the longer side
constexpr double HEADROOM = 1.5;     // largest_height over the highest terrain
constexpr double LEAST_HEADROOM = 8; // [m]
constexpr double DURATION = 60;      // per metre of cell size, so that large cells get as many steps [s]
constexpr double RAIN = 0.15;      // falls in the first half of the duration, less on cells below 1 m; then streams are left [m]
constexpr double MANNING = 0.03;   // of a clean river
constexpr double SEA_LEAST = 0.05; // share of the map below 0
constexpr double DEGREES = 0.02;   // cells below this are in degrees rather than metres

/// Integer maps: black = 0, white = the relief, whatever range of greys the map uses. NPY and ASC: as stored.
Status scale_heights(Map& map, const std::string& path) {
    const auto [low, high] = std::minmax_element(map.values.begin(), map.values.end());
    if (map.integer) {
        const float least = *low;
        const float range = *high > *low ? *high - *low : 1.0f;
        const auto relief = static_cast<float>(RELIEF * CELL * std::max(map.nx, map.ny));
        for (float& value : map.values) value = (value - least) / range * relief;
    } else if (std::max(std::fabs(*low), std::fabs(*high)) > static_cast<float>(HEIGHT_MOST / HEADROOM / 2)) {
        return error(Code::bad_file, path + ": heights up to " + std::to_string(*high) + " m are more than a world holds");
    }
    return ok_status();
}

/// Holes that reach the rim are what the survey left out: outside, where water goes.
void leave_outside(Map& map, double cell) {
    const std::int64_t before = map.filled;
    raise_holes(map, Holes::outside, cell);
    if (map.filled == before) return;
    map.notes.push_back(
        std::to_string(before - map.filled) +
        " cells without a height reach the map's rim: taken for outside, where water goes and does not come back; "
        "\"holes\" of a level's map says otherwise");
}

/// Ground below 0 on a map of elevations is as a rule a sea's bed, of which the map says nothing.
void note_sea(Map& map) {
    if (map.integer) return;
    const auto below = std::count_if(map.values.begin(), map.values.end(), [](float height) { return height < 0; });
    const double share = static_cast<double>(below) / static_cast<double>(map.values.size());
    if (share < SEA_LEAST || below == std::ssize(map.values)) return;
    const auto deepest = static_cast<double>(*std::min_element(map.values.begin(), map.values.end()));
    map.notes.push_back(
        number_text(std::round(100 * share)) + " % of it lies below 0, down to " + number_text(std::round(10 * deepest) / 10) +
        " m: a sea's bed? It starts dry; \"water\": [{\"shape\": \"plane\", \"surface\": 0}] of a level fills it, sides "
        "with \"kind\": \"level\", \"value\": 0 hold it");
}

Result<Level> build(const std::string& map_path, const LevelOverrides& overrides) {
    FileRoom room(std::int64_t{MAP_LIMIT} * MAP_LIMIT);
    auto map = read_map(map_path, {}, files_in("", FilesFrom::anywhere), room); // named by the host
    if (!map) return map.status();
    map->corners = looks_like_corners(map->nx, map->ny);
    note_odd_ground(*map);
    if (map->corners) {
        map->notes.push_back(std::to_string(map->nx) + " x " + std::to_string(map->ny) +
                             " samples are taken for the corners of cells, as engines have them");
        if (map->origin)
            for (double& at : *map->origin) at += map->cell_size / 2; // the grid begins at the middle of the file's first cell
        resample_map(*map, map->nx - 1, map->ny - 1);
    }
    leave_outside(*map, map->cell_size > 0 ? map->cell_size : CELL);
    note_sea(*map);
    if (Status status = scale_heights(*map, map_path); !status) return status;

    const double cell = map->cell_size > 0 ? map->cell_size : CELL;
    if (!(cell >= DX_LEAST && cell <= DX_MOST))
        return error(Code::bad_file, outside_text(map_path + ": cellsize", cell, DX_LEAST, DX_MOST) + " m");

    Level level;
    level.name = std::filesystem::path(map_path).stem().string();
    level.description = "Rain on a map, which leaves over the sides.";
    level.origin = map->origin.value_or(level.origin);
    level.duration = DURATION * cell;
    Settings& settings = level.settings;
    settings.grid = {map->nx, map->ny, cell};
    settings.dt = DT * cell;
    const auto [low, high] = std::minmax_element(map->values.begin(), map->values.end());
    const double reach = std::max(static_cast<double>(*high), -static_cast<double>(*low));
    settings.method.largest_height = std::exp2(std::ceil(std::log2(std::max(reach * HEADROOM, reach + LEAST_HEADROOM))));
    const double quantum = height_quantum(settings.method);
    settings.method.dry_threshold = std::max(settings.method.dry_threshold, quantum);
    for (Side& side : settings.sides) side.kind = SideKind::outflow;

    auto grid = apply_overrides(overrides, settings);
    if (!grid) return grid.status();
    level.fields.terrain = resample(*map, grid->nx, grid->ny);
    for (float& height : level.fields.terrain)
        height = static_cast<float>(nearest_quantum(static_cast<double>(height), quantum, Halves::away));
    settings.material.manning = MANNING;
    const double rate = RAIN * std::min(cell, 1.0) / (level.duration / 2), end = level.duration / 2;
    settings.rain.samples = {{0.0, rate}, {end, rate}, {end * (1 + 1e-6), 0.0}};
    if (Status status = validate(settings); !status) return status;
    if (Status status = validate(level.fields, settings); !status) return status;
    level.warnings = level_warnings(settings, level.fields);
    add_map_notes(*map, map_path, level.warnings);
    if (cell < DEGREES)
        level.warnings.push_back(map_path + ": a cellsize of " + number_text(cell) +
                                 " looks like degrees; it is read as metres: project the map first");
    return level;
}

} // namespace

Result<LevelCost> cost_of_terrain(const std::string& map_path, const LevelOverrides& overrides) {
    const auto map = cost_of_map(map_path, {}, files_in("", FilesFrom::anywhere), std::int64_t{MAP_LIMIT} * MAP_LIMIT);
    if (!map) return map.status();
    const auto& asked = map->asked;
    const int less = looks_like_corners(asked.nx, asked.ny) ? 1 : 0;
    LevelCost result;
    Settings& settings = result.settings;
    settings.grid = {asked.nx - less, asked.ny - less, CELL};
    settings.dt = DT * CELL;
    settings.material.manning = MANNING;
    settings.rain.samples = {{0.0, RAIN}};
    for (Side& side : settings.sides) side.kind = SideKind::outflow;
    if (auto grid = apply_overrides(overrides, settings); !grid) return grid.status();
    Cost& cost = result.cost;
    const auto cells = static_cast<std::uint64_t>(settings.grid.nx) * static_cast<std::uint64_t>(settings.grid.ny);
    cost.cells = cells;
    cost.file_bytes = map->file_bytes;
    cost.map_values = static_cast<std::uint64_t>(asked.values);
    cost.host_bytes = load_bytes(*map, cells);
    return result;
}

Result<Level> level_from_terrain(const std::string& map_path, const LevelOverrides& overrides) {
    if (overrides.variant) return error(Code::bad_argument, "variant: a terrain map has none");
    try {
        return build(map_path, overrides);
    } catch (const std::bad_alloc&) {
        return error(Code::out_of_memory, map_path + ": the map does not fit into memory");
    }
}

} // namespace wadi
