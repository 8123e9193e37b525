#include "report.hpp"
#include <algorithm>
#include <cinttypes>
#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace recorder {
namespace {

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void append(std::string& text, const char* pattern, ...) {
    char line[512];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(line, sizeof line, pattern, arguments);
    va_end(arguments);
    text += line;
}

void append_ledger(std::string& text, const char* name, double initial, double in, double out, double now, std::int64_t quanta) {
    append(text, "  %-6s %13.6g %13.6g %13.6g %13.6g %12.3g %10" PRId64 "\n", name, initial, in, out, now,
           relative_drift(initial, in, out, now), quanta);
}

void append_count(std::string& text, const char* name, const Count& count) {
    append(text, "  %-36s %12" PRIu64 " %12" PRIu64 "\n", name, count.last, count.largest);
}

void append_share(std::string& text, const char* name, const Share& share) {
    append(text, "    %-34s %12.3g %12.3g\n", name, 100 * share.last, 100 * share.largest);
}

nlohmann::ordered_json ledger_json(double initial, double in, double out, double now, std::int64_t quanta) {
    return {{"initial_m3", initial},
            {"in_m3", in},
            {"out_m3", out},
            {"now_m3", now},
            {"relative_drift", relative_drift(initial, in, out, now)},
            {"drift_quanta", quanta}};
}

template <class Figure> nlohmann::ordered_json figure_json(const Figure& figure) {
    return {{"last", figure.last}, {"largest", figure.largest}};
}

} // namespace

double relative_drift(double initial, double in, double out, double now) {
    const double scale = initial + in;
    return scale > 0 ? (now - (initial + in - out)) / scale : 0;
}

std::string hash_text(std::uint64_t hash) {
    char text[17];
    std::snprintf(text, sizeof text, "%016" PRIx64, hash);
    return text;
}

void Report::sample(const wadi_world_stats& now) {
    const bool first = stats.struct_size == 0;
    stats = now;
    largest_sand = std::max(largest_sand, now.largest_sand_depth);
    largest_water = std::max(largest_water, now.largest_total_water_depth);
    largest_water_speed = std::max(largest_water_speed, now.largest_water_speed);
    largest_sand_speed = std::max(largest_sand_speed, now.largest_sand_speed);
    smallest_depth = first ? now.smallest_depth : std::min(smallest_depth, now.smallest_depth);
    clamped_faces.sample(now.clamped_faces);
    capped_faces.sample(now.capped_faces);
    limited_cells.sample(now.limited_cells);
    high_columns.sample(now.high_columns);
    not_finite.sample(now.not_finite);
    clamped_water.sample(now.clamped_water_faces, now.wet_faces);
    capped_water.sample(now.capped_water_faces, now.wet_faces);
    clamped_sand.sample(now.clamped_faces - now.clamped_water_faces, now.sand_faces);
    capped_sand.sample(now.capped_faces - now.capped_water_faces, now.sand_faces);
}

double Report::ms_per_step() const { return timed_steps > 0 ? 1e3 * stepping_seconds / static_cast<double>(timed_steps) : 0; }

std::uint64_t Report::passes_per_step() const {
    return info.passes_per_water_step + static_cast<std::uint64_t>(info.substeps) * info.passes_per_sand_substep;
}

std::string format_table(const Report& report) {
    const wadi_world_info& info = report.info;
    const wadi_world_stats& stats = report.stats;
    std::string text;
    append(text, "device    %s: %s%s\n", info.backend, info.device_name, info.exact_float != 0 ? "" : " (not exact in float)");
    append(text, "grid      %d x %d cells of %g m, dt %g s, %d sand substeps\n", info.nx, info.ny, info.dx, info.dt,
           info.substeps);
    append(text, "memory    %.1f bytes per cell, %.1f MiB on the device\n", info.bytes_per_cell,
           static_cast<double>(info.device_bytes) / (1024.0 * 1024.0));
    append(text, "steps     %" PRIu64 " (%.6g s simulated), %.4g ms per step (wall), %" PRIu64 " passes per step\n", stats.steps,
           stats.time, report.ms_per_step(), report.passes_per_step());
    append(text, "time      %.2f s stepping (%.3g times real time), %.2f s in all, %d frames\n", report.stepping_seconds,
           report.stepping_seconds > 0 ? stats.time / report.stepping_seconds : 0.0, report.wall_seconds, report.frames);
    if (report.calm_since)
        append(text, "calm      since %.6g s: nothing faster than %g m/s\n", *report.calm_since, report.calm_speed);
    else if (report.calm_speed > 0)
        append(text, "calm      not yet: at the end water runs at %.3g m/s and sand at %.3g m/s; asked for is %g m/s\n",
               stats.largest_water_speed, stats.largest_sand_speed, report.calm_speed);
    append(text, "beside it %.2f s loading before, %.2f s figures, %.2f s pictures\n", report.loading_seconds,
           report.figures_seconds, report.picture_seconds);

    if (report.clock_readings > 0)
        append(text, "clock     %u MHz while stepping, %u the slowest of %u readings\n", report.clock_last, report.clock_least,
               report.clock_readings);

    if (!report.stages.empty()) {
        double sum = 0;
        for (const wadi_stage_timing& stage : report.stages) sum += stage.milliseconds;
        append(text, "\n  %-36s %12s %12s\n", "stage", "ms per step", "passes");
        for (const wadi_stage_timing& stage : report.stages) {
            append(text, "  %-36.63s %12.4f %12u\n", stage.name, stage.milliseconds, stage.passes);
        }
        append(text, "  %-36s %12.4f\n", "all stages", sum);
    }

    append(text, "\n  %-6s %13s %13s %13s %13s %12s %10s\n", "ledger", "initial [m3]", "in [m3]", "out [m3]", "now [m3]",
           "rel. drift", "quanta");
    append_ledger(text, "water", stats.water_initial, stats.water_in, stats.water_out, stats.water_volume,
                  stats.water_drift_quanta);
    append_ledger(text, "sand", stats.sand_initial, stats.sand_in, stats.sand_out, stats.sand_volume, stats.sand_drift_quanta);
    if (stats.refused > 0) append(text, "  sources could not place %.6g m3 below the declared largest height\n", stats.refused);

    append(text, "\n  %-36s %12s %12s\n", "extreme", "last", "largest");
    append(text, "  %-36s %12.5g %12.5g\n", "depth of water [m]", stats.largest_total_water_depth, report.largest_water);
    append(text, "  %-36s %12.5g %12.5g\n", "depth of sand [m]", stats.largest_sand_depth, report.largest_sand);
    append(text, "  %-36s %12.5g %12.5g\n", "speed of water [m/s]", stats.largest_water_speed, report.largest_water_speed);
    append(text, "  %-36s %12.5g %12.5g\n", "speed of sand [m/s]", stats.largest_sand_speed, report.largest_sand_speed);
    append_count(text, "faces at the velocity clamp", report.clamped_faces);
    append_share(text, "of those with water [%]", report.clamped_water);
    append_share(text, "of those with sand [%]", report.clamped_sand);
    append_count(text, "faces with capped gravity", report.capped_faces);
    append_share(text, "of those with water [%]", report.capped_water);
    append_share(text, "of those with sand [%]", report.capped_sand);
    append_count(text, "cells with limited outflow", report.limited_cells);
    append_count(text, "columns above the largest height", report.high_columns);
    append_count(text, "values that are not finite", report.not_finite);
    append(text, "  %-36s %12.5g (least of all frames)\n", "smallest depth [m]", report.smallest_depth);
    if (stats.tiles > 0)
        append(text, "  %-36s %12llu of %llu (last step)\n", "active tiles", static_cast<unsigned long long>(stats.active_tiles),
               static_cast<unsigned long long>(stats.tiles));
    append(text, "\nhash      %s\n", hash_text(stats.hash).c_str());
    return text;
}

std::string format_summary(const Report& report) {
    const wadi_world_info& info = report.info;
    const wadi_world_stats& stats = report.stats;
    nlohmann::ordered_json json;
    json["level"] = report.level;
    json["completed"] = !report.interrupted && report.fault.empty();
    json["interrupted"] = report.interrupted;
    json["fault"] = report.fault;
    if (report.calm_speed > 0) json["calm_since"] = report.calm_since ? nlohmann::ordered_json(*report.calm_since) : nullptr;
    json["grid"] = {{"nx", info.nx}, {"ny", info.ny}, {"dx", info.dx}, {"dt", info.dt}, {"substeps", info.substeps}};
    json["steps"] = stats.steps;
    json["simulated_seconds"] = stats.time;
    json["wall_seconds"] = report.wall_seconds;
    json["stepping_seconds"] = report.stepping_seconds;
    json["processor_seconds"] = report.processor_seconds;
    json["loading_seconds"] = report.loading_seconds;
    json["figures_seconds"] = report.figures_seconds;
    json["picture_seconds"] = report.picture_seconds;
    json["ms_per_step"] = report.ms_per_step();
    if (report.clock_readings > 0)
        json["gpu_clock"] = {
            {"last_mhz", report.clock_last}, {"slowest_mhz", report.clock_least}, {"readings", report.clock_readings}};
    json["frames"] = report.frames;
    json["stages"] = nlohmann::ordered_json::array();
    for (const wadi_stage_timing& stage : report.stages) {
        json["stages"].push_back({{"name", stage.name}, {"ms", stage.milliseconds}, {"passes", stage.passes}});
    }
    json["ledger"] = {
        {"quantum_m", stats.quantum},
        {"refused_m3", stats.refused},
        {"water",
         ledger_json(stats.water_initial, stats.water_in, stats.water_out, stats.water_volume, stats.water_drift_quanta)},
        {"sand", ledger_json(stats.sand_initial, stats.sand_in, stats.sand_out, stats.sand_volume, stats.sand_drift_quanta)}};
    json["extremes"] = {{"largest_water_m", report.largest_water},
                        {"largest_sand_m", report.largest_sand},
                        {"largest_water_speed_m_per_s", report.largest_water_speed},
                        {"largest_sand_speed_m_per_s", report.largest_sand_speed},
                        {"smallest_depth_m", report.smallest_depth}};
    json["counts"] = {{"clamped_faces", figure_json(report.clamped_faces)},
                      {"capped_faces", figure_json(report.capped_faces)},
                      {"limited_cells", figure_json(report.limited_cells)},
                      {"high_columns", figure_json(report.high_columns)},
                      {"not_finite", figure_json(report.not_finite)}};
    json["shares"] = {{"clamped_water", figure_json(report.clamped_water)},
                      {"capped_water", figure_json(report.capped_water)},
                      {"clamped_sand", figure_json(report.clamped_sand)},
                      {"capped_sand", figure_json(report.capped_sand)}};
    if (stats.tiles > 0) json["active_tiles"] = {{"last_step", stats.active_tiles}, {"of", stats.tiles}};
    json["hash"] = hash_text(stats.hash);
    json["passes"] = {{"per_water_step", info.passes_per_water_step},
                      {"per_sand_substep", info.passes_per_sand_substep},
                      {"per_step", report.passes_per_step()}};
    json["bytes_per_cell"] = info.bytes_per_cell;
    json["device_bytes"] = info.device_bytes;
    json["device"] = {{"backend", info.backend}, {"name", info.device_name}, {"exact_float", info.exact_float != 0}};
    json["warnings"] = report.warnings;
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

} // namespace recorder
