// A case as a level file, so that whoever gets it can open it in the recorder and the viewer.
#include "engine/level/level.hpp"
#include "engine/settings/setting_fields.hpp"
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

template <class Owner, class Table> void write_changed(Json& to, const Owner& owner, const Table& table) {
    const Owner normal;
    for (const auto& field : table)
        if (owner.*field.member != normal.*field.member) to[field.name] = owner.*field.member;
}

Json method_of(const Method& m) {
    Json json;
    if (m.name != Method().name) json["name"] = m.name;
    // Every number: what a preset chose may differ from the default.
    for (const auto& field : METHOD_FIELDS)
        if (m.name != Method().name || m.*field.member != Method().*field.member) json[field.name] = m.*field.member;
    for (const auto& field : METHOD_COUNTS)
        if (m.name != Method().name || m.*field.member != Method().*field.member) json[field.name] = m.*field.member;
    if (!m.outflow_limiter) json["outflow_limiter"] = false;
    if (m.half_storage) json["half_storage"] = true;
    const auto name = [](const std::vector<std::string>& names, auto value) { return names[static_cast<std::size_t>(value)]; };
    const Method normal;
    if (m.velocity_transport != normal.velocity_transport)
        json["velocity_transport"] = name(velocity_transport_names(), m.velocity_transport);
    if (m.strain_transport != normal.strain_transport)
        json["strain_transport"] = name(strain_transport_names(), m.strain_transport);
    if (m.drag_friction != normal.drag_friction) json["drag_friction"] = name(drag_friction_names(), m.drag_friction);
    if (m.diffusion != normal.diffusion) json["diffusion"] = name(diffusion_names(), m.diffusion);
    return json;
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
    json["rate"] = series(source.rate);
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

Json level_of(const Case& c) {
    const auto& s = c.scene.settings;
    const auto& f = c.scene.fields;
    Json json;
    json["format_version"] = 1;
    json["name"] = "fuzz " + std::to_string(c.seed);
    json["grid"] = {{"nx", s.grid.nx}, {"ny", s.grid.ny}, {"dx", s.grid.dx}};
    json["dt"] = s.dt;
    json["duration"] = c.steps * s.dt;
    if (s.gravity != Settings().gravity) json["gravity"] = s.gravity;
    for (const auto& [name, field] : {std::pair{"terrain", &f.terrain}, {"sand", &f.sand}, {"water", &f.water}})
        if (!field->empty()) json[name] = Json::array({{{"file", std::string(name) + ".npy"}}});
    Json velocities = Json::array();
    const auto velocity = [&](const char* of, const std::vector<float>& x, const std::vector<float>& y) {
        if (!x.empty())
            velocities.push_back(
                {{"of", of}, {"shape", "plane"}, {"velocity", {static_cast<double>(x[0]), static_cast<double>(y[0])}}});
    };
    velocity("water", f.velocity_x, f.velocity_y);
    velocity("sand", f.sand_velocity_x, f.sand_velocity_y);
    if (!velocities.empty()) json["velocities"] = velocities;
    Json material;
    write_changed(material, s.material, MATERIAL_FIELDS);
    if (s.material.saturation != Material().saturation) material["saturation"] = s.material.saturation;
    if (!material.is_null()) json["material"] = material;
    if (const Json method = method_of(s.method); !method.is_null()) json["method"] = method;
    for (std::size_t n = 0; n < 4; ++n) {
        const Side& side = s.sides[n];
        if (side.kind == SideKind::wall) continue;
        Json& to = json["sides"][side_names()[n]];
        to["kind"] = side.kind == SideKind::discharge ? "discharge" : side.kind == SideKind::level ? "level" : "outflow";
        if (!side.value.samples.empty()) to["value"] = series(side.value);
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
    const auto& f = c.scene.fields;
    bool good = !failure;
    for (const auto& [name, field] : {std::pair{"terrain", &f.terrain}, {"sand", &f.sand}, {"water", &f.water}})
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
