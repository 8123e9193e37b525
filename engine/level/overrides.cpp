#include "engine/level/overrides.hpp"
#include "engine/compute/available_memory.hpp"
#include "engine/settings/data/accuracy_presets.hpp"
#include "engine/settings/data/method_presets.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/messages.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

namespace wadi {
namespace {

Status check(const LevelOverrides& overrides) {
    if (overrides.size)
        for (const int cells : {overrides.size->first, overrides.size->second})
            if (cells < 1 || cells > GRID_MOST)
                return error(Code::bad_argument, outside_text("size", cells, 1, GRID_MOST) + " cells on each side");
    if (overrides.dt && !(*overrides.dt >= DT_LEAST && *overrides.dt <= DT_MOST))
        return error(Code::bad_argument, outside_text("dt", *overrides.dt, DT_LEAST, DT_MOST) + " s");
    const auto& names = method_names();
    if (overrides.method && std::find(names.begin(), names.end(), *overrides.method) == names.end())
        return error(Code::bad_argument,
                     "method: \"" + *overrides.method + "\" is not known" + suggestion(*overrides.method, names));
    if (overrides.accuracy && find_accuracy_preset(*overrides.accuracy) == nullptr)
        return error(Code::bad_argument, "accuracy: \"" + *overrides.accuracy + "\" is not known" +
                                             suggestion(*overrides.accuracy, accuracy_names()));
    return ok_status();
}

std::optional<std::pair<int, int>> chosen_size(const LevelOverrides& overrides, const Grid& grid) {
    if (overrides.size || !overrides.accuracy) return overrides.size;
    const double factor = find_accuracy_preset(*overrides.accuracy)->cells;
    if (factor == 0) return overrides.fine_grid;
    if (factor == 1) return std::nullopt;
    const auto scaled = [&](int cells) { return std::max(1, static_cast<int>(std::lround(cells * factor))); };
    return std::pair{scaled(grid.nx), scaled(grid.ny)};
}

void stretch(Settings& settings, double factor) {
    for (const SideName name : {SideName::west, SideName::east}) {
        Side& side = settings.sides[static_cast<std::size_t>(name)];
        side.from *= factor;
        side.to *= factor;
    }
    for (Source& source : settings.sources) {
        source.center[1] *= factor;
        source.box[1] *= factor;
        source.box[3] *= factor;
    }
    for (ScriptedEdit& script : settings.edits) {
        script.edit.y0 *= factor;
        script.edit.y1 *= factor;
        script.move[1] *= factor;
    }
}

// Before anything of the grid's size is asked for: the system may end a process that touches more than there is.
Status check_memory(const Grid& grid) {
    constexpr std::uint64_t drawn = 36; // bytes per cell: terrain, sand, water, four velocities, roughness, rain
    const std::uint64_t bytes = std::uint64_t(grid.nx) * std::uint64_t(grid.ny) * drawn, available = available_memory();
    if (available == 0 || bytes <= available / 10 * 9) return ok_status();
    return error(Code::out_of_memory, "grid: " + std::to_string(grid.nx) + " x " + std::to_string(grid.ny) + " cells need " +
                                          std::to_string(bytes >> 20) + " MiB while they are drawn; " + "9/10 of the " +
                                          std::to_string(available >> 20) + " MiB that are available are fewer");
}

} // namespace

Result<LevelGrid> apply_overrides(const LevelOverrides& overrides, Settings& settings) {
    if (Status status = check(overrides); !status) return status;
    LevelGrid level_grid;
    if (const auto size = chosen_size(overrides, settings.grid)) {
        Grid& grid = settings.grid;
        const double dx = grid.nx * grid.dx / size->first;
        level_grid.stretch_y = size->second * dx / (grid.ny * grid.dx);
        settings.dt *= dx / grid.dx;
        grid = {size->first, size->second, dx};
        stretch(settings, level_grid.stretch_y);
    }
    if (auto status = check_memory(settings.grid); !status) return status;
    if (overrides.dt) settings.dt = *overrides.dt;
    settings.drawn_effects = overrides.drawn_effects;
    if (overrides.fused_stages) settings.fused_stages = *overrides.fused_stages;
    if (overrides.active_tiles) settings.active_tiles = *overrides.active_tiles;
    if (overrides.method && *overrides.method != settings.method.name) choose_method(settings, *overrides.method);
    if (overrides.accuracy) {
        const AccuracyPreset& preset = *find_accuracy_preset(*overrides.accuracy);
        if (preset.substeps != 0) settings.method.substeps = preset.substeps;
        if (preset.water_order != 0) settings.method.water_transport_order = preset.water_order;
    }
    level_grid.nx = settings.grid.nx;
    level_grid.ny = settings.grid.ny;
    level_grid.dx = settings.grid.dx;
    level_grid.quantum = height_quantum(settings.method);
    return level_grid;
}

} // namespace wadi
