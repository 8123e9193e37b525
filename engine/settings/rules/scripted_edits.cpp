#include "engine/settings/rules/scripted_edits.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/edit_checks.hpp"
#include "engine/settings/rules/messages.hpp"
#include <algorithm>
#include <cmath>
#include <map>

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

/// At most so many turns of a script fall into a step.
std::uint64_t turns_per_step(const ScriptedEdit& script, double dt) {
    return script.every > 0 && script.every < dt ? static_cast<std::uint64_t>(dt / script.every) + 1 : 1;
}

struct Fullest {
    std::uint64_t edits = 0, step = 0;
};

/// As if every script had its most turns in each step from its first to its last.
Fullest fullest_at_most(const Settings& settings) {
    std::map<std::uint64_t, std::int64_t> changes;
    for (const ScriptedEdit& script : settings.edits) {
        const std::uint64_t last = last_turn(script);
        const auto turns = static_cast<std::int64_t>(std::min(turns_per_step(script, settings.dt), last + 1));
        changes[step_of(script, 0, settings.dt)] += turns;
        changes[step_of(script, last, settings.dt) + 1] -= turns;
    }
    Fullest fullest;
    std::int64_t now = 0;
    for (const auto& [step, change] : changes) {
        now += change;
        if (now > static_cast<std::int64_t>(fullest.edits)) fullest = {static_cast<std::uint64_t>(now), step};
    }
    return fullest;
}

/// Turn by turn.
Fullest fullest_step(const Settings& settings) {
    std::map<std::uint64_t, std::uint64_t> edits;
    Fullest fullest;
    for (const ScriptedEdit& script : settings.edits)
        for (std::uint64_t turn = 0; turn <= last_turn(script); ++turn) {
            const std::uint64_t step = step_of(script, turn, settings.dt), now = ++edits[step];
            if (now > fullest.edits) fullest = {now, step};
        }
    return fullest;
}

/// Exactly where that is above `enough` and not too long to count.
Fullest fullest_known(const Settings& settings, std::uint64_t enough) {
    constexpr double countable = 1e6; // turns, one by one
    const Fullest fullest = fullest_at_most(settings);
    double turns = 0;
    for (const ScriptedEdit& script : settings.edits) turns += static_cast<double>(last_turn(script)) + 1;
    return fullest.edits > enough && turns <= countable ? fullest_step(settings) : fullest;
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

std::uint64_t most_edits_per_step(const Settings& settings) { return fullest_known(settings, 0).edits; }

Status check_edits_per_step(const Settings& settings) {
    const Fullest fullest = fullest_known(settings, STEP_EDITS_MOST);
    if (fullest.edits <= STEP_EDITS_MOST) return ok_status();
    return error(Code::bad_argument, "edits: they bring up to " + std::to_string(fullest.edits) + " into one step, at " +
                                         number_text(static_cast<double>(fullest.step) * settings.dt) + " s; allowed are " +
                                         std::to_string(STEP_EDITS_MOST));
}

} // namespace wadi
