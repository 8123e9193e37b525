#include "engine/image/map.hpp"
#include "engine/image/plausible.hpp"
#include "engine/level/layers.hpp"
#include "engine/level/level.hpp"
#include "engine/level/overrides.hpp"
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

constexpr double CELL = 1;               // where the map does not say [m]
constexpr double DT = 0.05;              // per metre of cell size: waves on 8 m of water keep their speed [s]
constexpr double RELIEF = 0.125;         // height_range of integer maps, as a share of the longer side
constexpr double HEADROOM = 1.5;         // largest_height over the highest terrain
constexpr double LEAST_HEADROOM = 8;     // [m]
constexpr double SOURCE_SHARE = 0.03;    // radius of the spring, as a share of the shorter side
constexpr double SOURCE_LEAST_CELLS = 2; // and at least this many cells
constexpr double SOURCE_RATE = 0.1;      // [m/s]
constexpr double DURATION = 60;          // per metre of cell size, so that large cells get as many steps [s]
constexpr double DEGREES = 0.02;         // cells below this are in degrees rather than metres

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

Source spring(const std::vector<float>& terrain, const Grid& grid) {
    const auto highest = static_cast<std::size_t>(std::max_element(terrain.begin(), terrain.end()) - terrain.begin());
    const auto width = static_cast<std::size_t>(grid.nx);
    const double lengths[2] = {grid.nx * grid.dx, grid.ny * grid.dx};
    const double at[2] = {(static_cast<double>(highest % width) + 0.5) * grid.dx,
                          (static_cast<double>(highest / width) + 0.5) * grid.dx};
    Source source;
    source.radius = std::max(SOURCE_SHARE * std::min(lengths[0], lengths[1]), SOURCE_LEAST_CELLS * grid.dx);
    for (std::size_t axis = 0; axis < 2; ++axis) {
        // Inside by its radius where the grid is wide enough: at the rim the water would leave at once.
        const double margin = std::min(source.radius, lengths[axis] / 2);
        source.center[axis] = std::clamp(at[axis], margin, lengths[axis] - margin);
    }
    source.rate.samples = {{0.0, SOURCE_RATE}};
    return source;
}

Result<Level> build(const std::string& map_path, const LevelOverrides& overrides) {
    FileRoom room(std::int64_t{MAP_LIMIT} * MAP_LIMIT);
    auto map = read_map(map_path, std::nullopt, files_in("", FilesFrom::anywhere), room); // named by the host
    if (!map) return map.status();
    map->corners = looks_like_corners(map->nx, map->ny);
    note_odd_ground(*map);
    if (map->corners) {
        map->notes.push_back(std::to_string(map->nx) + " x " + std::to_string(map->ny) +
                             " samples are taken for the corners of cells, as engines have them");
        map->values = resample(*map, map->nx - 1, map->ny - 1);
        --map->nx;
        --map->ny;
        map->corners = false;
    }
    if (Status status = scale_heights(*map, map_path); !status) return status;

    const double cell = map->cell_size > 0 ? map->cell_size : CELL;
    if (!(cell >= DX_LEAST && cell <= DX_MOST))
        return error(Code::bad_file, outside_text(map_path + ": cellsize", cell, DX_LEAST, DX_MOST) + " m");

    Level level;
    level.name = std::filesystem::path(map_path).stem().string();
    level.description = "Water springs from the highest place and leaves over the sides.";
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
    settings.sources.push_back(spring(level.fields.terrain, settings.grid));
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

Result<Level> level_from_terrain(const std::string& map_path, const LevelOverrides& overrides) {
    if (overrides.variant) return error(Code::bad_argument, "variant: a terrain map has none");
    try {
        return build(map_path, overrides);
    } catch (const std::bad_alloc&) {
        return error(Code::out_of_memory, map_path + ": the map does not fit into memory");
    }
}

} // namespace wadi
