#include "engine/settings/rules/checks.hpp"
#include "engine/settings/data/method_presets.hpp"
#include "engine/settings/data/rain_map.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/effects.hpp"
#include "engine/settings/rules/messages.hpp"
#include "engine/settings/rules/scripted_edits.hpp"
#include "engine/threads/bands.hpp"
#include "shaders/params.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

namespace wadi {
namespace {

constexpr double ABSORB_MOST = 1e6; // [s]
constexpr const char* HEIGHT_LIMIT = " (method.largest_height)";
constexpr double COORDINATE_MOST = double{GRID_MOST} * DX_MOST;

Status refuse(std::string message) { return error(Code::bad_argument, std::move(message)); }

Status check_range(const std::string& path, double value, double least, double most) {
    if (value >= least && value <= most) return ok_status();
    return refuse(outside_text(path, value, least, most));
}

// Of the rows of one object, or of all.
Status check_rows(const Settings& settings, std::optional<std::string_view> object = {}) {
    for (const Setting& row : setting_table()) {
        if (object && row.object() != *object) continue;
        const double value = row.at.get(settings);
        const auto& [least, most, names, among] = row.values;
        if (Status status = check_range(row.path, value, least, most); !status) return status;
        if (among.empty() || std::find(among.begin(), among.end(), static_cast<int>(value)) != among.end()) continue;
        std::string known;
        for (const int one : among) known += (known.empty() ? "" : ", ") + std::to_string(one);
        return refuse(row.path + std::string(": ") + number_text(value) + " is not one of " + known);
    }
    return ok_status();
}

Status check_series(const std::string& path, const TimeSeries& series, double least, double most, const char* limit = "") {
    for (std::size_t n = 0; n < series.samples.size(); ++n) {
        const std::string at = series.samples.size() == 1 ? path : path + "[" + std::to_string(n) + "]";
        const auto [time, value] = series.samples[n];
        if (!std::isfinite(time)) return refuse(at + ": the time is not a finite number");
        if (n > 0 && !(time > series.samples[n - 1].first))
            return refuse(at + ": the time " + number_text(time) + " s does not come after " +
                          number_text(series.samples[n - 1].first) + " s");
        if (!(value >= least && value <= most)) return refuse(outside_text(at, value, least, most) + limit);
    }
    return ok_status();
}

Status check_saturation(const Material& material) {
    double below = 0;
    for (std::size_t n = 0; n < material.saturation.size(); ++n) {
        const double value = material.saturation[n];
        if (!(value - below >= SATURATION_GAP))
            return refuse("material.saturation[" + std::to_string(n) + "]: " + number_text(value) + " must be at least " +
                          number_text(SATURATION_GAP) + " above " +
                          (n == 0 ? "0" : "saturation[" + std::to_string(n - 1) + "], " + number_text(below)));
        below = value;
    }
    return ok_status();
}

Status check_method(const Method& method) {
    const auto& names = method_names();
    if (std::find(names.begin(), names.end(), method.name) == names.end())
        return refuse("method.name: \"" + method.name + "\" is not a method" + suggestion(method.name, names));
    if (method.gravity_cap > 0 && static_cast<float>(method.gravity_cap) < LEAST_GRAVITY_CAP)
        return refuse(outside_text("method.gravity_cap", method.gravity_cap, static_cast<double>(LEAST_GRAVITY_CAP),
                                   find_setting("method.gravity_cap")->values.most) +
                      " (or 0: off)");
    if (method.published() && method.velocity_clamp > PUBLISHED_CLAMP_MOST)
        return refuse(outside_text("method.velocity_clamp", method.velocity_clamp, 0.01, PUBLISHED_CLAMP_MOST) +
                      " (method published looks one cell back)");
    if (method.published() && (method.shock_viscosity > 0 || method.sand_transport_order != 1))
        return refuse("method.name: \"published\" goes only with shock_viscosity 0 and sand_transport_order 1");
    if (method.published() && method.water_substeps != 1)
        return refuse("method.water_substeps: " + number_text(method.water_substeps) +
                      " goes only with method \"robust\"; the paper has one water step");
    if (!method.published() && method.strain_transport != StrainTransport::polar)
        return refuse("method.strain_transport: \"direct\" goes only with method \"published\"");
    if (method.quantum < 0 && method.quantum > -1)
        return refuse("method.quantum: " + number_text(method.quantum) +
                      " is neither -1 (chosen), nor 0 (off), nor a positive height");
    if (method.quantum > 0) {
        int exponent = 0;
        if (std::frexp(method.quantum, &exponent) > 0.5)
            return refuse("method.quantum: " + number_text(method.quantum) + " is not a power of two; the next below is " +
                          number_text(std::ldexp(1.0, exponent - 1)));
        const double least = std::ldexp(method.largest_height, -24);
        if (method.quantum < least || method.quantum > method.largest_height)
            return refuse(outside_text("method.quantum", method.quantum, least, method.largest_height) +
                          " (largest_height / 2^24 ... largest_height)");
    }
    return ok_status();
}

Status check_side(const Settings& settings, std::size_t index) {
    const Side& side = settings.sides[index];
    const std::string path = "sides." + side_names()[index];
    const bool along_y = index == static_cast<std::size_t>(SideName::west) || index == static_cast<std::size_t>(SideName::east);
    const double length = (along_y ? settings.grid.ny : settings.grid.nx) * settings.grid.dx;
    if (!(side.from >= 0 && side.from < length)) return refuse(outside_text(path + ".from", side.from, 0, length));
    if (!(side.to > side.from))
        return refuse(path + ".to: " + number_text(side.to) + " is not greater than from, " + number_text(side.from));
    const bool has_value = side.kind == SideKind::discharge || side.has_level();
    if (has_value == side.value.samples.empty())
        return refuse(path + ".value: " +
                      (has_value ? "missing; discharge in m3/s or level in m" : "only discharge, level and waves have one"));
    const double deepest = side.kind == SideKind::discharge ? settings.method.largest_height : 0;
    if (!(side.depth >= 0 && side.depth <= deepest))
        return refuse(outside_text(path + ".depth", side.depth, 0, deepest) + (deepest > 0 ? "" : "; only a discharge has one"));
    if (!side.wave.samples.empty() && side.kind != SideKind::waves) return refuse(path + ".wave: only waves have one");
    const double steepest = side.kind == SideKind::outflow ? 1 : 0;
    if (!(side.slope >= 0 && side.slope <= steepest))
        return refuse(outside_text(path + ".slope", side.slope, 0, steepest) + (steepest > 0 ? "" : "; only an outflow has one"));
    const double most_load = side.kind == SideKind::wall ? -1 : side.kind == SideKind::discharge ? 10 : 1;
    if (!(side.sediment <= most_load))
        return refuse(outside_text(path + ".sediment", side.sediment, 0, most_load) + (most_load > 0 ? "" : "; a wall has none"));
    const double longest = side.has_level() ? ABSORB_MOST : 0;
    if (!(side.absorb >= 0 && side.absorb <= longest))
        return refuse(outside_text(path + ".absorb", side.absorb, 0, longest) +
                      (longest > 0 ? "" : "; only level and waves have one"));
    const double most = settings.method.largest_height;
    double level = 0; // the highest; the wave stands on it
    for (const auto& [time, value] : side.value.samples) level = side.has_level() ? std::clamp(value, level, most) : 0;
    if (Status status = check_series(path + ".wave", side.wave, -most, most - level, " (method.largest_height less the level)");
        !status)
        return status;
    if (side.kind == SideKind::discharge) {
        // What the critical depth carries through the opening: more would stand above the limit as it enters.
        const double opening = std::min(side.to, length) - side.from;
        const double carried = opening * std::sqrt(settings.gravity * most * most * most);
        const double most_discharge = settings.gravity > 0 ? std::min(DISCHARGE_MOST, carried) : DISCHARGE_MOST;
        return check_series(path + ".value", side.value, 0, most_discharge, " (what enters at the depth method.largest_height)");
    }
    return check_series(path + ".value", side.value, -most, most, HEIGHT_LIMIT);
}

/// "name: ... in cell (i, j)" for the first value outside least ... most; `limit` names where `most` comes from.
Status check_field(const char* name, const std::vector<float>& field, const Grid& grid, double least, double most,
                   const char* limit) {
    const std::size_t cells = static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny);
    if (!field.empty() && field.size() != cells)
        return refuse(std::string(name) + ": " + std::to_string(field.size()) + " values for a grid of " +
                      std::to_string(grid.nx) + " x " + std::to_string(grid.ny));
    const std::size_t wrong = first_cell(field.size(), [&](std::size_t cell) {
        const double value = static_cast<double>(field[cell]);
        return !(value >= least && value <= most);
    });
    if (wrong < field.size()) {
        const double value = static_cast<double>(field[wrong]);
        const auto width = static_cast<std::size_t>(grid.nx);
        return refuse(outside_text(name, value, least, most) + (std::fabs(value) > most ? limit : "") + " in cell (" +
                      std::to_string(wrong % width) + ", " + std::to_string(wrong / width) + ")");
    }
    return ok_status();
}

} // namespace

Status check_source(const Settings& settings, const Source& source, const std::string& path) {
    const double lengths[2] = {settings.grid.nx * settings.grid.dx, settings.grid.ny * settings.grid.dx};
    const bool box = source.shape == SourceShape::box;
    const double reach = source.shape == SourceShape::disc ? source.radius : 0;
    if (source.shape == SourceShape::disc && !(source.radius > 0 && source.radius <= COORDINATE_MOST))
        return refuse(path + ".radius: " + number_text(source.radius) + " is not a positive length");
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const double low = box ? source.box[axis] : source.center[axis];
        const double high = box ? source.box[axis + 2] : low;
        const std::string at = path + (box ? ".from" : ".center") + "[" + std::to_string(axis) + "]";
        if (Status status = check_range(at, low, -COORDINATE_MOST, COORDINATE_MOST); !status) return status;
        if (Status status = check_range(path + ".to[" + std::to_string(axis) + "]", high, -COORDINATE_MOST, COORDINATE_MOST);
            box && !status)
            return status;
        if (box && !(high > low))
            return refuse(path + ".to[" + std::to_string(axis) + "]: " + number_text(high) + " is not greater than from, " +
                          number_text(low));
        if (high + reach < 0 || low - reach >= lengths[axis])
            return refuse(path + ": lies outside the grid, which spans 0 ... " + number_text(lengths[axis]) + " m in " +
                          (axis == 0 ? "x" : "y"));
    }
    const bool holds = !source.level.samples.empty(), rated = !source.rate.samples.empty();
    if (rated && !source.discharge.samples.empty()) return refuse(path + ": give only one of rate and discharge");
    if (!holds && !rated && source.discharge.samples.empty())
        return refuse(path + ".rate: missing; depth per time in m/s, or discharge in m3/s, or a level in m");
    const double share_taken = holds ? 0 : -1; // with a level they are the most that it moves
    if (Status status = check_series(path + ".rate", source.rate, share_taken * RATE_MOST, RATE_MOST); !status) return status;
    if (Status status = check_series(path + ".discharge", source.discharge, share_taken * DISCHARGE_MOST, DISCHARGE_MOST);
        !status)
        return status;
    const double most = settings.method.largest_height;
    if (Status status = check_series(path + ".level", source.level, -most, most, HEIGHT_LIMIT); !status) return status;
    if (source.drain && !holds) return refuse(path + ".drain: only a source with a level has one; a rate below 0 takes away");
    if (holds && source.material != SourceMaterial::water) return refuse(path + ".level: only a source of water holds one");
    if (holds && source.set_velocity) return refuse(path + ".velocity: a source with a level has none");
    if (!source.set_velocity) return ok_status();
    if (source.material != SourceMaterial::water) return refuse(path + ".velocity: only a source of water sets one");
    for (std::size_t axis = 0; axis < 2; ++axis)
        if (Status status =
                check_range(path + ".velocity[" + std::to_string(axis) + "]", source.velocity[axis], -SPEED_MOST, SPEED_MOST);
            !status)
            return status;
    return ok_status();
}

Status validate(const Material& material) {
    Settings settings;
    settings.material = material;
    if (Status status = check_rows(settings, "material"); !status) return status;
    return check_saturation(material);
}

Status validate(const Settings& settings) {
    if (Status status = check_rows(settings); !status) return status;
    if (Status status = check_saturation(settings.material); !status) return status;
    if (Status status = check_method(settings.method); !status) return status;
    for (std::size_t n = 0; n < settings.sides.size(); ++n)
        if (Status status = check_side(settings, n); !status) return status;
    if (settings.sources.size() > MAX_SOURCES)
        return refuse("sources: " + std::to_string(settings.sources.size()) + " are more than " + std::to_string(MAX_SOURCES));
    for (std::size_t n = 0; n < settings.sources.size(); ++n)
        if (Status status = check_source(settings, settings.sources[n], "sources[" + std::to_string(n) + "]"); !status)
            return status;
    if (Status status = check_series("rain", settings.rain, 0, RAIN_MOST); !status) return status;
    if (Status status = check_series("evaporation", settings.evaporation, 0, RAIN_MOST); !status) return status;
    if (settings.edits.size() > EDITS_MOST)
        return refuse("edits: " + std::to_string(settings.edits.size()) + " are more than " + std::to_string(EDITS_MOST));
    for (std::size_t n = 0; n < settings.edits.size(); ++n)
        if (Status status = check_scripted_edit(settings, n); !status) return status;
    if (Status status = check_edits_per_step(settings); !status) return status;
    for (const auto& [name, force] : settings.effects) {
        const auto& names = effect_names();
        if (std::find(names.begin(), names.end(), name) == names.end())
            return refuse("effects." + name + ": unknown effect" + suggestion(name, names));
    }
    return ok_status();
}

Status validate(const InitialFields& fields, const Settings& settings) {
    const Grid& grid = settings.grid;
    const double most = settings.method.largest_height;
    if (Status status = check_field("terrain", fields.terrain, grid, -most, most, HEIGHT_LIMIT); !status) return status;
    if (Status status = check_field("sand", fields.sand, grid, 0, most, HEIGHT_LIMIT); !status) return status;
    if (Status status = check_field("water", fields.water, grid, 0, most, HEIGHT_LIMIT); !status) return status;
    const std::pair<const char*, const std::vector<float>*> velocities[] = {{"velocity_x", &fields.velocity_x},
                                                                            {"velocity_y", &fields.velocity_y},
                                                                            {"sand_velocity_x", &fields.sand_velocity_x},
                                                                            {"sand_velocity_y", &fields.sand_velocity_y}};
    for (const auto& [name, field] : velocities)
        if (Status status = check_field(name, *field, grid, -SPEED_MOST, SPEED_MOST, ""); !status) return status;
    if (Status status = check_field("roughness", settings.roughness, grid, 0, MANNING_MOST, ""); !status) return status;
    if (Status status = check_field("rain_map", settings.rain_map, grid, 0, RAIN_TIMES_MOST, ""); !status) return status;
    double most_rain = 0;
    for (const auto& [time, rate] : settings.rain.samples) most_rain = std::max(most_rain, rate);
    if (const double times = rain_peak(settings); most_rain * times > RAIN_MOST)
        return refuse("rain_map: " + number_text(times) + " times rain, " + number_text(most_rain) + " m/s, is above " +
                      number_text(RAIN_MOST) + " m/s");

    const std::size_t cells = static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny);
    const auto column = [&](std::size_t cell) {
        double height = 0;
        for (const std::vector<float>* part : {&fields.terrain, &fields.sand, &fields.water})
            if (!part->empty()) height += static_cast<double>((*part)[cell]);
        return height;
    };
    const std::size_t highest = first_cell(cells, [&](std::size_t cell) { return !(column(cell) <= most); });
    if (highest < cells) {
        const auto width = static_cast<std::size_t>(grid.nx);
        return refuse("the column of terrain, sand and water in cell (" + std::to_string(highest % width) + ", " +
                      std::to_string(highest / width) + ") is " + number_text(column(highest)) +
                      " m high, above method.largest_height, " + number_text(most) + " m");
    }
    return ok_status();
}

} // namespace wadi
