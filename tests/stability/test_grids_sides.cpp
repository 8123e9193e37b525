// Grids and states at their ends, a dam break against every kind of side.
#include "tests/stability/quality.hpp"

using namespace wadi;
using namespace wadi::test;

namespace {

/// A dam break in a channel along x or y, `width` cells wide, against a side of that kind at the far end.
Scene dam_break(int width, bool along_y, SideKind kind) {
    auto scene = along_y ? flat_scene(width, 60, 0.25, 0.02) : flat_scene(60, width, 0.25, 0.02);
    scene.fill(scene.fields.water, [&](double x, double y) { return (along_y ? y : x) < 6 ? 1.0 : 0.25; });
    auto& far = scene.settings.sides[along_y ? SIDE_NORTH : SIDE_EAST];
    far.kind = kind;
    if (kind == SideKind::level) far.value = {{{0, 0.25}}};
    if (kind == SideKind::discharge) far.value = {{{0, 0.1 * width * 0.25}}};
    return scene;
}

} // namespace

TEST_CASE(
    "a dam break meets a wall, an outflow, a level and a discharge: the same along x, y and in a wider channel, and smooth") {
    const auto profile = [](const Scene& scene, bool along_y) {
        auto world = make_world(scene);
        step(*world, 150);
        const auto h = cells_of(*world, "water_height");
        std::vector<double> p;
        for (int k = 0; k < 60; ++k) p.push_back(along_y ? h.at(0, k) : h.at(k, 0));
        return p;
    };
    double kept = 0;
    for (const SideKind kind : {SideKind::wall, SideKind::outflow, SideKind::level, SideKind::discharge}) {
        CAPTURE(static_cast<int>(kind));
        const auto one = profile(dam_break(1, false, kind), false);
        CHECK(one == profile(dam_break(1, true, kind), true));
        CHECK(one == profile(dam_break(5, false, kind), false));
        on_every_backend(dam_break(4, false, kind), [&](World& world) {
            const double start = water_energy(world);
            step(world, 250);
            CHECK(roughness(cells_of(world, "water_height")) < 0.04);
            const double share = water_energy(world) / start;
            if (kind == SideKind::wall) kept = share;
            if (kind == SideKind::wall) CHECK((share > 0.7 && share < 1));
            // What reaches an open side leaves: the wall is the control.
            if (kind == SideKind::outflow || kind == SideKind::level) CHECK(share < 0.7 * kept);
            if (kind == SideKind::discharge) CHECK(share > kept);
        });
    }
}

TEST_CASE("grids of one row, one column, one cell: the ledger holds, on every backend") {
    for (const auto& [nx, ny] : {std::pair{1, 1}, {1, 30}, {30, 1}, {2, 3}}) {
        CAPTURE(nx);
        CAPTURE(ny);
        auto scene = mixed_scene(nx, ny);
        scene.settings.sides[SIDE_WEST] = {SideKind::level, 0, 1e30, {{{0, 1.3}}}};
        scene.settings.sides[SIDE_NORTH] = {SideKind::outflow, 0, 1e30, {}};
        on_every_backend(scene, [](World& world) { step(world, 50); });
    }
}

TEST_CASE("dry, flooded, one wet cell, one cell of sand: nothing moves that should rest, what moves keeps the grid's symmetry") {
    const std::size_t middle = 12 * 25 + 12;
    for (const std::string state : {"dry", "flooded", "one wet cell", "one cell of sand"}) {
        CAPTURE(state);
        auto scene = flat_scene(25, 25, 0.2, 0.015);
        for (const char* effect : {"water", "sand", "mixture", "diffusion", "drag", "elastoplastic", "cohesion"})
            scene.settings.effects.push_back({effect, Force::on});
        const auto bed = [](double x, double y) { return 0.3 + 0.2 * std::sin(3 * x) * std::cos(2 * y); };
        if (state == "flooded") {
            scene.fill(scene.fields.terrain, bed);
            scene.fill(scene.fields.water, [&](double x, double y) { return 15 - bed(x, y); });
        }
        if (state == "one wet cell") scene.fields.water.assign(25 * 25, 0), scene.fields.water[middle] = 1;
        if (state == "one cell of sand") scene.fields.sand.assign(25 * 25, 0), scene.fields.sand[middle] = 1;
        const bool still = state == "dry" || state == "flooded";
        on_every_backend(scene, [&](World& world) {
            step(world, 100);
            const auto h = cells_of(world, state == "one cell of sand" ? "sand_height" : "water_height");
            if (still) CHECK(kinetic_energy(world) == 0);
            if (still) return;
            CHECK(largest(h) < 0.5); // has run out
            CHECK(checkerboard(h) < 0.02);
            bool symmetric = true;
            for (int j = 0; j < 25; ++j)
                for (int i = 0; i < 25; ++i) symmetric = symmetric && h.at(i, j) == h.at(24 - i, j) && h.at(i, j) == h.at(j, i);
            CHECK(symmetric);
        });
    }
}

TEST_CASE("cells that are not square are refused by name") {
    const auto refusal = [](const std::string& grid) {
        auto level = parse_level(R"({"format_version": 1, "name": "a", "dt": 0.01, "grid": )" + grid + "}", "", {});
        return level ? std::string() : level.status().message;
    };
    CHECK(refusal(R"({"nx": 8, "ny": 8, "dx": 1})").empty());
    CHECK(refusal(R"({"nx": 8, "ny": 8, "dx": 1, "dy": 2})").find("dy") != std::string::npos);
    CHECK(refusal(R"({"nx": 8, "ny": 8, "dx": [1, 2]})").find("dx") != std::string::npos);
}

TEST_CASE("a side lets water and sand out at the clamp's speed at most, whatever a source or the first velocities say") {
    auto scene = flat_scene(12, 6, 0.25, 0.02);
    scene.settings.sides[SIDE_WEST].kind = scene.settings.sides[SIDE_EAST].kind = SideKind::outflow;
    scene.settings.method.substeps = 1;
    scene.settings.sources = {{SourceShape::disc, SourceMaterial::water, {0.2, 0.8}, 0.6, {}, {{{0, 0.1}}}, true, {-80, 0}}};
    scene.fill(scene.fields.sand, [](double, double) { return 0.3; });
    scene.fill(scene.fields.sand_velocity_x, [](double, double) { return 50; });
    on_every_backend(scene, [](World& world) { step(world, 1); }); // the ledger includes the clamp
}

TEST_CASE("a source's discharge is the volume per time that enters, whatever cells its disc covers") {
    const double cell = 0.1, seconds = 2;
    const auto entered = [&](std::array<double, 2> center, const TimeSeries& rate, const TimeSeries& discharge) {
        auto scene = flat_scene(14, 12, cell, 0.01);
        Source source;
        source.center = center;
        source.radius = 3 * cell;
        source.rate = rate;
        source.discharge = discharge;
        scene.settings.sources = {source};
        double volume = 0;
        on_every_backend(scene, [&](World& world) {
            step(world, 200);
            const auto stats = world.reader().stats();
            REQUIRE(stats);
            volume = static_cast<double>(stats->ledger.water_in) * stats->quantum * cell * cell;
            CHECK(stats->ledger.refused == 0);
        });
        return volume;
    };
    const double disc = 3.141592653589793 * 9 * cell * cell, depth = 2.5;
    // A corner of cells, a middle with four centres on the rim itself, neither, and half of the disc outside the grid.
    for (const auto& center : {std::array<double, 2>{0.6, 0.5}, std::array<double, 2>{0.65, 0.55},
                               std::array<double, 2>{0.613, 0.581}, std::array<double, 2>{0, 0.6}}) {
        CAPTURE(center[0]);
        const double volume = depth * disc;
        const TimeSeries constant{{{0, volume / seconds}}}, ramp{{{0, 0}, {seconds, 2 * volume / seconds}}};
        CHECK(entered(center, {}, constant) == doctest::Approx(volume).epsilon(1e-6));
        CHECK(entered(center, {}, ramp) == doctest::Approx(volume * 199 / 200).epsilon(1e-6)); // each step takes its start's
        // The control: the same per area, with the area of the disc.
        CHECK(std::abs(entered(center, {{{0, depth / seconds}}}, {}) / volume - 1) > 0.01);
    }
}
