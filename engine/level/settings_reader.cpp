#include "engine/level/settings_reader.hpp"
#include "engine/settings/data/method_presets.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/effects.hpp"
#include <cstddef>

namespace wadi {
namespace {

constexpr std::size_t SOURCES_READ = 1000; // more than a world holds; validate() names the limit

// The keys of one object that are settings of their own, as they stand in the table.
void read_rows(ObjectReader& reader, std::string_view object, Settings& settings) {
    for (const Setting& row : setting_table()) {
        if (row.object() != object || row.element()) continue;
        const std::string key(row.key());
        const auto& [least, most, names, among] = row.values;
        double value = row.at.get(settings);
        if (row.required()) reader.require(key.c_str());
        if (row.at.kind == SettingKind::number) {
            reader.number(key.c_str(), value, least, most);
        } else if (row.at.kind == SettingKind::flag) {
            bool flag = value != 0;
            reader.boolean(key.c_str(), flag);
            value = flag ? 1 : 0;
        } else {
            int whole = static_cast<int>(value);
            if (row.at.kind == SettingKind::choice)
                reader.choice(key.c_str(), {names.begin(), names.end()}, whole);
            else
                reader.whole_number(key.c_str(), whole, static_cast<int>(least), static_cast<int>(most));
            value = whole;
        }
        row.at.set(settings, value);
    }
}

void read_grid(const Json& value, Settings& settings, Status& status) {
    ObjectReader reader(value, "grid", status);
    read_rows(reader, "grid", settings);
    reader.finish();
}

void read_material(const Json& value, Settings& settings, Status& status) {
    ObjectReader reader(value, "material", status);
    read_rows(reader, "material", settings);
    if (const Json* saturation = reader.find("saturation")) {
        const auto elements = read_array(*saturation, "material.saturation", 3, status);
        if (elements.size() != 3) reader.fail("saturation", "expected three numbers [phi1, phi2, phi3]");
        for (std::size_t n = 0; n < elements.size(); ++n) {
            const Setting& row = *find_setting("material.saturation[" + std::to_string(n) + "]");
            row.at.set(settings, read_number(*elements[n], row.path, row.values.least, row.values.most, status));
        }
    }
    reader.finish();
}

void read_method(const Json& value, Settings& settings, Status& status) {
    ObjectReader reader(value, "method", status);
    std::string name = settings.method.name;
    reader.string("name", name);
    choose_method(settings, name); // the other keys change what the preset chose
    read_rows(reader, "method", settings);
    reader.finish();
}

void read_surface(const Json& value, Settings& settings, Status& status) {
    ObjectReader reader(value, "surface", status);
    read_rows(reader, "surface", settings);
    reader.finish();
}

void read_sides(const Json& value, LevelFiles& files, std::array<Side, 4>& sides, Status& status) {
    ObjectReader reader(value, "sides", status);
    for (std::size_t n = 0; n < sides.size(); ++n) {
        const Json* found = reader.find(side_names()[n].c_str());
        if (found == nullptr || !status) continue;
        Side& side = sides[n];
        const std::string path = "sides." + side_names()[n];
        ObjectReader side_reader(*found, path, status);
        int kind = 0;
        side_reader.require("kind");
        side_reader.choice("kind", {"wall", "discharge", "level", "outflow", "brink", "waves"}, kind);
        side.kind = static_cast<SideKind>(kind);
        side_reader.number("from", side.from, 0, ANY_NUMBER);
        side_reader.number("to", side.to, 0, ANY_NUMBER);
        side_reader.number("depth", side.depth, 0, ANY_NUMBER);
        side_reader.number("slope", side.slope, 0, ANY_NUMBER);
        side_reader.number("sediment", side.sediment, 0, ANY_NUMBER);
        side_reader.number("absorb", side.absorb, 0, ANY_NUMBER);
        if (const Json* series = side_reader.find("wave")) side.wave = read_series(*series, path + ".wave", files, status);
        if (const Json* series = side_reader.find("value")) side.value = read_series(*series, path + ".value", files, status);
        side_reader.finish();
    }
    reader.finish();
}

Source read_source(const Json& value, const std::string& path, LevelFiles& files, Status& status) {
    Source source;
    ObjectReader reader(value, path, status);
    int shape = static_cast<int>(SourceShape::disc);
    reader.require("shape");
    reader.choice("shape", {"point", "disc", "box"}, shape);
    source.shape = static_cast<SourceShape>(shape);
    int material = 0;
    reader.choice("material", {"water", "sand"}, material);
    source.material = static_cast<SourceMaterial>(material);
    if (source.shape == SourceShape::box) {
        std::array<double, 2> from = {0, 0};
        std::array<double, 2> to = {0, 0};
        reader.require("from");
        reader.require("to");
        reader.pair("from", from, -ANY_NUMBER, ANY_NUMBER);
        reader.pair("to", to, -ANY_NUMBER, ANY_NUMBER);
        source.box = {from[0], from[1], to[0], to[1]};
    } else {
        reader.require("center");
        reader.pair("center", source.center, -ANY_NUMBER, ANY_NUMBER);
    }
    if (source.shape == SourceShape::disc) {
        reader.require("radius");
        reader.number("radius", source.radius, 0, ANY_NUMBER);
    }
    if (const Json* rate = reader.find("rate")) source.rate = read_series(*rate, path + ".rate", files, status);
    if (const Json* discharge = reader.find("discharge"))
        source.discharge = read_series(*discharge, path + ".discharge", files, status);
    if (const Json* level = reader.find("level")) source.level = read_series(*level, path + ".level", files, status);
    reader.boolean("drain", source.drain);
    source.set_velocity = reader.find("velocity") != nullptr;
    reader.pair("velocity", source.velocity, -SPEED_MOST, SPEED_MOST);
    reader.finish();
    return source;
}

void read_effects(const Json& value, Settings& settings, Status& status) {
    ObjectReader reader(value, "effects", status);
    for (const std::string& name : effect_names()) {
        if (reader.find(name.c_str()) == nullptr) continue;
        int force = 0;
        reader.choice(name.c_str(), {"auto", "on", "off"}, force);
        settings.effects.emplace_back(name, static_cast<Force>(force));
    }
    reader.finish();
}

} // namespace

void read_settings(ObjectReader& root, LevelFiles& files, Settings& settings) {
    Status& status = root.status();
    if (const Json* grid = root.require("grid")) read_grid(*grid, settings, status);
    read_rows(root, "", settings);
    if (const Json* method = root.find("method")) read_method(*method, settings, status);
    if (const Json* material = root.find("material")) read_material(*material, settings, status); // over the method's choice
    if (const Json* surface = root.find("surface")) read_surface(*surface, settings, status);
    if (const Json* sides = root.find("sides")) read_sides(*sides, files, settings.sides, status);
    if (const Json* sources = root.find("sources")) {
        const auto elements = read_array(*sources, "sources", SOURCES_READ, status);
        for (std::size_t n = 0; n < elements.size() && status; ++n)
            settings.sources.push_back(read_source(*elements[n], "sources[" + std::to_string(n) + "]", files, status));
    }
    if (const Json* rain = root.find("rain")) settings.rain = read_series(*rain, "rain", files, status);
    if (const Json* evaporation = root.find("evaporation"))
        settings.evaporation = read_series(*evaporation, "evaporation", files, status);
    if (const Json* edits = root.find("edits")) settings.edits = read_edits(*edits, status);
    if (const Json* effects = root.find("effects")) read_effects(*effects, settings, status);
}

} // namespace wadi
