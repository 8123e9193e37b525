#include "print.hpp"
#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace tune {
namespace {

constexpr std::size_t MOST_ROWS = 16; // of the frontier's table

#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
std::string
format(const char* pattern, ...) {
    char text[1024];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(text, sizeof text, pattern, arguments);
    va_end(arguments);
    return text;
}

std::string grid_text(const Settings& settings) { return format("%d x %d", settings.nx, settings.ny); }

/// "sand 0.6 %", or why there is no number.
std::string error_text(const char* name, const Told& told, const std::optional<double>& error) {
    if (!told.moved || !error) return std::string(name) + " unknown, since nothing of it moves";
    return format("%s %s%.2g %%", name, told.converges ? "" : "at least ", *error);
}

std::string errors_text(const Outcome& outcome, const Errors& errors) {
    std::string text;
    if (outcome.sand.exists) text += error_text("sand", outcome.sand, errors.sand);
    if (outcome.water.exists) text += (text.empty() ? "" : " and ") + error_text("water", outcome.water, errors.water);
    return text.empty() ? "no sand and no water" : text + " wrong";
}

std::string cell(const std::optional<double>& error) { return error ? format("%.2f", *error) : "-"; }

/// The frontier from a quarter of the budget to four times it, thinned out.
std::vector<Candidate> shown_rows(const Outcome& outcome, double budget_ms) {
    std::vector<Candidate> near;
    for (const Candidate& c : outcome.frontier) {
        if (c.frame_ms >= 0.25 * budget_ms && c.frame_ms <= 4 * budget_ms) near.push_back(c);
    }
    std::vector<Candidate> rows;
    double next = 0;
    for (const Candidate& c : near) {
        if (c.frame_ms < next) continue;
        rows.push_back(c);
        next = c.frame_ms * std::pow(16.0, 1.0 / MOST_ROWS);
    }
    return rows;
}

Json error_json(const std::optional<double>& error) { return error ? Json(*error) : Json(nullptr); }

Json candidate_json(const Level& level, const Candidate& c) {
    return {{"nx", c.settings.nx},
            {"ny", c.settings.ny},
            {"dx", level.dx(c.settings)},
            {"dt", level.dt(c.settings)},
            {"substeps", c.settings.way.substeps},
            {"water_transport_order", c.settings.way.water_order},
            {"sand_transport_order", c.settings.way.sand_order},
            {"active_tiles", c.settings.way.active_tiles},
            {"ms_per_step", c.step_ms},
            {"steps_per_frame", c.steps_per_frame},
            {"ms_per_frame", c.frame_ms},
            {"sand_percent", error_json(c.errors.sand)},
            {"water_percent", error_json(c.errors.water)}};
}

Json told_json(const Told& told) {
    Json differences = Json::array();
    for (const ErrorPoint& point : told.differences)
        differences.push_back({{"cell_size", point.h}, {"percent", point.difference}});
    return {{"exists", told.exists},
            {"moved", told.moved},
            {"converges", told.converges},
            {"order", told.order},
            {"closing_order", told.closing},
            {"scatter", told.scatter},
            {"reference_percent", told.reference},
            {"differences", differences},
            {"early_checkpoints", told.early},
            {"early_percent", told.early_percent}};
}

} // namespace

std::string conclusion(const std::string& level_name, const Level& level, const Request& request, const Outcome& outcome) {
    const Candidate& c = outcome.chosen;
    return format("%s: %s cells, %s: %.3g ms of the %.3g ms a frame, %s (against %s cells, %s, over %s%.3g s)",
                  level_name.c_str(), grid_text(c.settings).c_str(), describe(c.settings.way).c_str(), c.frame_ms,
                  request.budget_ms, errors_text(outcome, c.errors).c_str(), grid_text(outcome.reference).c_str(),
                  describe(outcome.reference.way).c_str(), outcome.piece < 0.999 * level.duration() ? "the first " : "",
                  outcome.piece);
}

std::string report(const Level& level, const Request& request, const Outcome& outcome) {
    const Candidate& c = outcome.chosen;
    std::string text;
    text += format("measured  %s: %s, %s; %d run%s of it within %.1f %%; %.0f s and %d runs in all\n", outcome.backend.c_str(),
                   outcome.device_name.c_str(), request.device.processor_time ? "processor time" : "wall time",
                   outcome.confirming_runs, outcome.confirming_runs == 1 ? "" : "s", 100 * outcome.spread, outcome.seconds,
                   outcome.runs);
    text += format("frame     %.3g steps of %.3g ms at %g frames a second; in the dearest sixteenth of the time %.3g ms\n",
                   c.steps_per_frame, c.step_ms, request.frames, outcome.dearest_frame_ms);
    if (c.steps_per_frame < 0.7)
        text += format("          a whole step falls into every %.2gth frame or so; wadi_update_settings.spread spreads it\n",
                       1 / c.steps_per_frame);
    text += format("before    the model had said %.3g ms, %s\n", outcome.predicted.frame_ms,
                   errors_text(outcome, outcome.predicted.errors).c_str());
    if (outcome.measured_share < 1)
        text += format("note      its time is that of the first %.3g s, carried on to %.3g s as on a coarser grid\n",
                       outcome.measured_share * level.duration(), level.duration());
    for (const bool sand : {true, false}) {
        const Told& told = sand ? outcome.sand : outcome.water;
        const char* const name = sand ? "sand" : "water";
        if (told.exists && !told.moved)
            text += format("note      %s: nothing of it moves in %.3g s, so no error can be told\n", name, outcome.piece);
        if (told.moved && !told.converges)
            text += format("note      %s: runs do not come closer to each other as cells get smaller; errors are at least half "
                           "the differences\n",
                           name);
        if (told.early > 0)
            text += format("note      %s: in the first %.3g s they do, and there it is %.2g %% wrong\n", name,
                           outcome.piece * told.early / outcome.checkpoints, told.early_percent);
    }
    if (!outcome.errors_measured && (outcome.sand.moved || outcome.water.moved))
        text += "note      the errors are the model's: no run finer than these settings fitted into the time (--minutes)\n";
    for (const std::string& warning : outcome.warnings) text += "warning   " + warning + "\n";
    for (const std::string& note : outcome.notes) text += "note      " + note + "\n";

    text += format("\n  %-12s %10s %6s %6s %3s %6s %10s %8s %8s\n", "cells", "dt [s]", "water", "sand", "T", "tiles",
                   "ms a frame", "sand %", "water %");
    std::vector<Candidate> rows = shown_rows(outcome, request.budget_ms);
    const auto at = std::find_if(rows.begin(), rows.end(), [&](const Candidate& row) { return row.frame_ms > c.frame_ms; });
    const auto place = rows.insert(at, c) - rows.begin();
    for (std::size_t n = 0; n < rows.size(); ++n) {
        const Settings& s = rows[n].settings;
        text += format("  %-12s %10.6g %6d %6d %3d %6s %10.3g %8s %8s%s\n", grid_text(s).c_str(), level.dt(s), s.way.water_order,
                       s.way.sand_order, s.way.substeps, s.way.active_tiles == 1 ? "auto" : "level", rows[n].frame_ms,
                       cell(rows[n].errors.sand).c_str(), cell(rows[n].errors.water).c_str(),
                       static_cast<std::ptrdiff_t>(n) == place ? "  <- measured" : "");
    }
    return text;
}

Json report_json(const std::string& level_name, const Level& level, const Request& request, const Outcome& outcome) {
    Json json;
    json["level"] = level_name;
    json["conclusion"] = conclusion(level_name, level, request, outcome);
    json["budget_ms"] = request.budget_ms;
    json["frames_per_second"] = request.frames;
    json["device"] = {{"backend", outcome.backend},
                      {"name", outcome.device_name},
                      {"threads", request.device.threads},
                      {"clock", request.device.processor_time ? "processor" : "wall"}};
    json["chosen"] = candidate_json(level, outcome.chosen);
    json["predicted"] = candidate_json(level, outcome.predicted);
    json["patch"] = level.patch(outcome.chosen.settings);
    json["confirmed"] = {{"runs", outcome.confirming_runs},
                         {"spread", outcome.spread},
                         {"dearest_ms_per_frame", outcome.dearest_frame_ms},
                         {"share_of_the_level", outcome.measured_share},
                         {"errors_measured", outcome.errors_measured}};
    json["reference"] = {
        {"nx", outcome.reference.nx}, {"ny", outcome.reference.ny}, {"settings", describe(outcome.reference.way)}};
    json["sand"] = told_json(outcome.sand);
    json["water"] = told_json(outcome.water);
    json["piece_seconds"] = outcome.piece;
    json["checkpoints"] = outcome.checkpoints;
    json["load"] = outcome.load;
    json["tiles_gain"] = outcome.tiles_gain;
    json["seconds"] = outcome.seconds;
    json["runs"] = outcome.runs;
    json["frontier"] = Json::array();
    for (const Candidate& c : outcome.frontier) json["frontier"].push_back(candidate_json(level, c));
    json["notes"] = outcome.notes;
    json["warnings"] = outcome.warnings;
    return json;
}

} // namespace tune
