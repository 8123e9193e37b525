// Water that enters sand at a rate (NUMERICS 2.24): what runs on dry sand, what sinks into it, and what rests.
#include "engine/settings/data/quanta.hpp"
#include "engine/settings/rules/material_keys.hpp"
#include "tests/stability/quality/wet_scenes.hpp"
#include <algorithm>
#include <cmath>

using namespace wadi;
using namespace wadi::test;

namespace {

constexpr double pore_space = 0.4;

/// Dry quartz sand without cohesion.
void make_slow_sand(Material& material, double conductivity, double suction) {
    material.porosity = pore_space;
    material.sand_density = 1600;
    material.young_modulus = 0;
    material.conductivity = conductivity;
    material.suction = suction;
}

enum class FloodBed : std::uint8_t { rigid, sand };

/// How far a dam break 1 m deep has come after 3 s over a bed 0.3 m thick [m]: pores are full behind the gate and empty beyond
/// it.
double flood_front(double dx, FloodBed bed, double conductivity) {
    const int cells = static_cast<int>(std::lround(30 / dx));
    auto scene = flat_scene(cells, 2, dx, 0.04 * dx);
    make_slow_sand(scene.settings.material, conductivity, 0);
    scene.settings.material.bed_friction = 0.005;
    scene.settings.material.exchange_rate = 9810 / 1e-3; // sideways as slowly as down
    const bool sandy = bed == FloodBed::sand;
    scene.fill(sandy ? scene.fields.sand : scene.fields.terrain, [](double, double) { return 0.3; });
    scene.fill(scene.fields.water, [&](double x, double) { return x < 10 ? 1 + (sandy ? pore_space * 0.3 : 0) : 0.0; });
    auto world = make_world(scene);
    step(*world, static_cast<int>(std::lround(3 / scene.settings.dt)));
    check_books(*world);
    const auto depth = cells_of(*world, "water_depth");
    int last = 0;
    for (int i = 0; i < cells; ++i)
        if (depth.at(i, 0) > 0.01) last = i;
    return (last + 1) * dx - 10;
}

} // namespace

TEST_CASE("a flood runs on dry sand that takes it in slowly as on rigid ground") {
    for (const double dx : {0.1, 0.05}) {
        CAPTURE(dx);
        const double rigid = flood_front(dx, FloodBed::rigid, 0), slow = flood_front(dx, FloodBed::sand, 1e-3);
        MESSAGE("cells of " << dx << " m, after 3 s: " << slow << " m, on rigid ground " << rigid);
        CHECK(slow == doctest::Approx(rigid).epsilon(0.05));
        CHECK(slow <= rigid);
    }
    CHECK(flood_front(0.1, FloodBed::sand, 0) < 0.7 * flood_front(0.1, FloodBed::rigid, 0)); // control: pores that fill at once
}

namespace {

/// Water that dry sand 3 m deep has taken in under `head` of water that a source keeps there [m]. The settings' fields are dry.
struct DryColumn {
    std::unique_ptr<World> world;
    double sand = 3;

    DryColumn(double head, double conductivity, double suction, double dt) {
        auto scene = flat_scene(4, 4, 1, dt);
        make_slow_sand(scene.settings.material, conductivity, suction);
        scene.settings.material.friction = 2;
        scene.fill(scene.fields.sand, [&](double, double) { return sand; });
        Source keeps;
        keeps.shape = SourceShape::box;
        keeps.box = {0, 0, 4, 4};
        keeps.level = {{{0, sand + head}}};
        scene.settings.sources = {keeps};
        world = make_world(scene);
    }
    double taken() {
        const auto water = cells_of(*world, "water_height"), above = cells_of(*world, "water_depth");
        return water.at(1, 2) - above.at(1, 2);
    }
};

/// When Green and Ampt's front has taken in so much: K t = F - S ln(1 + F/S), S = (head + suction) n. Here the first centimetre
/// of the way counts as one from its beginning.
double green_ampt_time(double taken, double head, double conductivity, double suction) {
    const double drives = head + suction, s = drives * pore_space, first = std::min(taken, 0.01 * pore_space);
    return (first / (1 + drives / 0.01) + (taken - first) - s * std::log((taken + s) / (first + s))) / conductivity;
}

/// What that front has taken in at a time, by bisection.
double green_ampt(double time, double head, double conductivity, double suction) {
    double low = 0, high = 100;
    for (int n = 0; n < 100; ++n) {
        const double middle = (low + high) / 2;
        (green_ampt_time(middle, head, conductivity, suction) < time ? low : high) = middle;
    }
    return low;
}

} // namespace

TEST_CASE("dry sand takes in what Green and Ampt's law says, at any rate and time step") {
    struct Soaking {
        double head, conductivity, suction, dt;
        int steps;
    };
    // From 0.3 m in two minutes down to 15 mm in 1000 s, 1e-7 m and a tenth of a quantum a step without what drives it.
    for (const Soaking& c :
         {Soaking{0.2, 1e-3, 0.1, 0.02, 6000}, Soaking{0.2, 1e-3, 0.1, 0.1, 1200}, Soaking{0.2, 1e-3, 0, 0.05, 2400},
          Soaking{0.2, 1e-6, 0.1, 0.1, 10000}, Soaking{0.05, 1e-7, 0.05, 0.05, 20000}}) {
        DryColumn column(c.head, c.conductivity, c.suction, c.dt);
        for (int part = 1; part <= 4; ++part) {
            step(*column.world, c.steps / 4);
            const double taken = column.taken(), law = green_ampt(part * c.steps / 4 * c.dt, c.head, c.conductivity, c.suction);
            CAPTURE(c.conductivity);
            CAPTURE(c.dt);
            MESSAGE("K " << c.conductivity << " m/s, dt " << c.dt << ": " << taken << " m in, law " << law);
            CHECK(taken == doctest::Approx(law).epsilon(0.01));
        }
        check_books(*column.world);
        // control: without the head of water above
        CHECK(std::fabs(green_ampt(c.steps * c.dt, 0, c.conductivity, c.suction) / column.taken() - 1) > 0.05);
    }
    // Where the front has left its first centimetre far behind, the law's own form says the same.
    const double s = 0.3 * pore_space, deep = green_ampt(120, 0.2, 1e-3, 0.1);
    CHECK((deep - s * std::log(1 + deep / s)) / 1e-3 == doctest::Approx(120).epsilon(0.02));
}

TEST_CASE("what an edit or rain adds stands on dry sand, what a level begins with is in it") {
    auto scene = flat_scene(8, 8, 0.5, 0.01);
    make_slow_sand(scene.settings.material, 1e-5, 0);
    scene.fill(scene.fields.sand, [](double, double) { return 1.0; });
    scene.fill(scene.fields.water, [](double x, double) { return x < 2 ? 0.3 : 0.0; });
    scene.settings.rain = {{{0, 0.5}, {0.0949, 0.5}, {0.095, 0}}}; // ten steps
    auto world = make_world(scene);
    CHECK(largest(cells_of(*world, "water_depth")) == 0);
    step(*world, 20);
    const auto rained = cells_of(*world, "water_depth");
    CHECK(rained.at(6, 3) == doctest::Approx(0.05).epsilon(0.02));
    CHECK(rained.at(1, 3) == doctest::Approx(0.05).epsilon(0.02));
    Edit pours = brush(EditLayer::water, 2, 2, 50, 0.2, 0);
    edit_world(*world, {pours});
    step(*world, 2);
    CHECK(cells_of(*world, "water_depth").at(6, 3) == doctest::Approx(0.25).epsilon(0.02));
    pours.amount = -0.25; // from above first
    edit_world(*world, {pours});
    step(*world, 2);
    CHECK(largest(cells_of(*world, "water_depth")) < 0.001);
    CHECK(cells_of(*world, "water_height").at(1, 3) == doctest::Approx(0.3).epsilon(0.02));
    check_books(*world);
}

TEST_CASE("pores that shrink let go at once what they held: it stands on the sand that is left") {
    for (const double conductivity : {1e-6, 0.0}) { // and where pores fill at once
        CAPTURE(conductivity);
        auto scene = flat_scene(8, 8, 0.5, 0.01);
        make_slow_sand(scene.settings.material, conductivity, 0);
        scene.fill(scene.fields.sand, [](double, double) { return 1.0; });
        scene.fill(scene.fields.water,
                   [](double x, double) { return x < 2 ? 0.3 : 0.4; }); // three quarters of the pores, and all
        auto world = make_world(scene);
        step(*world, 2);
        const Edit digs = brush(EditLayer::sand, 2, 2, 50, -0.5, 0); // room is left for 0.2 m
        edit_world(*world, {digs});
        step(*world, 1);
        const auto depth = cells_of(*world, "water_depth"), water = cells_of(*world, "water_height");
        CHECK(water.at(0, 3) == doctest::Approx(0.3).epsilon(1e-5));
        CHECK(depth.at(0, 3) == doctest::Approx(0.1).epsilon(0.002));
        CHECK(depth.at(7, 3) == doctest::Approx(0.2).epsilon(0.002));
        // control: sand that stays large enough keeps all of it, though an edit took some
        auto kept = make_world(scene);
        edit_world(*kept, {brush(EditLayer::sand, 2, 2, 50, -0.25, 0)}); // room is left for 0.3 m
        step(*kept, 3);
        CHECK(cells_of(*kept, "water_depth").at(0, 3) < 1e-5);
        CHECK(cells_of(*kept, "water_depth").at(7, 3) == doctest::Approx(0.1).epsilon(0.002));
        check_books(*world);
        check_books(*kept);
    }
}

TEST_CASE("a lake over soaked sand feels nothing when a host makes its sand tight") {
    auto scene = flat_scene(24, 6, 0.25, 0.01);
    make_slow_sand(scene.settings.material, 0, 0);
    scene.fill(scene.fields.sand, [](double x, double) { return 0.3 + 0.25 * std::floor(x); });
    scene.fill(scene.fields.water, [](double x, double) { return std::max(0.0, 2 - 0.6 * (0.3 + 0.25 * std::floor(x))); });
    scene.settings.material.friction = 3;
    auto world = make_world(scene);
    step(*world, 5);
    const auto before = cells_of(*world, "water_height").values;
    REQUIRE(world->commands().set_material(find_material_key("conductivity"), 1e-4));
    step(*world, 50);
    double off = 0;
    const auto after = cells_of(*world, "water_height").values;
    for (std::size_t c = 0; c < before.size(); ++c) off = std::max(off, std::fabs(static_cast<double>(after[c] - before[c])));
    CHECK(off < 1e-4);
    check_books(*world);
}

TEST_CASE("water that enters sand at a rate: the same bits on every backend, over tiles, from a save, no quantum lost") {
    for (const double conductivity : {1e-7, 1e-3, 1.0}) {
        CAPTURE(conductivity);
        auto scene = mixed_scene_with_sides(70, 45);
        scene.settings.material.porosity = pore_space;
        scene.settings.material.conductivity = conductivity;
        on_every_backend(scene, [](World& w) { step(w, 40); });
        auto tiled = scene;
        scene.settings.active_tiles = 0;
        tiled.settings.active_tiles = 16;
        auto whole = make_world(scene), parts = make_world(tiled);
        step(*whole, 40);
        const auto saved = save(*whole);
        step(*whole, 40);
        step(*parts, 80);
        CHECK(hash_of(*parts) == hash_of(*whole));
        auto again = make_world(scene);
        REQUIRE(again->snapshots().load(saved));
        step(*again, 40);
        CHECK(hash_of(*again) == hash_of(*whole));
        check_books(*whole);
    }
}
