// Prestress: sand that its cohesion can hold starts in balance, however it came there (NUMERICS 2.20).
#include "engine/settings/data/method_presets.hpp"
#include "engine/settings/rules/material_keys.hpp"
#include "tests/stability/quality.hpp"

using namespace wadi;
using namespace wadi::test;

namespace {

constexpr int box_cells = 56;
constexpr double box_dx = 0.1, box_middle = box_cells * box_dx / 2, box_high = 2; // [m]

/// The recommended sand on a bed that falls along x. Cohesion of c_f rho_s g h holds a wall of stiff sand; this one's stretches
/// by a tenth, which takes as much more, and the water in it leans on it.
Scene on_slope(double slope, bool prestress, const std::function<double(double x, double y)>& sand) {
    auto scene = flat_scene(box_cells, box_cells, box_dx, 0.006);
    auto& m = scene.settings.material;
    m.cohesion_dry = 1.3 * m.yield_friction * m.sand_density * scene.settings.gravity * box_high;
    m.slope_normal = 1;
    m.internal_friction = 0.4;
    m.sand_viscosity = 0.05;
    m.retention = 0.4925;
    scene.settings.method.prestress = prestress;
    scene.fill(scene.fields.terrain, [&](double x, double) { return slope * (box_cells * box_dx - x); });
    scene.fill(scene.fields.sand, sand);
    return scene;
}

double box(double x, double y) { return std::max(std::fabs(x - box_middle), std::fabs(y - box_middle)) < 1 ? box_high : 0; }
double cylinder(double x, double y) { return std::hypot(x - box_middle, y - box_middle) < 1.2 ? box_high : 0; }
double nothing(double, double) { return 0; }

/// The box with a share of its depth of water in it and cohesion at any saturation up to 0.9.
Scene damp_box(double share, double retention, bool prestress) {
    auto scene = on_slope(0, prestress, box);
    auto& m = scene.settings.material;
    m.retention = retention;
    m.cohesion_wet = m.cohesion_capillary = m.cohesion_dry;
    m.saturation = {0.1, 0.9, 0.95};
    scene.fill(scene.fields.water, [&](double x, double y) { return share * box(x, y); });
    return scene;
}

struct Moved {
    double sand = 0, speed = 0; // the largest change of depth [m], the largest speed [m/s]
};

/// What a run of so long makes of the sand as it lies now.
Moved move(World& world, double seconds) {
    const auto before = cells_of(world, "sand_height");
    Moved moved;
    moved.speed = worst(world, static_cast<int>(seconds / world.settings().dt), 50, sand_speed);
    const auto now = cells_of(world, "sand_height");
    for (std::size_t n = 0; n < now.values.size(); ++n)
        moved.sand = std::max(moved.sand, std::fabs(static_cast<double>(now.values[n] - before.values[n])));
    return moved;
}

Moved move_drawn(const Scene& scene, double seconds = 3) { return move(*make_world(scene), seconds); }

/// How sand comes or goes in a running world.
struct Change {
    const char* name;
    std::function<double(double x, double y)> drawn;
    std::function<void(World&)> make; // of a world after some steps
    double seconds;                   // that it takes
};

const Change changes[] = {
    {"brush on sand", box, [](World& w) { edit_world(w, {brush(EditLayer::sand, box_middle, box_middle, 0.6, -0.4, 0.5)}); }, 0},
    {"brush on bare ground", nothing,
     [](World& w) { edit_world(w, {brush(EditLayer::sand, box_middle, box_middle, 1, 1.5, 0)}); }, 0},
    {"stamp", box,
     [](World& w) {
         const float image[] = {1, 1, 1, 1};
         const auto stamp = w.edits().create_stamp(2, 2, image);
         REQUIRE(stamp);
         Edit edit = brush(EditLayer::sand, box_middle - 1, box_middle - 1, 0, -0.7);
         edit.kind = EditKind::stamp;
         edit.stamp = *stamp;
         edit.x1 = box_middle;
         edit.y1 = box_middle + 0.5;
         edit_world(w, {edit});
     },
     0},
    {"region", box,
     [](World& w) {
         const std::vector<float> values(std::size_t{20} * 10, 1.5F);
         CHECK(w.commands().write_region(EditLayer::sand, {12, 20, 20, 10}, values));
     },
     0},
    {"source", nothing, [](World&) {}, 1},
};

Scene with_source(Scene scene, const Change& change) {
    if (change.seconds == 0) return scene;
    Source source;
    source.material = SourceMaterial::sand;
    source.center = {box_middle, box_middle};
    source.radius = 0.8;
    source.rate.samples = {{0, 1.5}, {change.seconds, 1.5}, {change.seconds + 1e-3, 0}};
    scene.settings.sources = {source};
    return scene;
}

/// The deepest sand that no source covers: where sand that is poured does not stand, it spreads while it is.
double beside_source(World& world) {
    const auto& source = world.settings().sources[0];
    const auto sand = cells_of(world, "sand_height");
    double most = 0;
    for (int j = 0; j < box_cells; ++j)
        for (int i = 0; i < box_cells; ++i)
            if (std::hypot((i + 0.5) * box_dx - source.center[0], (j + 0.5) * box_dx - source.center[1]) > source.radius)
                most = std::max(most, sand.at(i, j));
    return most;
}

double moved_after(const Change& change, double slope, bool prestress) {
    auto world = make_world(with_source(on_slope(slope, prestress, change.drawn), change));
    step(*world, 20);
    change.make(*world);
    step(*world, 1 + static_cast<int>(change.seconds / world->settings().dt));
    CHECK(largest(cells_of(*world, "sand_height")) > 1);
    const auto moved = move(*world, 2);
    if (prestress) CHECK(moved.speed == 0);
    check_books(*world);
    return change.seconds > 0 ? std::max(moved.sand, beside_source(*world)) : moved.sand;
}

/// The stretch of sand in balance less 1, as NUMERICS 2.20 says it.
double balance(const Settings& s, const WorldParams& p, double hs, double water) {
    const auto& m = s.material;
    if (!(hs > 0)) return 0;
    const double phi = water / (water + hs), rho = m.water_density / m.sand_density, weight = m.sand_density * s.gravity;
    const auto& [phi1, phi2, phi3] = m.saturation;
    double c = phi < phi1   ? m.cohesion_dry + (m.cohesion_wet - m.cohesion_dry) * phi / phi1
               : phi < phi2 ? m.cohesion_wet + (m.cohesion_capillary - m.cohesion_wet) * (phi - phi1) / (phi2 - phi1)
                            : m.cohesion_capillary * std::max(0.0, phi3 - phi) / (phi3 - phi2);
    c *= 0.9 * 4 * m.yield_friction *
         (m.yield_friction + std::sqrt(m.yield_friction * m.yield_friction + 1)); // of the yield surface
    c = std::min(c, 2 * m.yield_friction * s.method.cohesion_cap * weight * hs);
    const double wet = std::min(water, hs) / hs, full = std::clamp((water / hs - m.retention) / (1 - m.retention), 0.0, 1.0);
    const double steep = m.friction + std::sqrt(m.friction * m.friction + 1 / m.slope_normal);
    const double least = 1 / (1 + m.slope_normal * steep * steep), w = std::min(1.0, 4 * c / (m.yield_friction * weight * hs));
    const double whole = weight * hs / 2 * std::max(0.0, 1 + rho * (wet - 2 * full));
    const double tension = std::min(whole * w * (least + w * (1 - least)), c / (2 * m.yield_friction));
    const double stiffness = static_cast<double>(p.lambda) + static_cast<double>(p.shear);
    double low = 0, up = 1;
    while (up - low > 1e-15) {
        const double tr = (low + up) / 2;
        (stiffness * tr < tension * std::exp(tr) ? low : up) = tr;
    }
    return std::expm1(std::min(low, c / (2 * m.yield_friction * stiffness)) / 2);
}

double relief(const Cells& drawn, const Cells& now, double spacing) {
    const int reach = static_cast<int>(0.5 / spacing);
    double sum = 0;
    int count = 0;
    for (int j = 0; j < drawn.ny; ++j) {
        for (int i = 0; i < drawn.nx; ++i) {
            if (drawn.at(i, j) < 0.5) continue;
            double around = 0;
            for (int b = -reach; b <= reach; ++b)
                for (int a = -reach; a <= reach; ++a) around += now.at(i + a, j + b);
            sum += std::pow(now.at(i, j) - around / ((2 * reach + 1) * (2 * reach + 1)), 2);
            ++count;
        }
    }
    return std::sqrt(sum / count);
}

} // namespace

TEST_CASE("sand that its cohesion holds keeps every bit of its depth from the first step on, on level ground and on slopes") {
    for (const double slope : {0.0, 0.1, 0.3}) {
        for (const auto& shape : {box, cylinder}) {
            CAPTURE(slope);
            CAPTURE(shape == box);
            const auto held = move_drawn(on_slope(slope, true, shape)), slack = move_drawn(on_slope(slope, false, shape), 1);
            CHECK(held.sand == 0);
            CHECK(held.speed == 0);
            CHECK(slack.sand > 0.02);
        }
    }
}

TEST_CASE("sand that is brushed, stamped, written or poured, or taken away, leaves sand in balance, on a slope too") {
    for (const auto& change : changes) {
        for (const double slope : {0.0, 0.3}) {
            CAPTURE(change.name);
            CAPTURE(slope);
            CHECK(moved_after(change, slope, true) == 0);
        }
        CAPTURE(change.name);
        CHECK(moved_after(change, 0, false) > 0.01);
    }
}

TEST_CASE("damp sand is in balance with what its pores hold; sand in a lake with what the lake carries of it") {
    for (const double share : {0.25, 0.45}) {
        CAPTURE(share);
        const auto held = move_drawn(damp_box(share, 0.4925, true));
        CHECK(held.sand == 0);
        CHECK(held.speed == 0);
        CHECK(move_drawn(damp_box(share, 0.4925, false), 1).sand > 0.02);
    }
    const auto lake = [](bool prestress) {
        auto scene = damp_box(1, 0, prestress);
        scene.fill(scene.fields.water, [](double, double) { return 3; });
        return move_drawn(scene, 1);
    };
    CHECK(lake(true).sand == 0);
    CHECK(lake(false).sand > 0.01);
}

TEST_CASE("the strain of sand in balance is that of its definition") {
    auto scene = flat_scene(40, 40, 0.5, 0.01);
    auto& m = scene.settings.material;
    m.friction = 0.8; // C* < 1/4
    m.slope_normal = 1.3;
    m.retention = 0.3;
    m.cohesion_dry = 1e3;
    m.cohesion_wet = 8e3;
    m.cohesion_capillary = 3e4;
    m.saturation = {0.1, 0.3, 0.8};
    scene.settings.method.prestress = true;
    scene.fill(scene.fields.sand, [](double x, double) { return 0.01 * x * x; });
    scene.fill(scene.fields.water, [](double x, double y) { return y < 1 ? 0 : 0.01 * x * x * y / 12; });
    struct Sand {
        double modulus, density; // [Pa], [kg/m3]
    };
    for (const auto& [modulus, density] : {Sand{2e5, 2000}, Sand{1.4e5, 2000}, Sand{2e5, 600}}) { // the last floats
        m.young_modulus = modulus;
        m.sand_density = density;
        auto world = make_world(scene);
        const auto sand = cells_of(*world, "sand_height"), water = cells_of(*world, "water_height");
        const auto xx = cells_of(*world, "stretch_xx"), yy = cells_of(*world, "stretch_yy"), xy = cells_of(*world, "stretch_xy");
        CHECK(yy.values == xx.values);
        CHECK(largest(xy) == 0);
        double most = 0, wrong = 0;
        int whole = 0; // cells that no neighbour bounds
        for (int j = 0; j < sand.ny; ++j) {
            for (int i = 0; i < sand.nx; ++i) {
                const double expected = balance(world->settings(), world->state().params(), sand.at(i, j), water.at(i, j));
                most = std::max(most, expected);
                wrong = std::max(wrong, xx.at(i, j) - expected);
                if (expected > 0.01 && std::fabs(xx.at(i, j) - expected) < 2e-6 * expected) ++whole;
            }
        }
        CAPTURE(whole);
        CHECK(whole > 100);
        CAPTURE(modulus);
        CAPTURE(density);
        CHECK(most > 0.01);
        CHECK(wrong < 2e-6 * most);
    }
}

TEST_CASE("prestress: the same bits on every backend, however strain is kept and a step is run, and in a loaded snapshot") {
    for (const std::string method : {"robust", "published", "published, F as it is"}) {
        auto scene = on_slope(0.1, true, [](double x, double y) { return box(x, y) * (0.2 + 0.1 * x); });
        auto& m = scene.settings.material;
        m.cohesion_wet = m.cohesion_capillary = 5e3;
        scene.fill(scene.fields.water, [](double x, double y) { return 0.3 * box(x, y); });
        if (method != "robust") {
            choose_method(scene.settings, "published");
            scene.settings.method.prestress = true;
        }
        if (method == "published, F as it is") scene.settings.method.strain_transport = StrainTransport::direct;
        scene = with_source(scene, {"source", nothing, {}, 0.2});
        scene.settings.sources[0].center[0] += 0.5;
        const auto run = [](World& world) {
            step(world, 10);
            edit_world(world, {brush(EditLayer::sand, box_middle - 0.5, box_middle, 0.7, 0.4),
                               brush(EditLayer::sand, box_middle, box_middle, 0.3, -0.3)});
            step(world, 10);
        };
        on_every_backend(scene, run);
        auto world = make_world(scene);
        const auto begun = save(*world);
        run(*world);
        const auto hash = hash_of(*world);
        auto tiled = scene;
        tiled.settings.active_tiles = 8;
        tiled.settings.fused_stages = FusedStages::never;
        auto other = make_world(tiled);
        run(*other);
        CHECK(hash_of(*other) == hash);
        auto bare = scene;
        bare.fields.sand.clear();
        bare.fields.water.clear();
        auto loaded = make_world(bare);
        REQUIRE(loaded->snapshots().load(begun));
        run(*loaded);
        CHECK(hash_of(*loaded) == hash);
    }
}

TEST_CASE("prestress: mirrored and exchanged axes give the same bits; sand without cohesion keeps those that it has without") {
    const auto run = [](bool exchanged, bool prestress, double cohesion) {
        auto scene = on_slope(0, prestress, [&](double x, double y) {
            if (exchanged) std::swap(x, y);
            return box(x, y) * (0.2 + 0.1 * x);
        });
        scene.settings.material.cohesion_dry = cohesion;
        auto world = make_world(with_source(scene, changes[4]));
        edit_world(*world, {brush(EditLayer::sand, box_middle, box_middle, 0.7, 0.4)});
        step(*world, 30);
        return cells_of(*world, "sand_height");
    };
    const auto as_drawn = run(false, true, 8e3), exchanged = run(true, true, 8e3);
    int different = 0;
    for (int j = 0; j < box_cells; ++j)
        for (int i = 0; i < box_cells; ++i)
            different += as_drawn.at(i, j) != exchanged.at(j, i) || as_drawn.at(i, j) != as_drawn.at(i, box_cells - 1 - j);
    CHECK(different == 0);
    CHECK(run(false, true, 0).values == run(false, false, 0).values);
    CHECK(run(false, false, 8e3).values != as_drawn.values);
}

TEST_CASE("prestress follows a change of material: sand that gets its elasticity, and edits behind a change of cohesion") {
    const auto scene = on_slope(0, true, box);
    auto slack = scene;
    slack.settings.material.young_modulus = 0;
    auto made = make_world(scene), switched = make_world(slack);
    const auto set = [](World& world, const char* name, double value) {
        REQUIRE(world.commands().set_material(find_material_key(name), value));
    };
    set(*switched, "young_modulus", scene.settings.material.young_modulus);
    CHECK(largest(cells_of(*made, "stretch_xx")) > 0.01);
    CHECK(cells_of(*switched, "stretch_xx").values == cells_of(*made, "stretch_xx").values);
    // The program of the edits was recorded before the change.
    const auto weak = [&](bool changed) {
        auto start = on_slope(0, true, nothing);
        const double cohesion = start.settings.material.cohesion_dry / 10;
        if (!changed) start.settings.material.cohesion_dry = cohesion;
        auto world = make_world(start);
        edit_world(*world, {brush(EditLayer::sand, 1, 1, 0.3, 0.1)});
        step(*world, 1);
        if (changed) set(*world, "cohesion_dry", cohesion);
        edit_world(*world, {brush(EditLayer::sand, box_middle, box_middle, 1, 1.5, 0)});
        step(*world, 1);
        return cells_of(*world, "stretch_xx").at(box_cells / 2, box_cells / 2);
    };
    CHECK(weak(true) > 0);
    CHECK(weak(true) == weak(false));
    // Ahead of the first step nothing of the other material's balance is left, not even its rounding; behind it sand keeps it.
    auto soft = scene, stiff = scene;
    stiff.settings.material.young_modulus *= 1.3;
    const auto bits = [&](const Scene& level, int steps_before) {
        auto world = make_world(level);
        step(*world, steps_before);
        set(*world, "young_modulus", stiff.settings.material.young_modulus);
        return cells_of(*world, "stretch_xx").values;
    };
    CHECK(bits(soft, 0) == bits(stiff, 0));
    CHECK(bits(soft, 1) != bits(stiff, 1));
}

TEST_CASE("the castle without its wave stays as it is drawn") {
    const auto kept = [](bool prestress) {
        auto scene = shipped_level("castle", 128, 64);
        auto& m = scene.settings.material;
        m.slope_normal = 1;
        m.internal_friction = 0.4;
        m.sand_viscosity = 0.05;
        m.retention = 0.4925;
        scene.settings.method.prestress = prestress;
        for (std::size_t n = 0; n < scene.fields.water.size(); ++n) scene.fields.water[n] = 0.25F * scene.fields.sand[n];
        auto world = make_world(scene);
        const auto drawn = cells_of(*world, "sand_height");
        step(*world, static_cast<int>(3 / scene.settings.dt));
        if (prestress) CHECK(sand_speed(*world) == 0);
        const double spacing = scene.settings.grid.dx;
        return relief(drawn, cells_of(*world, "sand_height"), spacing) / relief(drawn, drawn, spacing);
    };
    CHECK(kept(true) > 0.95);
    CHECK(kept(false) < 0.9);
}

TEST_CASE("prestress counts on drag and retention where the world has them, and on nothing else") {
    const auto tension = [](const std::string& off) { // over lambda + mu
        auto scene = damp_box(0.5, 0.4925, true);
        if (!off.empty()) scene.settings.effects.push_back({off, Force::off});
        auto world = make_world(scene);
        const double trace = 2 * std::log1p(static_cast<double>(cells_of(*world, "stretch_xx").at(box_cells / 2, box_cells / 2)));
        return trace * std::exp(-trace);
    };
    const Material material;
    const double share = material.water_density / material.sand_density / 2; // of half a depth of water
    const double full = (0.5 - 0.4925) / (1 - 0.4925), leaning = 1 + share * (1 - 4 * full);
    for (const std::string off : {"retention", "drag"}) {
        const double ratio = tension("") / tension(off);
        MESSAGE("without " << off << ": " << ratio << ", wanted " << leaning / (1 - share));
        CHECK(std::abs(ratio / (leaning / (1 - share)) - 1) < 1e-3);
    }
}
