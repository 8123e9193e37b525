// What water carries and leaves to be seen (NUMERICS 2.25 to 2.27): how much foam a bore makes, where there is none, what lies on
// the shore; where water is muddy and when it clears; and that all of it moves nothing.
#include "tests/stability/quality.hpp"
#include <cstring>

using namespace wadi;
using namespace wadi::test;

namespace {

Scene with_traces(Scene scene) {
    scene.settings.effects = {{"foam", Force::on}, {"wetness", Force::on}};
    return scene;
}

/// A bore that runs against a stream which a wall has stopped. h2: depth behind it, c: its speed from the wall, by the laws of
/// mass and momentum.
struct WallBore {
    double h1, u, h2 = 0, c = 0;
    WallBore(double depth, double speed) : h1(depth), u(speed) {
        double low = h1, high = 10 * h1;
        for (int n = 0; n < 100; ++n) {
            h2 = (low + high) / 2;
            c = u * h1 / (h2 - h1);
            const double pushes = 9.81 * h2 * (h2 + h1) / (2 * h1); // (c + u)^2
            ((c + u) * (c + u) > pushes ? low : high) = h2;
        }
    }
    /// Power that a metre of it loses [W/m].
    double lost() const { return 1000 * 9.81 * std::pow(h2 - h1, 3) / (4 * h1 * h2) * h1 * (c + u); }
};

/// A pond whose wave runs up a beach and back; the beach begins at 4 m, the shore is at 6 m.
Scene beach(int nx, int ny) {
    auto scene = flat_scene(nx, ny, 0.25, 0.01);
    const auto ground = [](double x) { return std::max(0.0, 0.2 * (x - 4)); };
    scene.fill(scene.fields.terrain, [&](double x, double) { return ground(x); });
    scene.fill(scene.fields.water, [&](double x, double) { return std::max(0.0, (x < 2 ? 0.8 : 0.4) - ground(x)); });
    return scene;
}

} // namespace

TEST_CASE("foam from a bore has the energy that the bore loses") {
    struct Run {
        double dx, depth, speed;
    };
    for (const auto& [dx, depth, speed] :
         {Run{0.2, 0.3, 2}, Run{0.1, 0.3, 2}, Run{0.05, 0.3, 2}, Run{0.1, 0.3, 1}, Run{0.1, 0.1, 3}}) {
        const WallBore bore(depth, speed);
        const int cells = static_cast<int>(std::lround(30 / dx));
        auto scene = with_traces(flat_scene(cells, 2, dx, 0.05 * dx));
        scene.settings.surface.foam_energy = 1e6; // far from a full cover
        scene.settings.surface.foam_half_life = 0;
        scene.fill(scene.fields.water, [&](double, double) { return bore.h1; });
        scene.fill(scene.fields.velocity_x, [&](double, double) { return bore.u; }); // towards the wall in the east
        auto world = make_world(scene);
        const auto energy = [&] { return total(cells_of(*world, "surface_foam")) / 2 * dx * 1e6; };
        step(*world, static_cast<int>(std::lround(1 / scene.settings.dt)));
        const double before = energy();
        step(*world, static_cast<int>(std::lround(2 / scene.settings.dt)));
        const double got = (energy() - before) / 2;
        MESSAGE("cells of " << dx << " m, from " << depth << " to " << bore.h2 << " m: " << got << " W/m of " << bore.lost());
        CHECK(got > 0.7 * bore.lost());
        CHECK(got < 1.35 * bore.lost());
    }
}

TEST_CASE("where nothing breaks there is no foam: a lake, a stream, a wave") {
    auto lake = with_traces(flat_scene(40, 4, 0.25, 0.01));
    lake.fill(lake.fields.water, [](double, double) { return 0.5; });
    auto wave = lake;
    wave.fill(wave.fields.water, [](double x, double) { return 0.5 + 0.03 * std::cos(x * 3.14159265 / 10); });
    auto stream = lake;
    stream.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, 0.3}}}};
    stream.settings.sides[SIDE_EAST] = {SideKind::outflow, 0, 1e30, {}};
    stream.fill(stream.fields.velocity_x, [](double, double) { return 0.6; });
    for (const Scene& scene : {lake, wave, stream}) {
        auto world = make_world(scene);
        step(*world, 1000);
        CHECK(largest(cells_of(*world, "surface_foam")) == 0);
        CHECK(total(cells_of(*world, "wetness")) == 40 * 4);
    }
    auto surge = lake; // the control
    surge.fill(surge.fields.water, [](double x, double) { return x < 5 ? 1 : 0.2; });
    auto world = make_world(surge);
    step(*world, 100);
    CHECK(largest(cells_of(*world, "surface_foam")) > 0.1);
}

TEST_CASE("foam is at walls that water runs against and at the foot of a fall, and none above it") {
    auto scene = with_traces(flat_scene(60, 3, 0.25, 0.01));
    scene.settings.surface.foam_energy = 150;
    scene.fill(scene.fields.terrain, [](double x, double) { return x < 6 ? 1.5 : 0; });
    scene.fill(scene.fields.water, [](double x, double) { return x < 6 ? 0.2 : 0.4; });
    scene.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, 0.15}}}};
    scene.settings.sides[SIDE_EAST] = {SideKind::level, 0, 1e30, {{{0, 0.4}}}};
    auto fall = make_world(scene);
    step(*fall, 1500);
    const auto foam = cells_of(*fall, "surface_foam");
    double above = 0, foot = 0;
    for (int i = 0; i < 22; ++i) above = std::max(above, foam.at(i, 1));
    for (int i = 24; i < 32; ++i) foot = std::max(foot, foam.at(i, 1));
    MESSAGE("foam " << above << " above the fall, " << foot << " at its foot");
    CHECK(above == 0);
    CHECK(foot > 0.3);

    auto wall = with_traces(flat_scene(40, 3, 0.25, 0.01));
    wall.fill(wall.fields.water, [](double, double) { return 0.3; });
    wall.fill(wall.fields.velocity_x, [](double, double) { return 2; });
    auto against = make_world(wall);
    step(*against, 20);
    const auto hit = cells_of(*against, "surface_foam");
    CHECK(hit.at(39, 1) > 0.3);
    CHECK(hit.at(20, 1) == 0);
}

TEST_CASE("a wave leaves foam and wet ground on the beach; on every backend, with tiles and fused, by the same bits") {
    auto scene = with_traces(beach(48, 8));
    scene.settings.surface.foam_energy = 0.5;
    scene.settings.evaporation = {{{0, 1e-4}}}; // dries the last film
    const int steps = 600;
    on_every_backend(scene, [&](World& world) {
        int not_wet = 0, not_clean = 0, still_wet = 0;
        double lies = 0, dries = 1;
        for (int n = 0; n < steps; n += 10) {
            step(world, 10);
            const auto depth = cells_of(world, "water_depth"), foam = cells_of(world, "surface_foam"),
                       wetness = cells_of(world, "wetness");
            for (int j = 0; j < 8; ++j) {
                for (int i = 0; i < 48; ++i) {
                    if (depth.at(i, j) > 1e-5) {
                        not_wet += wetness.at(i, j) < 1 ? 1 : 0;
                    } else if (wetness.at(i, j) > 0) { // has been under water
                        still_wet += 1;
                        lies = std::max(lies, foam.at(i, j));
                        dries = std::min(dries, wetness.at(i, j));
                    } else {
                        not_clean += foam.at(i, j) > 0 ? 1 : 0;
                    }
                }
            }
        }
        MESSAGE("on dry ground: foam up to " << lies << ", wetness down to " << dries);
        CHECK(not_wet == 0);
        CHECK(not_clean == 0);
        CHECK(still_wet > 0);
        CHECK(lies > 0.02);
        CHECK(dries < 1);
    });
    auto plain = make_world(scene);
    step(*plain, steps);
    for (const int side : {8, 32}) {
        for (const auto fused : {FusedStages::never, FusedStages::always}) {
            auto other = scene;
            other.settings.active_tiles = side;
            other.settings.fused_stages = fused;
            auto world = make_world(other);
            step(*world, steps);
            CHECK(hash_of(*world) == hash_of(*plain));
        }
    }
}

TEST_CASE("traces move nothing, cost nothing where they are off, are saved, and let the world fall asleep") {
    auto scene = beach(64, 16);
    auto plain = make_world(scene);
    auto traced = make_world(with_traces(scene));
    auto set = scene;
    set.settings.surface = {1, 1, 1};
    auto off = make_world(set);
    for (World* world : {plain.get(), traced.get(), off.get()}) step(*world, 300);
    CHECK(hash_of(*off) == hash_of(*plain));
    CHECK(hash_of(*traced) != hash_of(*plain));
    CHECK(off->plan().find("surface_foam") == nullptr);
    CHECK(off->plan().find("wetness") == nullptr);
    CHECK(off->plan().water_passes.size() + 2 == traced->plan().water_passes.size());
    CHECK(largest(cells_of(*off, "surface_foam")) == 0); // what is not there reads as 0
    for (const auto& [name, values] : state_of(*plain)) {
        const auto other = traced->reader().read_raw(name);
        REQUIRE(other);
        CHECK_MESSAGE(std::memcmp(values.data(), other->data(), values.size() * 4) == 0, name);
    }
    CHECK(largest(cells_of(*traced, "surface_foam")) > 0);
    const auto bytes = save(*traced);
    auto loaded = make_world(with_traces(scene));
    REQUIRE(loaded->snapshots().load(bytes));
    CHECK(hash_of(*loaded) == hash_of(*traced));
    step(*loaded, 50);
    step(*traced, 50);
    CHECK(hash_of(*loaded) == hash_of(*traced));
}

TEST_CASE("a world with traces falls asleep once they have faded, by the bits of one that never sleeps") {
    // Water that a heap stirs up, until all of it is taken away.
    auto scene = with_traces(flat_scene(40, 24, 0.25, 0.02));
    scene.settings.surface = {1, 20, 0.25};
    scene.fill(scene.fields.water, [](double x, double) { return x < 2 ? 0.5 : 0.1; });
    scene.settings.active_tiles = 8;
    auto world = make_world(scene);
    scene.settings.active_tiles = 0;
    auto dense = make_world(scene);
    const auto both = [&](auto run) {
        run(*world);
        run(*dense);
    };
    both([](World& each) {
        step(each, 20);
        edit_world(each, {brush(EditLayer::water, 5, 3, 20, -1, 0)});
        step(each, 20);
    });
    CHECK(largest(cells_of(*world, "water_height")) == 0);
    CHECK(stats_of(*world).active_tiles > 0);
    const double foam = largest(cells_of(*world, "surface_foam")), wet = cells_of(*world, "wetness").at(32, 12);
    MESSAGE("20 steps after: foam " << foam << ", wetness " << wet);
    CHECK(foam > 0.05);
    CHECK(wet == doctest::Approx(std::exp2(-0.4 / 0.25)).epsilon(1e-3));
    int steps = 40;
    for (; steps < 2000 && stats_of(*world).active_tiles > 0; steps += 20) both([](World& each) { step(each, 20); });
    MESSAGE("asleep after " << steps << " steps");
    CHECK(stats_of(*world).active_tiles == 0);
    CHECK(largest(cells_of(*world, "surface_foam")) == 0);
    CHECK(largest(cells_of(*world, "wetness")) == 0);
    CHECK(hash_of(*world) == hash_of(*dense));
}

TEST_CASE("a stream over sand gets muddy and one over rock clears, as the law of its load says") {
    // q = 0.4 m2/s over 25 m of sand and 25 m of rock. With the load F = S q/h that passes a section, dF/dx = E - w_s F/q.
    constexpr double q = 0.4, sinks = 0.02, rate = 0.01, least = 0.5, dx = 0.25;
    auto scene = flat_scene(200, 3, dx, 0.01);
    scene.settings.effects = {{"silt", Force::on}};
    scene.settings.surface.silt_speed = least;
    scene.settings.surface.silt_rate = rate;
    scene.settings.surface.silt_settling = sinks;
    scene.fill(scene.fields.terrain, [](double x, double) { return x < 25 ? -0.2 : 0; });
    scene.fill(scene.fields.sand, [](double x, double) { return x < 25 ? 0.2 : 0; });
    scene.fill(scene.fields.water, [](double x, double) { return x < 25 ? 0.6 : 0.4; });
    scene.fill(scene.fields.velocity_x, [](double, double) { return 1; });
    scene.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, q * 3 * dx}}}};
    scene.settings.sides[SIDE_EAST] = {SideKind::level, 0, 1e30, {{{0, 0.4}}}};
    scene.settings.material.friction = 5; // sand that stays
    auto stream = make_world(scene);
    step(*stream, 6000);
    const auto silt = cells_of(*stream, "silt"), depth = cells_of(*stream, "water_depth");
    double passes = 0;
    for (int i = 0; i < 199; ++i) {
        const double h = depth.at(i, 1), u = q / h;
        const double end = i < 100 ? rate * (u * u / (least * least) / std::cbrt(h) - 1) * q / sinks : 0;
        passes = end + (passes - end) * std::exp(-sinks * dx / q);
        if (i % 40 != 30) continue;
        MESSAGE("cell " << i << ": " << silt.at(i, 1) << " kg/m2, by the law " << passes / u);
        CHECK(silt.at(i, 1) == doctest::Approx(passes / u).epsilon(0.02));
    }
    CHECK(silt.at(98, 1) > 2 * silt.at(190, 1));
}

TEST_CASE("mud moves nothing, is saved, goes by the same bits with tiles and fused, and settles so that the world falls asleep") {
    auto scene = beach(48, 8);
    scene.settings.surface.silt_speed = 0.2;
    scene.settings.surface.silt_settling = 0.05;
    scene.fill(scene.fields.sand, [](double x, double) { return x > 3 && x < 7 ? 0.3 : 0; });
    auto muddy = scene;
    muddy.settings.effects = {{"silt", Force::on}};
    auto plain = make_world(scene), stirred = make_world(muddy);
    for (World* world : {plain.get(), stirred.get()}) step(*world, 300);
    CHECK(largest(cells_of(*stirred, "silt")) > 0.01);
    CHECK(largest(cells_of(*plain, "silt")) == 0);
    CHECK(plain->plan().water_passes.size() + 1 == stirred->plan().water_passes.size());
    for (const auto& [name, values] : state_of(*plain)) {
        const auto other = stirred->reader().read_raw(name);
        REQUIRE(other);
        CHECK_MESSAGE(std::memcmp(values.data(), other->data(), values.size() * 4) == 0, name);
    }
    auto loaded = make_world(muddy);
    REQUIRE(loaded->snapshots().load(save(*stirred)));
    CHECK(hash_of(*loaded) == hash_of(*stirred));
    on_every_backend(muddy, [&](World& world) {
        step(world, 300);
        CHECK(hash_of(world) == hash_of(*stirred));
    });
    auto tiled = muddy;
    tiled.settings.active_tiles = 8;
    for (const auto fused : {FusedStages::never, FusedStages::always}) {
        tiled.settings.fused_stages = fused;
        auto world = make_world(tiled);
        step(*world, 300);
        CHECK(hash_of(*world) == hash_of(*stirred));
    }

    // Still water clears, and a world at rest sleeps.
    auto pond = flat_scene(32, 16, 0.25, 0.02);
    pond.settings.effects = {{"silt", Force::on}};
    pond.settings.surface.silt_speed = 0.1;
    pond.settings.surface.silt_settling = 0.1;
    pond.settings.active_tiles = 8;
    pond.fill(pond.fields.sand, [](double, double) { return 0.1; });
    pond.fill(pond.fields.water, [](double x, double) { return x < 2 ? 0.45 : 0.3; });
    auto world = make_world(pond);
    step(*world, 50);
    const double early = largest(cells_of(*world, "silt"));
    CHECK(early > 1e-3);
    int steps = 50;
    for (; steps < 6000 && largest(cells_of(*world, "silt")) > 0; steps += 50) step(*world, 50);
    MESSAGE("up to " << early << " kg/m2, clear after " << steps << " steps");
    CHECK(largest(cells_of(*world, "silt")) == 0);
}
