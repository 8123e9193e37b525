#include "level.hpp"
#include "../common/files.hpp"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <tuple>
#include <wadi/wadi.h>

namespace import_map {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct World {
    wadi_world_id id{};
    ~World() { wadi_destroy_world(id); }
};

wadi_device_options on_cpu() {
    wadi_device_options options = wadi_default_device_options();
    options.backend = "cpu";
    return options;
}

Ground take(const World& world) {
    wadi_world_info info = wadi_default_world_info();
    if (wadi_world_get_info(world.id, &info) != WADI_OK) fail(wadi_get_last_error());
    Ground ground{info.nx, info.ny, info.dx, {info.origin_x, info.origin_y}, {}, {}};
    ground.heights.resize(static_cast<std::size_t>(info.nx) * static_cast<std::size_t>(info.ny));
    if (wadi_world_read_field(world.id, WADI_FIELD_TERRAIN, ground.heights.data(), ground.heights.size()) != WADI_OK)
        fail(wadi_get_last_error());
    for (std::uint32_t n = 0; n < info.warning_count; ++n) ground.warnings.emplace_back(wadi_world_get_warning(world.id, n));
    return ground;
}

wadi_bool read_beside(void* folder, const char* name, void* data, std::size_t* size) {
    std::ifstream file(*static_cast<const fs::path*>(folder) / name, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    if (!file && bytes.empty()) return 0;
    if (data != nullptr) std::memcpy(data, bytes.data(), std::min(*size, bytes.size()));
    *size = bytes.size();
    return 1;
}

Json layer_of(const Request& request, const std::string& file, const Ground& grid, const std::string& holes, bool grey) {
    Json layer = {{"file", file}};
    if (request.size) layer["size"] = {request.size->first, request.size->second};
    if (!request.samples.empty()) layer["samples"] = request.samples;
    if (!request.packed.empty()) layer["packed"] = request.packed;
    if (!request.flip.empty()) layer["flip"] = request.flip;
    if (holes != "filled") layer["holes"] = holes;
    if (grey) {
        layer["min"] = request.black.value_or(0);
        layer["max"] = request.white.value_or(grid.dx * std::max(grid.nx, grid.ny) / 8); // as --terrain
    }
    return layer;
}

Json grid_of(const Ground& grid) { return {{"nx", grid.nx}, {"ny", grid.ny}, {"dx", grid.dx}}; }

/// Whether the library could make a world of the map's terrain alone, unrounded.
bool try_level(const Request& request, const Ground& grid, const Json& layer, World& world) {
    const Json level = {{"format_version", 1},
                        {"name", request.map},
                        {"grid", grid_of(grid)},
                        {"dt", 0.02 * grid.dx},
                        {"terrain", {layer}},
                        {"origin", {grid.origin[0], grid.origin[1]}},
                        {"method", {{"quantum", 0}, {"largest_height", 1e6}}}};
    const wadi_device_options options = on_cpu();
    fs::path folder = request.folder;
    return wadi_create_world_from_level_text(level.dump().c_str(), read_beside, &folder, nullptr, &options, &world.id) == WADI_OK;
}

bool holds_grey(const Request& request, const std::string& file, const Ground& grid) {
    World world;
    const Json layer = layer_of(request, file, grid, "filled", false);
    return !try_level(request, grid, layer, world) && std::strstr(wadi_get_last_error(), "holds grey values") != nullptr;
}

bool mentions(const std::vector<std::string>& texts, const char* words) {
    return std::any_of(texts.begin(), texts.end(),
                       [&](const std::string& text) { return text.find(words) != std::string::npos; });
}

} // namespace

Ground look_at(const Request& request, const std::string& file) {
    Ground grid;
    bool corners = false; // in the library's eyes
    if (request.size) {
        std::tie(grid.nx, grid.ny) = *request.size;
    } else {
        World world;
        const wadi_device_options options = on_cpu();
        if (wadi_create_world_from_level((request.folder / file).string().c_str(), nullptr, &options, &world.id) != WADI_OK)
            fail(wadi_get_last_error());
        grid = take(world);
        corners = mentions(grid.warnings, "taken for the corners of cells");
    }
    const bool wanted = request.samples.empty() ? corners : request.samples == "corners";
    if (wanted != corners) {
        const int more = wanted ? -1 : 1;
        grid.nx += more;
        grid.ny += more;
        for (double& at : grid.origin) at -= more * grid.dx / 2;
    }
    if (request.cell) grid.dx = *request.cell;
    return grid;
}

Ground ground_of(const Request& request, const std::string& file, const Ground& grid, const std::string& holes) {
    World world;
    const Json layer = layer_of(request, file, grid, holes, holds_grey(request, file, grid));
    if (!try_level(request, grid, layer, world)) fail(wadi_get_last_error());
    return take(world);
}

void write_level(const Request& request, const std::string& file, const Ground& ground) {
    const auto [low, high] = std::minmax_element(ground.heights.begin(), ground.heights.end());
    const double reach = std::max(static_cast<double>(*high), -static_cast<double>(*low));
    const double largest = std::exp2(std::ceil(std::log2(std::max(reach * 1.5, reach + 8))));
    const double duration = 60 * ground.dx, rain = 0.15 * std::min(ground.dx, 1.0) / (duration / 2);
    const Json outflow = {{"kind", "outflow"}};
    const Json level = {{"format_version", 1},
                        {"name", fs::path(request.map).stem().string()},
                        {"description", "Rain on an imported map, which leaves over the sides."},
                        {"grid", grid_of(ground)},
                        {"origin", {ground.origin[0], ground.origin[1]}},
                        {"dt", 0.02 * ground.dx},
                        {"duration", duration},
                        {"method", {{"largest_height", largest}, {"dry_threshold", std::max(1e-5, largest / 16777216)}}},
                        {"material", {{"manning", 0.03}}},
                        {"rain", {{0, rain}, {duration / 2, rain}, {duration / 2 * (1 + 1e-6), 0}}},
                        {"sides", {{"west", outflow}, {"east", outflow}, {"south", outflow}, {"north", outflow}}},
                        {"terrain", {layer_of(request, file, ground, request.holes, holds_grey(request, file, ground))}}};
    if (const std::string error = common::write_file(request.folder / "level.json", level.dump(2) + "\n"); !error.empty())
        fail(error);
}

} // namespace import_map
