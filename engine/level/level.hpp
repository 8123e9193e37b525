// Level files: JSON plus maps, or a terrain map alone. docs: samples/levels/README.md; schema: samples/levels/level.schema.json.
#pragma once
#include "engine/compute/status.hpp"
#include "engine/image/map.hpp"
#include "engine/level/progress.hpp"
#include "engine/settings/data/settings.hpp"
#include "engine/settings/rules/cost.hpp"
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace wadi {

/// A level ready to run: settings, fields and what the file says beside them.
struct Level {
    std::string name;
    std::string description;
    Settings settings;
    InitialFields fields;
    double duration = 10;              // [s] a recorder runs by default
    std::array<double, 2> origin = {}; // of the grid's south-west corner on the map that the level was cut from [m]
    std::vector<std::string> variants; // names that LevelOverrides::variant takes
    std::vector<std::string> warnings; // advice with numbers, not errors
};

/// What a caller may choose or override before maps are sampled and shapes drawn.
struct LevelOverrides {
    /// New grid size. Keeps the length in x and square cells: dx = length/nx, maps and shapes stretch in y when the aspect
    /// changes, dt scales with dx unless given.
    std::optional<std::pair<int, int>> size;
    std::optional<double> dt;           // [s]
    std::optional<std::string> method;  // name of a method preset
    std::optional<std::string> variant; // one of the level's own, merged in before anything else
    /// Name of an accuracy preset: scales the level's cells, unless `size` is given, and sets the sand substeps per water step.
    std::optional<std::string> accuracy;
    std::optional<std::pair<int, int>> fine_grid; // cells along x and y of accuracy "fine"; none = what the level says
    std::optional<int> active_tiles;              // Settings::active_tiles
    std::optional<FusedStages> fused_stages;      // Settings::fused_stages
    std::uint32_t drawn_effects = 0;              // Settings::drawn_effects
    /// Where the maps and series of the level may lie. By default whoever wrote the level chooses among the files beside it
    /// alone.
    FilesFrom files = FilesFrom::below;
    Progress::Tell progress; // hears how far drawing is; may be empty
};

/// What a level will cost, all but `device_bytes`, which follow from the settings and from what the world may hold.
struct LevelCost {
    Cost cost;
    Settings settings;                // of a map alone, whose heights are not known: without what follows from them
    bool sand = false, water = false; // what its layers may bring
};

/// Reads a level file. Errors: not_found, bad_file (position or field, nearest known key, allowed range), cancelled.
Result<Level> load_level(const std::string& path, const LevelOverrides& overrides);

/// The same from text; the maps and series that it names come from `files`.
Result<Level> parse_level(const std::string& text, const FileReader& files, const LevelOverrides& overrides);
/// The same with files on disk, relative to `folder`.
Result<Level> parse_level(const std::string& text, const std::string& folder, const LevelOverrides& overrides);

/// A level from a terrain map alone: the map's size unless overridden, cells of 1 m or the cellsize of an ASC map, dt and
/// duration in proportion. Integer maps are scaled so that their relief is 1/8 of the longer side, NPY and ASC heights are
/// metres as stored. Rain falls for half of the duration, every side is an outflow, and so are holes that reach the rim.
Result<Level> level_from_terrain(const std::string& map_path, const LevelOverrides& overrides);

/// What these three would cost: the level's text is read, and of its maps the headers; nothing is decoded or drawn. Errors:
/// theirs, as far as that shows them.
Result<LevelCost> cost_of_level(const std::string& path, const LevelOverrides& overrides);
Result<LevelCost> cost_of_level(const std::string& text, const FileReader& files, const LevelOverrides& overrides);
Result<LevelCost> cost_of_terrain(const std::string& map_path, const LevelOverrides& overrides);

/// Advice with numbers: waves slower than they should be for this dx and dt, cohesion too weak to hold a wall, columns near
/// the declared largest height, and the like (NUMERICS.md section 4).
std::vector<std::string> level_warnings(const Settings& settings, const InitialFields& fields);

} // namespace wadi
