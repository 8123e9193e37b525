#include "level_writer.hpp"
#include "../common/files.hpp"
#include "springs.hpp"
#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace viewer {
namespace {

using Json = nlohmann::ordered_json;

std::vector<float> read_whole(const Simulation& simulation, wadi_field field) {
    std::vector<float> values(static_cast<std::size_t>(simulation.info.nx) * static_cast<std::size_t>(simulation.info.ny));
    check(wadi_world_read_field(simulation.world, field, values.data(), values.size()), "reading the world");
    return values;
}

void write_whole(const std::filesystem::path& file, const std::string& bytes) {
    const std::string error = common::write_file(file, bytes);
    if (!error.empty()) throw std::runtime_error("writing the level: " + error);
}

/// A number of a list, "saturation[0]", into that list.
void set_number(Json& material, const std::string& name, double value) {
    const std::size_t bracket = name.find('[');
    if (bracket == std::string::npos) {
        material[name] = value;
        return;
    }
    Json& list = material[name.substr(0, bracket)];
    if (!list.is_array()) list = Json::array();
    const std::size_t n = std::stoul(name.substr(bracket + 1));
    while (list.size() <= n) list.push_back(0.0);
    list[n] = value;
}

} // namespace

void write_level(const Simulation& simulation, const SimulationChoice& choice, const std::string& text,
                 const std::filesystem::path& folder) {
    Json level =
        text.empty() ? Json({{"format_version", 1}, {"name", simulation.info.name}}) : Json::parse(text, nullptr, true, true);
    if (!choice.variant.empty()) level.merge_patch(Json(level["variants"][choice.variant]));
    for (const char* gone : {"$schema", "variants", "accuracy", "fine_grid", "velocities", "terrain", "sand", "water"})
        level.erase(gone);
    level["grid"] = {{"nx", simulation.info.nx}, {"ny", simulation.info.ny}, {"dx", simulation.info.dx}};
    level["dt"] = simulation.info.dt;
    level["method"]["substeps"] = simulation.info.substeps;
    if (choice.accuracy == "accurate") level["method"]["water_transport_order"] = 2;
    if (!choice.method.empty()) level["method"]["name"] = choice.method;

    uint32_t count = 0;
    check(wadi_world_get_material(simulation.world, nullptr, &count), "the material");
    std::vector<wadi_material_info> material(count);
    check(wadi_world_get_material(simulation.world, material.data(), &count), "the material");
    double porosity = 1;
    for (const wadi_material_info& info : material) {
        set_number(level["material"], info.name, info.value);
        if (std::string(info.name) == "porosity") porosity = info.value;
    }

    std::filesystem::create_directories(folder);
    const auto map = [&](const char* name, const std::vector<float>& values) {
        const std::string file = std::string(name) + ".npy";
        write_whole(folder / file, common::encode_npy(values, simulation.info.nx, simulation.info.ny));
        return Json({{"file", file}, {"samples", "cells"}});
    };
    const std::vector<float> sand = read_whole(simulation, WADI_FIELD_SAND_DEPTH);
    std::vector<float> water = read_whole(simulation, WADI_FIELD_TOTAL_WATER_DEPTH);
    for (std::size_t n = 0; n < water.size(); ++n) { // a level's depth is that at which the water stands
        const double held = porosity * static_cast<double>(sand[n]), depth = static_cast<double>(water[n]);
        water[n] = static_cast<float>(depth <= held ? depth / porosity : static_cast<double>(sand[n]) + depth - held);
    }
    level["terrain"] = Json::array({map("terrain", read_whole(simulation, WADI_FIELD_TERRAIN))});
    level["sand"] = Json::array({map("sand", sand)});
    level["water"] = Json::array({map("water", water)});
    level["velocities"] = Json::array();
    const std::tuple<const char*, const char*, wadi_field> components[] = {{"water", "x", WADI_FIELD_WATER_VELOCITY_X},
                                                                           {"water", "y", WADI_FIELD_WATER_VELOCITY_Y},
                                                                           {"sand", "x", WADI_FIELD_SAND_VELOCITY_X},
                                                                           {"sand", "y", WADI_FIELD_SAND_VELOCITY_Y}};
    for (const auto& [of, component, field] : components) {
        Json entry = {{"of", of}, {"component", component}};
        entry.update(map((std::string(of) + "_" + component).c_str(), read_whole(simulation, field)));
        level["velocities"].push_back(entry);
    }
    for (const Spring& spring : list_springs(simulation, static_cast<uint32_t>(simulation.info.source_count))) {
        if (spring.rate == 0) continue;
        level["sources"].push_back({{"shape", "disc"},
                                    {"center", {spring.middle.x, spring.middle.y}},
                                    {"radius", spring.radius},
                                    {"material", spring.sand ? "sand" : "water"},
                                    {"rate", spring.rate}});
    }
    write_whole(folder / "level.json", level.dump(4) + "\n");
}

} // namespace viewer
