#include "engine/level/frame.hpp"
#include "engine/level/setting_fields.hpp"
#include "engine/level/text.hpp"
#include "engine/method_presets.hpp"
#include <algorithm>
#include <cstddef>

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
    return ok_status();
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

} // namespace

Result<Frame> apply_overrides(const LevelOverrides& overrides, Settings& settings) {
    if (Status status = check(overrides); !status) return status;
    Frame frame;
    if (overrides.size) {
        Grid& grid = settings.grid;
        const double dx = grid.nx * grid.dx / overrides.size->first;
        frame.stretch_y = overrides.size->second * dx / (grid.ny * grid.dx);
        settings.dt *= dx / grid.dx;
        grid = {overrides.size->first, overrides.size->second, dx};
        stretch(settings, frame.stretch_y);
    }
    if (overrides.dt) settings.dt = *overrides.dt;
    if (overrides.method && *overrides.method != settings.method.name) choose_method(settings.method, *overrides.method);
    frame.nx = settings.grid.nx;
    frame.ny = settings.grid.ny;
    frame.dx = settings.grid.dx;
    frame.quantum = height_quantum(settings.method);
    return frame;
}

} // namespace wadi
