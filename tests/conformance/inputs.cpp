#include "tests/conformance/inputs.hpp"
#include "engine/settings/rules/checks.hpp"
#include "engine/settings/rules/effects.hpp"
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>

namespace wadi::conformance {

namespace {

constexpr double PI = 3.14159265358979323846;

constexpr std::array grids = {"33x17", "1x1", "1x9", "9x1", "63x5", "64x4", "65x3", "70x50"};
constexpr std::array scenes = {"random", "dam_break",    "lake",      "cliff", "islands", "slope",
                               "flat",   "one_wet_cell", "thin_film", "deep",  "creep",   "brimful"};
constexpr std::array methods = {"default", "plain", "bare", "unsmoothed", "coarse", "porous"};

// Position in a scene: metres are x, y; u, v run from 0 to 1, s along the longer axis.
struct Place {
    int i, j;
    double u, v, s;
};

void fill(const Grid& grid, std::vector<float>& field, const std::function<double(const Place&)>& value) {
    field.clear();
    for (int j = 0; j < grid.ny; ++j) {
        for (int i = 0; i < grid.nx; ++i) {
            const double u = (i + 0.5) / grid.nx, v = (j + 0.5) / grid.ny;
            field.push_back(static_cast<float>(value({i, j, u, v, grid.nx >= grid.ny ? u : v})));
        }
    }
}

double noise(std::uint32_t seed, const Place& p) { return static_cast<double>(band_limited(seed, p.i, p.j)); }

// Random velocities of water and sand, at most `water` and `sand` m/s.
void stir(Scene& scene, double water, double sand) {
    const auto& grid = scene.settings.grid;
    fill(grid, scene.fields.velocity_x, [&](const Place& p) { return water * noise(11, p); });
    fill(grid, scene.fields.velocity_y, [&](const Place& p) { return water * noise(12, p); });
    fill(grid, scene.fields.sand_velocity_x, [&](const Place& p) { return sand * noise(13, p); });
    fill(grid, scene.fields.sand_velocity_y, [&](const Place& p) { return sand * noise(14, p); });
}

using Fields = std::array<double, 3>; // terrain, sand, water [m]

void fill_heights(Scene& scene, const std::function<Fields(const Place&)>& at) {
    const auto& grid = scene.settings.grid;
    fill(grid, scene.fields.terrain, [&](const Place& p) { return at(p)[0]; });
    fill(grid, scene.fields.sand, [&](const Place& p) { return at(p)[1]; });
    fill(grid, scene.fields.water, [&](const Place& p) { return at(p)[2]; });
}

void make_deep(Scene& scene) {
    auto& s = scene.settings;
    s.grid.dx = 100;
    s.dt = 0.4;
    s.method.largest_height = 1024;
    s.material.young_modulus = 1e8;
    s.material.cohesion_dry = s.material.cohesion_wet = s.material.cohesion_capillary = 1e5;
    s.material.sand_viscosity = 10;
    fill_heights(scene, [](const Place& p) {
        return Fields{20 + 15 * noise(1, p), std::max(0.0, 40 + 30 * noise(2, p)),
                      800 + 60 * std::sin(2 * PI * p.u) * std::cos(3 * p.v)};
    });
    stir(scene, 2, 0.2);
}

// Depths on both sides of the dry threshold, and exactly on it where heights are plain floats.
void make_thin_film(Scene& scene) {
    const double eps = scene.settings.method.dry_threshold, quantum = height_quantum(scene.settings.method);
    const auto depth = [&](int n) { return quantum > 0 ? n * quantum : n == 12 ? eps : eps * n / 12.5; };
    fill_heights(scene, [&](const Place& p) {
        return Fields{0.01 * p.s, depth((p.i * 7 + p.j * 3) % 24), depth((p.i * 5 + p.j * 11 + 2) % 25)};
    });
    stir(scene, 0.3, 0.1);
    scene.rough_stretch = true;
}

bool make_heights(Scene& scene) {
    const auto& grid = scene.settings.grid;
    const std::string& name = scene.name;
    if (name == "flat") {
        fill_heights(scene, [](const Place&) { return Fields{0.5, 0.25, 0.6}; });
        fill(grid, scene.fields.velocity_x, [](const Place&) { return 0.4; });
        fill(grid, scene.fields.velocity_y, [](const Place&) { return -0.3; });
    } else if (name == "creep") { // level, and on both sides of the rest rule's velocity
        fill_heights(scene, [](const Place&) { return Fields{0.5, 0.25, 0.6}; });
        fill(grid, scene.fields.velocity_x, [](const Place&) { return 0.75e-3; });
        fill(grid, scene.fields.velocity_y, [](const Place&) { return -1.4e-3; });
        scene.pilot_steps = 0;
    } else if (name == "brimful") { // columns that one step's rain or source lifts past the declared largest height, or not
        const double full = scene.settings.method.largest_height;
        fill_heights(scene, [&](const Place& p) {
            const double more = 0.0625 * ((p.i + p.j) % 2); // sand in place of water: a slope
            return Fields{full - 1 - 4e-6 - 2e-5 * ((p.i * 5 + p.j * 3) % 7), 0.4 + more, 0.6 - more - 3e-4 * (p.i % 2)};
        });
        scene.pilot_steps = 0;
    } else if (name == "slope") {
        fill_heights(scene, [&](const Place& p) {
            return Fields{0.2 * grid.dx * p.i, 0.3 + 0.1 * std::sin(9 * p.s), 0.12 + 0.05 * std::cos(7 * p.u + 5 * p.v)};
        });
        stir(scene, 0.5, 0.2);
    } else if (name == "lake") {
        fill_heights(scene, [](const Place& p) {
            const double bed = 0.7 + 0.45 * std::sin(6 * p.u + 1) * std::cos(4 * p.v),
                         dune = std::max(0.0, 0.2 * std::sin(9 * p.s));
            return Fields{bed, dune, std::max(0.0, 1 - bed)};
        });
        scene.pilot_steps = 2;
    } else if (name == "dam_break") {
        fill_heights(scene, [](const Place& p) {
            return Fields{0.1 * p.u, p.s >= 0.5 && p.s < 0.8 ? 0.8 : 0.0, p.s < 0.55 ? 2.0 - 0.3 * p.v : 0.0};
        });
    } else if (name == "cliff") {
        auto& material = scene.settings.material;
        material.sand_viscosity = 2; // more than the step bears
        material.cohesion_dry = 100; // less than the cliffs need
        material.cohesion_wet = material.cohesion_capillary = 700;
        fill_heights(scene, [](const Place& p) {
            return Fields{p.s < 0.4 ? 4.0 : 0.0, p.s < 0.55 ? 1.0 : 0.1, p.s < 0.3 ? 0.5 : 0.2 + 0.1 * p.v};
        });
        stir(scene, 0.3, 0.1);
    } else if (name == "patches") { // heaps and puddles few cells wide, far apart: groups of cells between them hold nothing
        fill_heights(scene, [](const Place& p) {
            const bool heap = p.i % 53 < 1 + p.j / 37 && p.j % 37 < 2, puddle = (p.i + 20) % 61 < 3 && (p.j + 5) % 41 <= p.i / 61;
            return Fields{0.02 * p.u + 0.03 * p.v, heap ? 0.4 : 0.0, puddle ? 0.3 : 0.0};
        });
        stir(scene, 1, 0.5);
    } else if (name == "islands") {
        fill_heights(scene, [](const Place& p) {
            const double bed = 1 + 0.8 * std::cos(11 * p.u) * std::cos(8 * p.v);
            return Fields{bed, bed > 1.25 ? 0.4 : 0.0, std::max(0.0, 1.1 - bed)};
        });
        stir(scene, 0.6, 0.3);
    } else if (name == "one_wet_cell") {
        fill_heights(scene, [&](const Place& p) {
            const bool here = p.i == grid.nx / 2 && p.j == grid.ny / 2;
            return Fields{0.2, here ? 0.4 : 0.0, here ? 0.5 : 0.0};
        });
    } else if (name == "random") {
        fill_heights(scene, [](const Place& p) {
            return Fields{2 + 1.5 * noise(1, p), std::max(0.0, 0.5 + 0.7 * noise(2, p)), std::max(0.0, 0.6 + 0.9 * noise(3, p))};
        });
        // Beyond the clamp and fast enough for the outflow limiter to act.
        const double courant = grid.dx / scene.settings.dt;
        stir(scene, 0.9 * courant, 0.5 * courant * scene.settings.method.substeps);
        scene.pilot_steps = 0;
        scene.rough_stretch = true;
    } else {
        return false;
    }
    return true;
}

bool set_method(Method& method, const std::string& name) {
    if (name == "default") return true;
    if (name == "plain") {
        method.quantum = 0;
    } else if (name == "bare") { // every guard off
        method.quantum = method.gravity_cap = method.sand_gravity_cap = method.elastic_cap = 0;
        method.passive_pressure = method.gradient_clamp = method.cohesion_cap = 0;
        method.outflow_limiter = method.rest_rule = false;
    } else if (name == "unsmoothed") {
        method.saturation_smoothing = 0;
        method.substeps = 1;
    } else if (name == "coarse") {
        method.quantum = std::ldexp(1.0, -14);
        method.saturation_smoothing = 1;
        method.substeps = 2;
        method.passive_pressure = 0.3;
        method.bulk_viscosity = 0.5;
    } else {
        return false;
    }
    return true;
}

TimeSeries constant(double value) { return {{{0, value}}}; }

// A water disc that pushes, a sand box, a sink, a point, one source that would pass the declared largest height, and two that
// hold levels. Shapes keep off cell and face centres, so that no rounding decides what is inside.
void add_sources(Scene& scene) {
    auto& s = scene.settings;
    const double lx = s.grid.nx * s.grid.dx, ly = s.grid.ny * s.grid.dx, dx = s.grid.dx;
    Source disc;
    disc.center = {0.4 * lx + 0.013 * dx, 0.5 * ly + 0.017 * dx};
    disc.radius = std::max(0.2 * std::min(lx, ly), 0.61 * dx);
    disc.rate = constant(0.37);
    disc.set_velocity = true;
    disc.velocity = {0.7, -0.4};
    Source box;
    box.shape = SourceShape::box;
    box.material = SourceMaterial::sand;
    box.box = {0.29 * lx, 0.23 * ly, 0.83 * lx + 0.16 * dx, 0.79 * ly + 0.16 * dx};
    box.rate = constant(0.11);
    Source sink = box;
    sink.material = SourceMaterial::water;
    sink.box = {-0.3 * dx, -0.3 * dx, 0.31 * lx + 0.17 * dx, 0.61 * ly + 0.17 * dx};
    sink.rate = constant(-2.3);
    Source point;
    point.shape = SourceShape::point;
    point.center = {0.9 * lx, 0.1 * ly};
    point.rate = constant(5.1);
    Source flood = disc;
    flood.center = {0.5 * lx, 0.5 * ly};
    flood.radius = 0.61 * dx;
    flood.set_velocity = false;
    flood.rate = constant(2 * s.method.largest_height / s.dt);
    Source lake = sink; // over half the grid, where it lacks water and where it has too much
    lake.box = {0.47 * lx, -0.3 * dx, 0.97 * lx + 0.17 * dx, 0.61 * ly + 0.17 * dx};
    lake.rate = {};
    lake.level = constant(1.27);
    Source weir = lake;
    weir.box = {-0.3 * dx, 0.53 * ly, 0.61 * lx + 0.17 * dx, 0.97 * ly + 0.17 * dx};
    weir.rate = constant(3.3);
    weir.level = constant(0.61);
    weir.drain = true;
    s.sources = {disc, box, sink, point, flood, lake, weir};
    if (scene.name != "point_jet") return;
    point.center = {0.5 * lx + 0.2 * dx, 0.5 * ly + 0.2 * dx};
    point.set_velocity = true;
    point.velocity = {0.9, 0.3};
    s.sources = {point};
}

void open_sides(Scene& scene) {
    auto& s = scene.settings;
    const double ly = s.grid.ny * s.grid.dx, lx = s.grid.nx * s.grid.dx;
    const bool water = (scene.effects & EFFECT_WATER) != 0;
    const double deep = scene.name == "deep" ? 400 : 1; // the lake's level differs by less than the rest rule's 1e-5 m
    s.sides[SIDE_WEST] = {SideKind::outflow, 0.1 * ly, 1e30, {}};
    s.sides[SIDE_EAST] = {SideKind::outflow, 0, 0.8 * ly, {}};
    s.sides[SIDE_NORTH] = {SideKind::outflow, 0, 1e30, {}};
    if (!water) return;
    s.sides[SIDE_EAST] = {SideKind::discharge, 0, 0.8 * ly, {{{0, 0.8 * deep * ly}, {1, 1.2 * deep * ly}}}};
    if (scene.name == "slope" || scene.name == "islands") s.sides[SIDE_EAST].depth = 0.3; // less than critical
    auto& south = s.sides[SIDE_SOUTH];
    south = {SideKind::level, 0.2 * lx, 1e30, constant(scene.name == "lake" ? 1.000008 : 1.03 * deep)};
    // Every kind somewhere: each stage meets several scenes.
    if (scene.name == "slope" || scene.name == "thin_film" || scene.name == "deep") s.sides[SIDE_NORTH].kind = SideKind::brink;
    if (scene.name == "random" || scene.name == "cliff") {
        south.kind = SideKind::waves;
        south.wave = {{{0, 0.02}, {1, -0.03}}};
    }
    if (scene.name == "islands") south.absorb = 0.7;
}

// What enters and leaves, for the grid that the settings have.
void add_rim(Scene& scene) {
    if ((scene.effects & EFFECT_SOURCES) != 0) add_sources(scene);
    if ((scene.effects & EFFECT_OPEN_SIDES) != 0) open_sides(scene);
    if ((scene.effects & EFFECT_RAIN) == 0) return;
    scene.settings.rain = constant(3e-3);
    scene.settings.evaporation = constant(1e-3);
    if ((scene.effects & EFFECT_RAIN_MAP) == 0) return;
    const auto& grid = scene.settings.grid;
    scene.settings.rain_map.clear();
    for (int j = 0; j < grid.ny; ++j)
        for (int i = 0; i < grid.nx; ++i) scene.settings.rain_map.push_back(0.03125F * static_cast<float>((i * 7 + j * 5) % 61));
}

} // namespace

float band_limited(std::uint32_t seed, int i, int j) {
    double sum = 0;
    std::uint32_t state = seed * 2654435761u + 12345u;
    const auto next = [&] { // Numerical Recipes' linear congruential generator; the high bits only
        state = state * 1664525u + 1013904223u;
        return static_cast<double>(state >> 8) / static_cast<double>(1u << 24);
    };
    for (int n = 0; n < 8; ++n) {
        const double kx = (next() - 0.5) * PI, ky = (next() - 0.5) * PI, phase = 2 * PI * next();
        sum += std::cos(kx * i + ky * j + phase);
    }
    return static_cast<float>(std::clamp(sum / 4, -1.0, 1.0));
}

std::span<const char* const> grid_names() { return grids; }
std::span<const char* const> scene_names() { return scenes; }
std::span<const char* const> method_names_of_cases() { return methods; }

Result<Scene> make_scene(const std::string& grid, const std::string& name, const std::string& method, std::uint32_t effects) {
    Scene scene;
    scene.name = name;
    scene.effects = effects;
    auto& s = scene.settings;
    const char* const end = grid.data() + grid.size();
    const auto first = std::from_chars(grid.data(), end, s.grid.nx);
    if (first.ec != std::errc{} || first.ptr == end || *first.ptr != 'x' ||
        std::from_chars(first.ptr + 1, end, s.grid.ny).ptr != end)
        return error(Code::bad_argument, "grid=" + grid + ": want NXxNY, e.g. 33x17");
    s.grid.dx = 0.2;
    s.dt = 0.015;
    s.material.friction = 0.35;
    s.material.young_modulus = 5e5;
    s.material.cohesion_dry = 500;
    s.material.cohesion_wet = 1.2e4;
    s.material.cohesion_capillary = 1e4;
    s.material.exchange_rate = 3e4;
    s.material.bed_friction = 0.01;
    s.material.manning = 0.02;
    s.material.bed_shear = 0.05;
    s.material.slope_normal = 1;
    s.material.internal_friction = 0.4;
    s.material.sand_viscosity = 0.05;
    s.material.retention = 0.3;
    s.material.bed_adhesion = 0.7;
    s.method.shock_viscosity = 0; // a choice, on by default
    for (const auto& choice : choice_table())
        if ((effects & choice.bit) != 0) choice.choose(s);
    if (method == "porous")
        s.material.porosity = 0.4; // of the material, and named like one
    else if (!set_method(s.method, method))
        return error(Code::bad_argument, "method=" + method + ": no such choice");
    if (name == "deep") {
        make_deep(scene);
        if (s.method.quantum > 0) s.method.quantum = std::ldexp(1.0, -8);
    } else if (name == "thin_film") {
        make_thin_film(scene);
    } else if (name == "point_jet") {
        fill_heights(scene, [](const Place&) { return Fields{0.5, 0.25, 0.6}; });
    } else if (!make_heights(scene)) {
        return error(Code::bad_argument, "scene=" + name + ": no such scene");
    }
    add_rim(scene);
    for (int n = 0; (effects & EFFECT_ROUGHNESS) != 0 && n < s.grid.nx * s.grid.ny; ++n)
        s.roughness.push_back(0.03F * (1 + band_limited(41, n % s.grid.nx, n / s.grid.nx)));
    for (const auto& effect : effect_table())
        s.effects.emplace_back(effect.name, (effects & effect.bit) != 0 ? Force::on : Force::off);
    if (auto status = validate(s); !status) return status;
    if (auto status = validate(scene.fields, s); !status) return status;
    return scene;
}

Result<Scene> make_large_scene(int size, const std::string& name, std::uint32_t effects) {
    constexpr int tile = 256;
    auto scene = make_scene("256x256", name, "default", effects);
    if (!scene) return scene;
    scene->settings.grid.nx = scene->settings.grid.ny = size;
    if ((effects & EFFECT_ROUGHNESS) == 0) scene->settings.material.manning = 0; // as in most levels, whose time is meant
    add_rim(*scene);
    auto& f = scene->fields;
    for (auto* field : {&f.terrain, &f.sand, &f.water, &f.velocity_x, &f.velocity_y, &f.sand_velocity_x, &f.sand_velocity_y,
                        &scene->settings.roughness}) {
        if (field->empty()) continue;
        const std::vector<float> small = std::move(*field);
        field->clear();
        field->reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
        for (int j = 0; j < size; ++j)
            for (int i = 0; i < size; ++i) field->push_back(small[static_cast<std::size_t>(j % tile * tile + i % tile)]);
    }
    return scene;
}

} // namespace wadi::conformance
