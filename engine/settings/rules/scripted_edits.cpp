#include "engine/settings/rules/scripted_edits.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/edit_checks.hpp"
#include "engine/settings/rules/messages.hpp"
#include <algorithm>
#include <cmath>

namespace wadi {

namespace {

constexpr double ROUNDING = 1e-9; // of (until - time) / every, so that the last time counts where it is a whole number of them

double time_of(const ScriptedEdit& script, std::uint64_t turn) { return script.time + static_cast<double>(turn) * script.every; }

std::uint64_t step_of(const ScriptedEdit& script, std::uint64_t turn, double dt) {
    return static_cast<std::uint64_t>(std::llround(time_of(script, turn) / dt));
}

std::uint64_t last_turn(const ScriptedEdit& script) {
    return script.every > 0 ? static_cast<std::uint64_t>((script.until - script.time) / script.every + ROUNDING) : 0;
}

/// The first turn at this step or a later one.
std::uint64_t first_turn(const ScriptedEdit& script, std::uint64_t step, double dt) {
    std::uint64_t turn = 0;
    if (script.every > 0) { // a turn early, whatever the rounding; the loop finds the exact one
        const double guess = ((static_cast<double>(step) - 0.5) * dt - script.time) / script.every - 1;
        turn = static_cast<std::uint64_t>(std::clamp(guess, 0.0, static_cast<double>(last_turn(script))));
    }
    while (turn <= last_turn(script) && step_of(script, turn, dt) < step) ++turn;
    return turn;
}

Edit moved(const ScriptedEdit& script, std::uint64_t turn) {
    const double since = static_cast<double>(turn) * script.every;
    Edit edit = script.edit;
    edit.x0 += script.move[0] * since;
    edit.x1 += script.move[0] * since;
    edit.y0 += script.move[1] * since;
    edit.y1 += script.move[1] * since;
    return edit;
}

} // namespace

void append_scripted_edits(const Settings& settings, std::uint64_t step, std::vector<Edit>& to) {
    for (const ScriptedEdit& script : settings.edits) {
        const std::uint64_t last = last_turn(script);
        for (auto turn = first_turn(script, step, settings.dt); turn <= last && step_of(script, turn, settings.dt) == step;
             ++turn)
            to.push_back(moved(script, turn));
    }
}

Status check_scripted_edit(const Settings& settings, std::size_t index) {
    const ScriptedEdit& script = settings.edits[index];
    const std::string path = "edits[" + std::to_string(index) + "].";
    const auto refuse = [](const std::string& message) { return error(Code::bad_argument, message); };
    const auto outside = [](double value, double least, double most) { return !(value >= least && value <= most); };
    if (script.edit.kind == EditKind::stamp) return refuse(path + "kind: a level has brushes and pushes, no stamps");
    if (outside(script.time, 0, EDIT_TIME_MOST)) return refuse(outside_text(path + "time", script.time, 0, EDIT_TIME_MOST));
    if (script.every != 0) {
        if (outside(script.every, EDIT_EVERY_LEAST, EDIT_TIME_MOST))
            return refuse(outside_text(path + "every", script.every, EDIT_EVERY_LEAST, EDIT_TIME_MOST));
        if (outside(script.until, script.time, EDIT_TIME_MOST))
            return refuse(outside_text(path + "until", script.until, script.time, EDIT_TIME_MOST) + " (from time on)");
    }
    for (std::size_t axis = 0; axis < 2; ++axis)
        if (outside(script.move[axis], -SPEED_MOST, SPEED_MOST))
            return refuse(outside_text(path + "move[" + std::to_string(axis) + "]", script.move[axis], -SPEED_MOST, SPEED_MOST));
    Edit edit = script.edit;
    edit.step = 0;
    return check_edit("", index, edit, settings, {}, 0);
}

} // namespace wadi
