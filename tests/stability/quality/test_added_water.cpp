// What rain and a discharge bring: all of it, on time, with the momentum that it has.
#include "tests/stability/quality.hpp"

using namespace wadi;
using namespace wadi::test;

TEST_CASE("a discharge arrives on time to one quantum a face however small it is, and so does rain") {
    for (const double discharge : {0.0005, 0.02, 3.0}) {
        auto scene = flat_scene(20, 20, 1, 0.01);
        scene.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, discharge}}}};
        on_every_backend(scene, [&](World& world) {
            step(world, 500);
            const double wanted = discharge * 5, got = total(cells_of(world, "water_height"));
            const double quantum = height_quantum(world.settings().method);
            MESSAGE("discharge " << discharge << ": " << got << " m3 of " << wanted);
            CHECK(std::abs(got - wanted) <= 20 * quantum * 1.01);
        });
    }
    auto scene = flat_scene(20, 20, 1, 0.01);
    scene.settings.rain = {{{0, 1e-7}}};
    auto world = make_world(scene);
    step(*world, 5000);
    CHECK(std::abs(total(cells_of(*world, "water_height")) - 400 * 5e-6) <= 400 * height_quantum(scene.settings.method));
}

TEST_CASE("rain by a map: every cell has its share of all that fell, to the quantum, however small the rate, on every backend") {
    // Without gravity nothing flows. The last rate brings more than 65536 quanta a step where it rains most.
    for (const double rate : {1.3e-6, 7e-3, 0.07}) {
        CAPTURE(rate);
        auto scene = flat_scene(20, 12, 1, 0.1);
        scene.settings.gravity = 0;
        scene.settings.method.largest_height = rate > 0.05 ? 8 : 64;
        scene.settings.rain = {{{0, rate}}};
        for (int n = 0; n < 20 * 12; ++n) scene.settings.rain_map.push_back(static_cast<float>((n * 7) % 240) / 24);
        const float peak = 239.0F / 24;
        const int steps = rate > 0.05 ? 80 : 300;
        on_every_backend(scene, [&](World& world) {
            step(world, steps);
            const auto water = cells_of(world, "water_height");
            const double quantum = height_quantum(world.settings().method);
            const double most = std::floor(steps * 0.1 * rate * static_cast<double>(peak) / quantum + 1e-6);
            double worst = 0;
            for (int n = 0; n < 20 * 12; ++n) {
                const double share =
                    std::round(static_cast<double>(scene.settings.rain_map[static_cast<std::size_t>(n)] / peak) * 65536) / 65536;
                const double due = std::floor(share * most) * quantum;
                worst = std::max(worst, std::abs(static_cast<double>(water.at(n % 20, n / 20)) - due));
            }
            MESSAGE("rain " << rate << ": " << most << " quanta where it rains most, off by " << worst / quantum);
            CHECK(most > (rate > 0.05 ? 65536 * steps : 0));
            CHECK(worst <= quantum * 1.001); // the running total is a sum of as many products
            const auto stats = stats_of(world);
            CHECK(stats.water_quanta == stats.water_initial + stats.ledger.water_in - stats.ledger.water_out);
        });
        auto uniform = scene;
        uniform.settings.effects.emplace_back("rain_map", Force::off);
        auto world = make_world(uniform);
        step(*world, steps);
        const auto water = cells_of(*world, "water_height");
        CHECK(water.at(0, 0) == water.at(13, 7)); // the control
        CHECK(water.at(0, 0) > 0);
    }
}

TEST_CASE("rain by a map brings no momentum: a stream under it slows as one under even rain") {
    const auto stream = [](int kind) {
        auto scene = flat_scene(200, 3, 1, 0.02);
        scene.fill(scene.fields.water, [](double, double) { return 1; });
        scene.fill(scene.fields.velocity_x, [](double, double) { return 1; });
        if (kind > 0) scene.settings.rain = {{{0, 0.02}}};
        if (kind > 1) scene.settings.rain_map.assign(200 * 3, 1.0F);
        auto world = make_world(scene);
        step(*world, 500); // 10 s: nothing from the ends has come to the middle
        return static_cast<double>(cells_of(*world, "water_velocity_x").at(100, 1));
    };
    const double dry = stream(0), even = stream(1), mapped = stream(2);
    MESSAGE("velocity after 10 s: " << dry << " without rain, " << even << " under even rain, " << mapped
                                    << " under a map of it");
    CHECK(dry == doctest::Approx(1).epsilon(1e-4));
    CHECK(even == doctest::Approx(1 / 1.2).epsilon(2e-3));
    CHECK(std::abs(mapped - even) < 5e-4);
}

TEST_CASE("a source with a level fills its cells up to it, keeps them there, and the books have every quantum") {
    const auto pool = [](bool drain, double rate) {
        auto scene = flat_scene(24, 16, 0.5, 0.01);
        scene.fill(scene.fields.terrain, [](double x, double y) { return 0.1 * std::hypot(x - 6, y - 4); });
        Source source;
        source.center = {6, 4};
        source.radius = 1;
        source.level.samples = {{0, 0.30001}}; // no whole quantum
        source.drain = drain;
        if (rate > 0) source.rate.samples = {{0, rate}};
        scene.settings.sources = {source};
        return scene;
    };
    const auto surface = [](World& world, int i, int j) {
        return static_cast<double>(cells_of(world, "terrain").at(i, j)) +
               static_cast<double>(cells_of(world, "water_height").at(i, j));
    };
    on_every_backend(pool(true, 0), [&](World& world) {
        step(world, 1);
        CHECK(std::abs(surface(world, 12, 8) - 0.30001) < 0.005); // at once; the step itself moves some of it
        step(world, 6000);
        const auto stats = stats_of(world);
        MESSAGE("cone: " << surface(world, 12, 8) << " m in the middle, " << surface(world, 16, 8) << " m beside");
        CHECK(std::abs(surface(world, 12, 8) - 0.30001) < 1e-4);
        CHECK(std::abs(surface(world, 16, 8) - 0.30001) < 1e-3); // outside the disc water has found the level
        CHECK(stats.water_quanta == stats.water_initial + stats.ledger.water_in - stats.ledger.water_out);
        CHECK(stats.ledger.water_in > 0);
    });
    // A rate is the most that it moves: 1 mm/s on the disc's cells.
    auto slow = make_world(pool(false, 1e-3));
    step(*slow, 100);
    const double cells = static_cast<double>(stats_of(*slow).ledger.water_in) * height_quantum(slow->settings().method) / 1e-3;
    CHECK(cells > 11);
    CHECK(cells < 13.001); // a disc of 3.14 m2 has 12 cells
    // What stands above stays, or with drain goes; control: the same without.
    for (const bool drain : {false, true}) {
        auto scene = pool(drain, 0);
        scene.fill(scene.fields.water, [](double x, double y) { return std::max(0.35 - 0.1 * std::hypot(x - 6, y - 4), 0.0); });
        auto world = make_world(scene);
        step(*world, 6000);
        const auto stats = stats_of(*world);
        MESSAGE((drain ? "drained to " : "stays at ") << surface(*world, 12, 8));
        CHECK(std::abs(surface(*world, 12, 8) - (drain ? 0.30001 : 0.35)) < 1e-3);
        CHECK((stats.ledger.water_out > 0) == drain);
        CHECK(stats.water_quanta == stats.water_initial + stats.ledger.water_in - stats.ledger.water_out);
    }
    // Under a higher ground, and where a column would pass the largest height, nothing comes.
    auto high = pool(true, 0);
    high.fill(high.fields.terrain, [](double, double) { return 1; });
    auto world = make_world(high);
    step(*world, 10);
    CHECK(total(cells_of(*world, "water_height")) == 0);
}

TEST_CASE("a source's level follows its series, and a world that is saved and loaded goes on with the same bits") {
    auto scene = flat_scene(16, 12, 0.5, 0.01);
    Source source;
    source.shape = SourceShape::box;
    source.box = {2, 2, 5, 4};
    source.level.samples = {{0, 0.1}, {1, 0.3}, {2, 0.2}};
    source.discharge.samples = {{0, 20}};
    source.drain = true;
    scene.settings.sources = {source};
    auto one = make_world(scene), other = make_world(scene);
    step(*one, 110);
    const auto bytes = save(*one);
    step(*one, 150);
    REQUIRE(other->snapshots().load(bytes));
    step(*other, 150);
    CHECK(hash_of(*one) == hash_of(*other));
    auto constant = scene;
    constant.settings.sources[0].level.samples = {{0, 0.3}};
    auto high = make_world(constant);
    step(*high, 260);
    CHECK(hash_of(*high) != hash_of(*one));
}

TEST_CASE("rain brings no velocity: a stream that it falls on keeps its momentum") {
    for (const int order : {1, 2}) {
        auto scene = flat_scene(200, 1, 0.5, 0.02);
        scene.settings.method.water_transport_order = order;
        scene.settings.rain = {{{0, 0.1}}};
        scene.fill(scene.fields.water, [](double, double) { return 1; });
        scene.fill(scene.fields.velocity_x, [](double, double) { return 1; });
        auto world = make_world(scene);
        step(*world, 200); // 0.4 m; what the ends do has run 20 m
        const double h = cells_of(*world, "water_height").at(100, 0), u = cells_of(*world, "water_velocity_x").at(100, 0);
        MESSAGE("order " << order << ": momentum " << h * u << " m2/s");
        CHECK(std::abs(h - 1.4) < 1e-3);
        CHECK(std::abs(h * u - 1) < 0.01);
    }
}

TEST_CASE("sources bring no velocity, or their own: a stream keeps its momentum along x and y, and every quantum is counted") {
    const auto stream = [](bool along_y, int order) {
        auto scene = along_y ? flat_scene(1, 200, 0.5, 0.02) : flat_scene(200, 1, 0.5, 0.02);
        scene.settings.method.water_transport_order = order;
        Source source;
        source.shape = SourceShape::box;
        source.box = {-1, -1, 101, 101};
        source.rate.samples = {{0, 0.1}};
        scene.settings.sources = {source};
        scene.fill(scene.fields.water, [](double, double) { return 1; });
        scene.fill(along_y ? scene.fields.velocity_y : scene.fields.velocity_x, [](double, double) { return 1; });
        return scene;
    };
    for (const bool along_y : {false, true})
        for (const int order : {1, 2})
            on_every_backend(stream(along_y, order), [&](World& world) {
                step(world, 200); // 0.4 m; what the ends do has run 20 m
                const int i = along_y ? 0 : 100, j = along_y ? 100 : 0;
                const double h = cells_of(world, "water_height").at(i, j);
                const double u = cells_of(world, along_y ? "water_velocity_y" : "water_velocity_x").at(i, j);
                MESSAGE((along_y ? "y" : "x") << ", order " << order << ": momentum " << h * u << " m2/s");
                CHECK(std::abs(h - 1.4) < 1e-3);
                CHECK(std::abs(h * u - 1) < 0.01);
                const auto stats = stats_of(world);
                CHECK(stats.water_quanta == stats.water_initial + stats.ledger.water_in - stats.ledger.water_out);
            });
}

TEST_CASE("a face that a source covers by half takes half of its momentum, mirrored in every bit") {
    const auto scene_of = [](double sign) {
        auto scene = flat_scene(21, 9, 1, 0.01);
        scene.settings.gravity = 0;
        Source jet;
        jet.shape = SourceShape::box;
        jet.box = {8.1, 3.1, 12.9, 5.9};
        jet.rate.samples = {{0, 10}};
        jet.set_velocity = true;
        jet.velocity = {0.3 * sign, 0};
        Source spring = jet; // within the jet's cells, without a velocity
        spring.set_velocity = false;
        spring.rate.samples = {{0, 20}};
        scene.settings.sources = {jet, spring};
        scene.fill(scene.fields.water, [](double, double) { return 0.5; });
        return scene;
    };
    const auto west = make_world(scene_of(-1)), east = make_world(scene_of(1));
    step(*west, 1);
    step(*east, 1);
    const auto u_west = cells_of(*west, "water_velocity_x"), u_east = cells_of(*east, "water_velocity_x");
    // Cells have the mean of their two faces. At the outer face of the box half of the sources' water comes, a third of it the
    // jet's.
    const double added = 0.5 * 0.3, there = 0.5, face = 0.3 * 0.5 * 0.1 / (there + added);
    MESSAGE("in the cell before " << u_east.at(7, 4) << " m/s of " << face / 2);
    CHECK(u_east.at(7, 4) == doctest::Approx(face / 2).epsilon(0.01));
    CHECK(u_east.at(8, 4) == doctest::Approx((face + 0.3) / 2).epsilon(0.01)); // its other face is held by the jet
    CHECK(u_east.at(10, 4) == doctest::Approx(0.3));
    CHECK(std::fabs(u_east.at(5, 4)) == 0);
    for (int j = 0; j < 9; ++j)
        for (int i = 0; i < 21; ++i) CHECK(u_east.at(i, j) == -u_west.at(20 - i, j));
    on_every_backend(scene_of(1), [&](World& world) {
        step(world, 50);
        const auto stats = stats_of(world);
        CHECK(stats.water_quanta == stats.water_initial + stats.ledger.water_in - stats.ledger.water_out);
    });
}

TEST_CASE("a film that brings less than a quantum a step is as deep as Manning's law says, and all of it arrives") {
    const auto over_manning = [](double dt) {
        const double q = 1e-5, slope = 0.05, manning = 0.03;
        auto scene = flat_scene(20, 1, 1, dt);
        scene.settings.material.manning = manning;
        scene.fill(scene.fields.terrain, [=](double x, double) { return slope * (20 - x); });
        scene.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, q}}}};
        scene.settings.sides[SIDE_EAST].kind = SideKind::outflow;
        auto world = make_world(scene);
        step(*world, static_cast<int>(2000 / dt));
        const auto before = stats_of(*world);
        step(*world, static_cast<int>(500 / dt));
        const auto after = stats_of(*world);
        const double out = double(after.ledger.water_out - before.ledger.water_out) * after.quantum / 500; // m2/s
        const double depth = static_cast<double>(cells_of(*world, "water_height").at(10, 0));
        const double ratio = depth / std::pow(manning * q / std::sqrt(slope), 0.6);
        MESSAGE("dt " << dt << ": " << ratio << " of Manning's depth, " << out / q << " of the flow leaves");
        CHECK(std::abs(out / q - 1) < 0.05);
        return ratio;
    };
    for (const double dt : {0.01, 0.05, 0.2}) CHECK(std::abs(over_manning(dt) - 1) < 0.03); // 0.1, 0.5, 2.1 quanta a step
}

TEST_CASE("a discharge with a depth below critical comes in that deep and fast; without it, critical") {
    const auto middle = [](double depth) {
        auto scene = flat_scene(100, 1, 0.1, 0.005);
        scene.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, 0.9 * 0.1}}}, depth};
        scene.settings.sides[SIDE_EAST].kind = SideKind::outflow;
        auto world = make_world(scene);
        step(*world, 3000);
        const auto h = cells_of(*world, "water_height");
        MESSAGE("depth " << depth << ": " << h.at(2, 0) << ", " << h.at(50, 0));
        return h.at(50, 0);
    };
    CHECK(std::abs(middle(0.25) - 0.25) < 0.005); // 3.6 m/s, Froude 2.3
    CHECK(middle(0) > 0.35);                      // critical: 0.435
}
