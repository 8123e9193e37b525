// A case as a level file, so that whoever gets it can open it in the recorder and the viewer.
#include "engine/level/level.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "tests/fuzz/fuzz_case.hpp"
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace wadi::fuzz {

namespace {

using Json = nlohmann::ordered_json;

Json series(const TimeSeries& s) { return s.samples.front().second; } // cases have constant ones alone

// NumPy format 1: float32, C order, row 0 in the south.
bool write_npy(const std::string& path, const std::vector<float>& values, const Grid& grid) {
    std::string header =
        "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(grid.ny) + ", " + std::to_string(grid.nx) + "), }";
    header.resize((header.size() + 10 + 1 + 63) / 64 * 64 - 10 - 1, ' ');
    header += '\n';
    std::ofstream out(path, std::ios::binary);
    const char start[] = {
        '\x93', 'N', 'U', 'M', 'P', 'Y', 1, 0, static_cast<char>(header.size() & 255), static_cast<char>(header.size() >> 8)};
    out.write(start, sizeof start);
    out << header;
    out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)));
    return static_cast<bool>(out);
}

Json value_of(const Setting& row, const Settings& s) {
    const double value = row.at.get(s);
    if (row.at.kind == SettingKind::number) return value;
    if (row.at.kind == SettingKind::flag) return value != 0;
    if (row.at.kind == SettingKind::choice) return row.values.names[static_cast<std::size_t>(value)];
    return static_cast<int>(value);
}

// What is not the default; of a method that a preset chose every number, for the preset's differ from the default.
void write_rows(Json& json, const Settings& s) {
    const bool preset = s.method.name != Method().name;
    if (preset) json["method"]["name"] = s.method.name;
    for (const Setting& row : setting_table()) {
        const bool needed = row.required() || row.at.get(s) != row.normal() || (preset && row.object() == "method");
        if (row.element() || !needed) continue;
        (row.object().empty() ? json : json[std::string(row.object())])[std::string(row.key())] = value_of(row, s);
    }
    if (s.material.saturation != Material().saturation) json["material"]["saturation"] = s.material.saturation;
}

Json source_of(const Source& source) {
    Json json;
    json["shape"] = source.shape == SourceShape::point ? "point" : source.shape == SourceShape::disc ? "disc" : "box";
    json["material"] = source.material == SourceMaterial::water ? "water" : "sand";
    if (source.shape == SourceShape::box) {
        json["from"] = {source.box[0], source.box[1]};
        json["to"] = {source.box[2], source.box[3]};
    } else {
        json["center"] = source.center;
    }
    if (source.shape == SourceShape::disc) json["radius"] = source.radius;
    if (!source.rate.samples.empty()) json["rate"] = series(source.rate);
    if (!source.discharge.samples.empty()) json["discharge"] = series(source.discharge);
    if (!source.level.samples.empty()) json["level"] = series(source.level);
    if (source.drain) json["drain"] = true;
    if (source.set_velocity) json["velocity"] = source.velocity;
    return json;
}

Json edit_of(const Edit& edit, double dt) {
    Json json;
    json["time"] = static_cast<double>(edit.step) * dt;
    json["shape"] = edit.capsule ? "capsule" : "disc";
    if (edit.capsule) {
        json["from"] = {edit.x0, edit.y0};
        json["to"] = {edit.x1, edit.y1};
    } else {
        json["center"] = {edit.x0, edit.y0};
    }
    json["radius"] = edit.radius;
    json["softness"] = edit.softness;
    if (edit.kind == EditKind::push) {
        json["kind"] = "push";
        json["strength"] = edit.strength;
        json["velocity"] = {edit.velocity_x, edit.velocity_y};
    } else {
        json["layer"] = edit.layer == EditLayer::terrain ? "terrain" : edit.layer == EditLayer::sand ? "sand" : "water";
        json["amount"] = edit.amount;
    }
    return json;
}

// By their names in a level.
std::vector<std::pair<std::string, const std::vector<float>*>> maps_of(const Case& c) {
    const auto& f = c.scene.fields;
    return {{"terrain", &f.terrain},
            {"sand", &f.sand},
            {"water", &f.water},
            {"roughness", &c.scene.settings.roughness},
            {"rain_map", &c.scene.settings.rain_map}};
}

Json level_of(const Case& c) {
    const auto& s = c.scene.settings;
    const auto& f = c.scene.fields;
    Json json;
    json["format_version"] = 1;
    json["name"] = "fuzz " + std::to_string(c.seed);
    write_rows(json, s);
    json["duration"] = c.steps * s.dt;
    for (const auto& [name, field] : maps_of(c))
        if (!field->empty()) json[name] = Json::array({{{"file", name + ".npy"}}});
    Json velocities = Json::array();
    const auto velocity = [&](const char* of, const std::vector<float>& x, const std::vector<float>& y) {
        if (!x.empty())
            velocities.push_back(
                {{"of", of}, {"shape", "plane"}, {"velocity", {static_cast<double>(x[0]), static_cast<double>(y[0])}}});
    };
    velocity("water", f.velocity_x, f.velocity_y);
    velocity("sand", f.sand_velocity_x, f.sand_velocity_y);
    if (!velocities.empty()) json["velocities"] = velocities;
    for (std::size_t n = 0; n < 4; ++n) {
        const Side& side = s.sides[n];
        if (side.kind == SideKind::wall) continue;
        Json& to = json["sides"][side_names()[n]];
        const char* kinds[] = {"wall", "discharge", "level", "outflow", "brink", "waves"};
        to["kind"] = kinds[static_cast<std::size_t>(side.kind)];
        if (!side.value.samples.empty()) to["value"] = series(side.value);
        if (side.depth > 0) to["depth"] = side.depth;
        if (!side.wave.samples.empty()) to["wave"] = series(side.wave);
        if (side.slope > 0) to["slope"] = side.slope;
        if (side.sediment >= 0) to["sediment"] = side.sediment;
        if (side.absorb > 0) to["absorb"] = side.absorb;
        if (side.from > 0) to["from"] = side.from;
        if (side.to < 1e29) to["to"] = side.to;
    }
    for (const auto& source : s.sources) json["sources"].push_back(source_of(source));
    if (!s.rain.samples.empty()) json["rain"] = series(s.rain);
    if (!s.evaporation.samples.empty()) json["evaporation"] = series(s.evaporation);
    for (const auto& [name, force] : s.effects) json["effects"][name] = force == Force::off ? "off" : "on";
    for (const auto& edit : c.commands) json["edits"].push_back(edit_of(edit, s.dt));
    return json;
}

} // namespace

Status write_level(const Case& c, const std::string& folder) {
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    bool good = !failure;
    for (const auto& [name, field] : maps_of(c))
        if (!field->empty()) good = good && write_npy(folder + "/" + name + ".npy", *field, c.scene.settings.grid);
    std::ofstream out(folder + "/level.json");
    out << level_of(c).dump(2) << "\n";
    return good && out ? ok_status() : error(Code::not_found, "'" + folder + "' cannot be written to");
}

Result<Case> read_level(const std::string& path) {
    auto level = load_level(path, {});
    if (!level) return level.status();
    Case c;
    c.scene.settings = level->settings;
    c.scene.fields = level->fields;
    c.steps = std::max(1, static_cast<int>(std::lround(level->duration / level->settings.dt)));
    for (const auto& script : level->settings.edits) {
        c.commands.push_back(script.edit);
        c.commands.back().step = static_cast<std::uint64_t>(std::llround(script.time / level->settings.dt));
    }
    c.scene.settings.edits.clear();
    return c;
}

} // namespace wadi::fuzz
