#include "engine/settings/data/method_presets.hpp"
#include "tests/fuzz/fuzz_case.hpp"
#include "tests/fuzz/random.hpp"
#include <algorithm>
#include <cmath>
#include <functional>

namespace wadi::fuzz {

namespace {

using Field = std::function<double(int i, int j)>;

std::vector<float> drawn(const Grid& grid, const Field& at) {
    std::vector<float> field;
    for (int j = 0; j < grid.ny; ++j)
        for (int i = 0; i < grid.nx; ++i) field.push_back(static_cast<float>(at(i, j)));
    return field;
}

// One of: nothing, level, waves, boxes, noise from cell to cell, a slope; between 0 and `size`.
Field relief(Random& random, const Grid& grid, double size) {
    const double a = random.real(0, 6), b = random.real(0.05, 1.5), c = random.real(0.05, 1.5), cx = random.real(0, grid.nx),
                 cy = random.real(0, grid.ny), r = random.real(1, 0.7 * std::max(grid.nx, grid.ny));
    const std::uint64_t seed = random.next();
    switch (random.whole(0, 6)) {
    case 0:
        return [=](int, int) { return size; };
    case 1:
        return [=](int i, int j) { return size * (0.5 + 0.25 * std::sin(a + b * i) + 0.25 * std::cos(c * j - a)); };
    case 2:
        return [=](int i, int j) { return std::max(std::fabs(i + 0.5 - cx), std::fabs(j + 0.5 - cy)) < 0.6 * r ? size : 0.0; };
    case 3:
        return [=](int i, int j) { return std::max(0.0, size * (1 - std::hypot(i + 0.5 - cx, j + 0.5 - cy) / r)); };
    case 4:
        return [=](int i, int j) {
            Random cell(seed ^ (static_cast<std::uint64_t>(j) << 20) ^ static_cast<std::uint64_t>(i));
            cell.next();
            return cell.real(0, size);
        };
    case 5:
        return [=](int i, int j) { return size * (b * i / grid.nx + c * j / grid.ny) / 3; };
    default:
        return [=](int i, int j) { return i == static_cast<int>(cx) && j == static_cast<int>(cy) ? size : 0.0; };
    }
}

void make_fields(Random& random, Case& c, double size) {
    auto& s = c.scene.settings;
    auto& f = c.scene.fields;
    const auto ground = relief(random, s.grid, random.chance(0.15) ? 100 * s.grid.dx : random.log(0.1, 3) * size);
    f.terrain = drawn(s.grid, ground);
    const double eps = s.method.dry_threshold;
    if (random.chance(0.75)) {
        const auto sand = relief(random, s.grid, random.chance(0.15) ? random.log(0.1, 10) * eps : random.log(0.05, 1) * size);
        f.sand = drawn(s.grid, sand);
    }
    if (random.chance(0.85)) {
        const int kind = random.whole(0, 3);
        const double depth = random.chance(0.15) ? random.log(0.1, 10) * eps : random.log(0.05, 1) * size;
        const auto water = relief(random, s.grid, depth);
        const double wet = random.real(0, 1.2);
        f.water = drawn(s.grid, [&](int i, int j) {
            const std::size_t n = static_cast<std::size_t>(j) * static_cast<std::size_t>(s.grid.nx) + static_cast<std::size_t>(i);
            if (kind == 0) return std::max(0.0, 2 * depth - static_cast<double>(f.terrain[n])); // a lake
            if (kind == 1 && !f.sand.empty()) return wet * static_cast<double>(f.sand[n]);
            return water(i, j);
        });
    }
    const auto uniform = [&](std::vector<float>& x, std::vector<float>& y, double fastest) {
        if (!random.chance(0.3)) return;
        const double u = random.real(-fastest, fastest), v = random.real(-fastest, fastest);
        x = drawn(s.grid, [=](int, int) { return u; });
        y = drawn(s.grid, [=](int, int) { return v; });
    };
    const double clamp = std::min(s.method.velocity_clamp * s.grid.dx / s.dt, 5000.0);
    uniform(f.velocity_x, f.velocity_y, clamp);
    uniform(f.sand_velocity_x, f.sand_velocity_y, clamp);
}

void make_material(Random& random, Material& m) {
    const auto maybe = [&](double& value, double low, double high) {
        if (random.chance(0.4))
            value = random.log(low, high);
        else if (random.chance(0.05))
            value = 0;
    };
    if (random.chance(0.2)) m.sand_density = random.log(500, 8000);
    if (random.chance(0.1)) m.water_density = random.log(500, 3000);
    maybe(m.friction, 1e-2, 5);
    maybe(m.young_modulus, 1e2, 1e9);
    if (random.chance(0.2)) m.poisson_ratio = random.real(0, 0.49);
    if (random.chance(0.2)) m.yield_friction = random.log(0.05, 5);
    maybe(m.cohesion_dry, 1, 1e6);
    maybe(m.cohesion_wet, 1, 1e8);
    maybe(m.cohesion_capillary, 1, 1e8);
    maybe(m.exchange_rate, 1, 1e12);
    maybe(m.diffusion_rate, 1e-4, 1e3);
    if (random.chance(0.3)) m.bed_friction = random.log(1e-3, 1);
    if (random.chance(0.2)) m.bed_shear = random.log(1e-3, 1);
    if (random.chance(0.1)) m.saturation = {random.real(0.01, 0.3), random.real(0.35, 0.6), random.real(0.65, 1)};
}

void make_method(Random& random, Settings& s) {
    Method& m = s.method;
    m.substeps = random.whole(1, 6);
    if (random.chance(0.08)) {
        choose_method(s, "published");
        return;
    }
    if (random.chance(0.15)) m.quantum = 0;
    if (random.chance(0.1)) m.dry_threshold = random.log(1e-7, 1e-2);
    if (random.chance(0.2)) m.velocity_clamp = random.real(0.05, 0.95);
    const auto rarely_off = [&](double& guard) {
        if (random.chance(0.08)) guard = 0;
    };
    for (double* guard :
         {&m.gravity_cap, &m.sand_gravity_cap, &m.elastic_cap, &m.passive_pressure, &m.gradient_clamp, &m.cohesion_cap})
        rarely_off(*guard);
    if (random.chance(0.1)) m.rest_rule = false;
    if (random.chance(0.3)) m.shock_viscosity = random.real(0, 1);
    if (random.chance(0.3)) m.bulk_viscosity = random.real(0, 1);
    m.saturation_smoothing = random.whole(0, 2);
}

void make_rims_and_sources(Random& random, Settings& s, double size) {
    const double lx = s.grid.nx * s.grid.dx, ly = s.grid.ny * s.grid.dx;
    for (std::size_t n = 0; n < 4; ++n) {
        Side& side = s.sides[n];
        const double length = n < 2 ? ly : lx;
        if (!random.chance(0.2)) continue;
        side.kind = random.pick({SideKind::discharge, SideKind::level, SideKind::outflow});
        if (side.kind == SideKind::discharge) side.value = {{{0, random.log(1e-3, 1) * size * length}}};
        if (side.kind == SideKind::level) side.value = {{{0, random.real(-0.2, 2) * size}}};
        if (random.chance(0.3)) side.from = random.real(0, 0.4) * length, side.to = random.real(0.5, 1) * length;
    }
    for (int n = random.chance(0.3) ? random.whole(1, 3) : 0; n > 0; --n) {
        Source source;
        source.shape = random.pick({SourceShape::disc, SourceShape::box, SourceShape::point});
        source.material = random.chance(0.7) ? SourceMaterial::water : SourceMaterial::sand;
        source.center = {random.real(0, lx), random.real(0, ly)};
        if (source.shape == SourceShape::disc) source.radius = random.real(0.1, 6) * s.grid.dx;
        if (source.shape == SourceShape::box) {
            const double x = random.real(0, 0.8) * lx, y = random.real(0, 0.8) * ly;
            source.box = {x, y, x + random.real(0.1, 6) * s.grid.dx, y + random.real(0.1, 6) * s.grid.dx};
        }
        source.rate = {{{0, random.pick({-1.0, 1.0, 1.0}) * random.log(1e-4, 0.1) * size / s.dt}}};
        source.rate.samples[0].second = std::clamp(source.rate.samples[0].second, -1000.0, 1000.0);
        if (source.material == SourceMaterial::water && random.chance(0.4)) {
            source.set_velocity = true;
            source.velocity = {random.real(-100, 100), random.real(-100, 100)};
        }
        s.sources.push_back(source);
    }
    if (random.chance(0.12)) s.rain = {{{0, random.log(1e-7, 1e-1)}}};
    if (random.chance(0.12)) s.evaporation = {{{0, random.log(1e-7, 1e-1)}}};
    // What needs nothing else can be forced off alone.
    for (const char* name : {"cohesion", "diffusion", "drag", "bed_shear"})
        if (random.chance(0.05)) s.effects.push_back({name, Force::off});
}

// NUMERICS 2.18 and 2.19: over the ranges, at their ends, and a little above 0, where an effect is on and has next to nothing to
// do.
void make_sand_laws(Random& random, Settings& s) {
    Material& m = s.material;
    const auto maybe = [&](double& value, double most) {
        if (!random.chance(0.5)) return;
        const int kind = random.whole(0, 3);
        value = kind == 0 ? most : kind == 1 ? random.log(1e-12, 1e-3) : random.real(0, most);
    };
    maybe(m.slope_normal, 2);
    maybe(m.internal_friction, 1);
    maybe(m.sand_viscosity, random.log(1e-3, 10));
    maybe(m.retention, 0.95);
    for (const char* name : {"slope_normal", "internal_friction", "retention"})
        if (random.chance(0.03)) s.effects.push_back({name, Force::off});
}

void make_commands(Random& random, Case& c, double size) {
    const auto& grid = c.scene.settings.grid;
    const auto place = [&](int cells) { return random.whole(-256, 256 * cells + 256) / 256.0 * grid.dx; }; // whole 1/256 cells
    for (int n = random.chance(0.5) ? random.whole(1, 8) : 0; n > 0; --n) {
        Edit edit;
        edit.step = static_cast<std::uint64_t>(random.whole(0, c.steps - 1));
        edit.capsule = random.chance(0.3);
        edit.x0 = place(grid.nx);
        edit.y0 = place(grid.ny);
        if (edit.capsule) edit.x1 = place(grid.nx), edit.y1 = place(grid.ny);
        edit.radius = random.whole(16, 256 * 10) / 256.0 * grid.dx;
        edit.softness = random.pick({0.0, 0.5, 1.0});
        if (random.chance(0.25)) {
            edit.kind = EditKind::push;
            edit.strength = random.real(0, 1);
            edit.velocity_x = random.real(-50, 50);
            edit.velocity_y = random.real(-50, 50);
        } else {
            edit.layer = random.pick({EditLayer::terrain, EditLayer::sand, EditLayer::water});
            edit.amount = random.pick({-1.0, 1.0, 1.0}) * random.log(1e-4, 2) * size;
        }
        c.commands.push_back(edit);
    }
    std::stable_sort(c.commands.begin(), c.commands.end(), [](const Edit& a, const Edit& b) { return a.step < b.step; });
}

} // namespace

Case make_case(std::uint64_t seed) {
    Random random(seed);
    random.next();
    Case c;
    c.seed = seed;
    c.steps = random.whole(5, 40);
    auto& s = c.scene.settings;
    s.grid = {random.whole(16, 64), random.whole(16, 64), random.log(0.02, 20)};
    if (random.chance(0.08)) (random.chance(0.5) ? s.grid.nx : s.grid.ny) = random.whole(1, 4);
    const double size = random.log(0.5, 20) * s.grid.dx; // of depths
    s.gravity = random.chance(0.1) ? random.pick({0.0, 1.6, 100.0}) : 9.81;
    make_method(random, s);
    s.method.largest_height = std::exp2(std::ceil(std::log2(100 * s.grid.dx + 40 * size))); // what is drawn, edited and piled up
    const double courant = random.log(0.02, 10);
    s.dt = std::clamp(courant * s.grid.dx / std::sqrt(9.81 * size), 1e-5, 2.0);
    make_material(random, s.material);
    make_fields(random, c, size);
    make_rims_and_sources(random, s, size);
    make_commands(random, c, size);
    // Drawn last, as they came: seeds keep the rest of their cases.
    if (random.chance(0.4)) s.method.water_transport_order = 2;
    make_sand_laws(random, s);
    if (random.chance(0.3)) s.method.prestress = true;
    if (random.chance(0.3) && !s.method.published()) s.method.sand_transport_order = 2;
    if (random.chance(0.2)) s.material.manning = random.log(1e-3, 1);
    if (random.chance(0.1)) s.roughness = drawn(s.grid, relief(random, s.grid, random.log(1e-3, 1)));
    for (Side& side : s.sides)
        if (side.kind == SideKind::discharge && random.chance(0.5)) side.depth = random.log(1e-3, 2) * size;
    for (Source& source : s.sources) {
        if (!random.chance(0.2)) continue;
        source.discharge = {{{0, source.rate.samples[0].second * s.grid.dx * s.grid.dx * random.real(0.5, 20)}}};
        source.rate = {};
    }
    if (s.method.published()) {
        s.method.outflow_limiter = random.chance(0.5);
        s.method.strain_transport = random.pick({StrainTransport::polar, StrainTransport::direct});
    }
    if (random.chance(0.2)) c.at_ends = draw_ends(random, c);
    for (Side& side : s.sides) {
        if (side.kind == SideKind::outflow && random.chance(0.4)) side.kind = SideKind::brink;
        if (side.kind == SideKind::outflow && random.chance(0.3)) side.slope = random.log(1e-5, 1);
        if (side.kind != SideKind::wall && random.chance(0.3)) side.sediment = random.real(0, 1);
        if (side.kind != SideKind::level) continue;
        if (random.chance(0.4)) {
            side.kind = SideKind::waves;
            const double high = random.log(1e-3, 1) * size;
            if (random.chance(0.7)) side.wave = {{{0, random.real(-1, 1) * high}, {c.steps * s.dt, random.real(-1, 1) * high}}};
        }
        if (random.chance(0.4)) side.absorb = random.log(0.1, 1e4) * s.dt;
    }
    if (random.chance(0.5)) s.material.bed_adhesion = random.pick({0.0, random.log(1e-12, 1e-3), random.real(0, 1)});
    if (random.chance(0.25)) {
        s.material.flow_length = random.pick({random.log(1e-12, 1e-4), random.log(1e-4, 1e-2), random.log(1e-2, 10)});
        s.material.flow_friction = random.real(0, 2);
        s.material.flow_beta = random.log(0.01, 10);
        s.material.flow_gamma = random.pick({0.0, random.real(0, 2)});
    }
    if (random.chance(0.5))
        s.material.porosity = random.pick({0.4, 0.375, random.real(0.01, 1), random.log(0.01, 0.05), 1 - random.log(1e-7, 1e-2)});
    if (random.chance(0.3)) {
        s.material.conductivity = random.pick({random.log(1e-9, 1e-5), random.log(1e-5, 1e-2), random.log(1e-2, 10)});
        s.material.suction = random.pick({0.0, random.log(1e-6, 1e-1), random.real(0, 10)});
    }
    for (Source& source : s.sources) {
        if (source.material != SourceMaterial::water || !random.chance(0.3)) continue;
        source.level = {{{0, std::min(random.real(-0.2, 2) * size, s.method.largest_height)}}};
        source.drain = random.chance(0.4);
        source.set_velocity = false;
        for (TimeSeries* most : {&source.rate, &source.discharge}) {
            if (random.chance(0.5)) *most = {};
            for (auto& [time, value] : most->samples) value = std::fabs(value);
        }
    }
    if (!s.rain.samples.empty() && random.chance(0.5)) {
        double most = 1e-30;
        for (const auto& [time, rate] : s.rain.samples) most = std::max(most, rate);
        s.rain_map = drawn(s.grid, relief(random, s.grid, std::min(random.log(1e-3, 90), 0.9 / most)));
    }
    for (const char* name : {"foam", "wetness", "silt"})
        if (random.chance(0.3)) s.effects.push_back({name, Force::on});
    return c;
}

} // namespace wadi::fuzz
