#include "engine/level/level.hpp"
#include "engine/image/map.hpp"
#include "engine/level/draw_work.hpp"
#include "engine/level/overrides.hpp"
#include "engine/level/read_level.hpp"
#include "engine/level/settings_reader.hpp"
#include "engine/level/variants.hpp"
#include "engine/settings/data/accuracy_presets.hpp"
#include "engine/settings/rules/checks.hpp"
#include <algorithm>
#include <filesystem>
#include <new>

namespace wadi {
namespace {

constexpr int FORMAT_VERSION = 1;
constexpr double DURATION_MOST = 1e9; // [s]

void read_version(ObjectReader& root) {
    int version = 0;
    root.require("format_version");
    root.whole_number("format_version", version, 1, 1000000);
    if (version > FORMAT_VERSION)
        root.fail("format_version",
                  std::to_string(version) + " is newer than this build reads, " + std::to_string(FORMAT_VERSION));
}

Status read_root(const Json& json, LevelFiles& files, Level& level, LevelLayers& layers, LevelOverrides& overrides) {
    Status status;
    ObjectReader root(json, "", status);
    read_version(root);
    std::string schema; // editors use it
    root.string("$schema", schema);
    root.require("name");
    root.string("name", level.name);
    root.string("description", level.description);
    root.number("duration", level.duration, 0, DURATION_MOST);
    root.pair("origin", level.origin, -POSITION_MOST, POSITION_MOST);
    if (root.find("fine_grid") != nullptr) {
        std::array<double, 2> cells = {};
        root.pair("fine_grid", cells, 1, GRID_MOST);
        overrides.fine_grid = {static_cast<int>(cells[0]), static_cast<int>(cells[1])};
        if (cells[0] != overrides.fine_grid->first || cells[1] != overrides.fine_grid->second)
            root.fail("fine_grid", "must be whole numbers");
    }
    const auto accuracies = accuracy_names();
    int accuracy = -1;
    root.choice("accuracy", accuracies, accuracy);
    const bool nothing_finer = overrides.accuracy == "fine" && !overrides.fine_grid;
    if (accuracy >= 0 && (!overrides.accuracy || nothing_finer))
        overrides.accuracy = accuracies[static_cast<std::size_t>(accuracy)];
    read_settings(root, files, level.settings);
    if (const Json* list = root.find("terrain")) layers.terrain = read_layers(*list, "terrain", LayerTarget::terrain, status);
    if (const Json* list = root.find("sand")) layers.sand = read_layers(*list, "sand", LayerTarget::sand, status);
    if (const Json* list = root.find("water")) layers.water = read_layers(*list, "water", LayerTarget::water, status);
    if (const Json* list = root.find("roughness"))
        layers.roughness = read_layers(*list, "roughness", LayerTarget::roughness, status);
    if (const Json* list = root.find("rain_map")) layers.rain = read_layers(*list, "rain_map", LayerTarget::rain, status);
    if (const Json* list = root.find("velocities")) layers.velocities = read_velocities(*list, "velocities", status);
    root.finish();
    return status;
}

/// Layers draw how deep water stands; in sand only the pores hold water (NUMERICS 2.23).
void fill_pores(const Settings& settings, InitialFields& fields) {
    const auto n = static_cast<float>(settings.material.porosity);
    const auto one_layer = [](const auto& entry) { return entry.first == "mixture" && entry.second == Force::off; };
    const auto& forced = settings.effects;
    if (n == 1 || fields.sand.empty() || settings.method.published() || std::any_of(forced.begin(), forced.end(), one_layer))
        return;
    for (std::size_t cell = 0; cell < fields.water.size(); ++cell) {
        const float sand = fields.sand[cell], depth = fields.water[cell];
        fields.water[cell] = depth < sand ? n * depth : depth - (sand - n * sand);
    }
}

Status draw(const LevelLayers& layers, const LevelGrid& grid, LevelFiles& files, Level& level) {
    InitialFields& fields = level.fields;
    if (Status status = draw_layers(layers, grid, files, fields, level.warnings); !status) return status;
    fill_pores(level.settings, fields);
    const auto draw_of = [&](bool sand, std::vector<float>& x, std::vector<float>& y) {
        return draw_velocities(layers.velocities, sand, grid, files, x, y, level.warnings);
    };
    if (Status status = draw_of(false, fields.velocity_x, fields.velocity_y); !status) return status;
    if (Status status = draw_of(true, fields.sand_velocity_x, fields.sand_velocity_y); !status) return status;
    if (Status status = draw_numbers(layers.roughness, grid, files, level.settings.roughness, level.warnings); !status)
        return status;
    return draw_numbers(layers.rain, grid, files, level.settings.rain_map, level.warnings);
}

std::int64_t cells_of(const Grid& grid) { return std::int64_t{grid.nx} * grid.ny; }

/// What draw() will count.
std::int64_t work_of(const LevelLayers& layers, const LevelGrid& grid, std::int64_t most) {
    LayerLists roughness, rain;
    roughness.terrain = layers.roughness;
    rain.terrain = layers.rain;
    return layers_work(layers, grid, most).looks + layers_work(roughness, grid, most).looks +
           layers_work(rain, grid, most).looks + static_cast<std::int64_t>(layers.velocities.size()) * grid.nx * grid.ny;
}

Result<Level> parse(const std::string& text, const FileReader& reader, const LevelOverrides& overrides) {
    LevelFiles files{within(reader, overrides.files)};
    auto read = read_level(text, files, overrides);
    if (!read) return read.status();
    Level& level = read->level;
    std::optional<Progress> progress;
    if (overrides.progress) {
        files.progress = &progress.emplace(overrides.progress);
        progress->expect(work_of(read->layers, read->grid, files.work_most));
    }
    if (Status status = draw(read->layers, read->grid, files, level); !status) return status;
    if (Status status = validate(level.fields, level.settings); !status) return error(Code::bad_file, status.message);
    for (std::string& warning : level_warnings(level.settings, level.fields)) level.warnings.push_back(std::move(warning));
    return std::move(level);
}

} // namespace

FileReader within(const FileReader& read, FilesFrom from) {
    if (from == FilesFrom::anywhere) return read;
    return [&read](const std::string& name, std::uint64_t limit) -> Result<std::vector<std::uint8_t>> {
        if (Status status = check_below(name); !status) return status;
        return read(name, limit);
    };
}

Result<ReadLevel> read_level(const std::string& text, LevelFiles& files, LevelOverrides overrides) {
    auto json = parse_json(text);
    if (!json) return json.status();
    ReadLevel read;
    Level& level = read.level;
    auto variants = take_variant(*json, overrides.variant);
    if (!variants) return variants.status();
    level.variants = std::move(*variants);
    if (Status status = read_root(*json, files, level, read.layers, overrides); !status) return status;
    if (overrides.variant) level.name += ", " + *overrides.variant;
    if (Status status = validate(level.settings); !status) return error(Code::bad_file, status.message);
    const std::int64_t own_cells = cells_of(level.settings.grid);
    files.own_nx = level.settings.grid.nx;
    files.own_ny = level.settings.grid.ny;
    auto grid = apply_overrides(overrides, level.settings);
    if (!grid) return grid.status();
    if (Status status = validate(level.settings); !status) return error(Code::bad_argument, status.message);
    const std::int64_t cells = std::max(own_cells, cells_of(level.settings.grid));
    files.room.add(LEVEL_VALUES_PER_CELL * cells);
    files.work_most += LEVEL_WORK_PER_CELL * cells;
    read.grid = *grid;
    return read;
}

Result<Level> parse_level(const std::string& text, const FileReader& files, const LevelOverrides& overrides) {
    try {
        return parse(text, files, overrides);
    } catch (const Cancelled&) {
        return error(Code::cancelled, "the host's progress callback ended the load");
    } catch (const std::bad_alloc&) {
        return error(Code::out_of_memory, "the level does not fit into memory");
    }
}

Result<Level> parse_level(const std::string& text, const std::string& folder, const LevelOverrides& overrides) {
    return parse_level(text, files_in(folder, overrides.files), overrides);
}

Result<Level> load_level(const std::string& path, const LevelOverrides& overrides) {
    auto bytes = read_file_bytes(path, LEVEL_BYTES_MOST);
    if (!bytes) return bytes.status();
    const std::string text(bytes->begin(), bytes->end());
    auto level = parse_level(text, std::filesystem::path(path).parent_path().string(), overrides);
    const bool of_file = !level && level.status().code != Code::bad_argument && level.status().code != Code::cancelled;
    if (of_file) return error(level.status().code, path + ": " + level.status().message);
    return level;
}

} // namespace wadi
