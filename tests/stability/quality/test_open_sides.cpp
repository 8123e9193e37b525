// Open sides of water against the same channel that goes on.
#include "tests/stability/quality.hpp"
#include <functional>
#include <numbers>

using namespace wadi;
using namespace wadi::test;

namespace {

constexpr double rubs = 0.02; // bed friction of streams: their beds fall by 0.001 and more

/// A channel 20 m long, or `times` as long, in which a stream of that Froude number is in balance with the fall of its bed, which
/// its west end feeds; water 1 m deep above `sand` [m] that does not move, and a wave of 2 cm that runs east, 1 m wide at 0.6 of
/// its height.
Scene pulse_channel(double froude, int times, int order, double sand) {
    auto scene = flat_scene(200 * times, 1, 0.1, 0.01);
    scene.settings.material.young_modulus = 0;
    scene.settings.material.friction = 2;
    scene.settings.material.exchange_rate = 1e7; // and lets no water through
    scene.settings.material.bed_friction = froude > 0 ? rubs : 0;
    scene.settings.method.water_transport_order = order;
    scene.settings.method.rest_rule = false;
    const double speed = froude * std::sqrt(9.81), slope = rubs * froude * froude;
    const auto wave = [](double x) { return 0.02 * std::exp(-std::pow(x - 10, 2) / 2); };
    scene.fill(scene.fields.terrain, [=](double x, double) { return slope * (60 - x); });
    scene.fill(scene.fields.sand, [&](double, double) { return sand; });
    scene.fill(scene.fields.water, [&](double x, double) { return sand + 1 + wave(x); });
    scene.fill(scene.fields.velocity_x, [&](double x, double) { return speed + std::sqrt(9.81) * wave(x); });
    if (froude > 0) scene.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, speed * 0.1}}}};
    return scene;
}

/// A side whose level is that of the stream in the last cell.
Side at_stream(SideKind kind, double froude, double sand = 0) {
    return {kind, 0, 1e30, {{{0, rubs * froude * froude * (60 - 19.95) + sand + 1}}}};
}

/// What of the wave comes back from an end of that kind, as a share of its height: how far the channel differs, once the wave has
/// met the end, from one that goes on.
double comes_back(double froude, const Side& end, int order, double sand = 0) {
    auto ending = pulse_channel(froude, 1, order, sand);
    ending.settings.sides[SIDE_EAST] = end;
    auto world = make_world(ending), longer = make_world(pulse_channel(froude, 3, order, sand));
    const double c = std::sqrt(9.81);
    const int steps = static_cast<int>((10 / (c * (1 + froude)) + 8 / (c * (1 - froude))) / 0.01);
    step(*world, steps), step(*longer, steps);
    const auto h = cells_of(*world, "water_height"), free = cells_of(*longer, "water_height");
    double most = 0;
    for (int i = 0; i < 200; ++i) most = std::max(most, static_cast<double>(std::abs(h.at(i, 0) - free.at(i, 0))));
    MESSAGE("order " << order << ", Froude " << froude << ", sand " << sand << " m, side " << static_cast<int>(end.kind) << ": "
                     << most / 0.02);
    return most / 0.02;
}

} // namespace

TEST_CASE(
    "outflow and waves sides let a wave out, in still water, in streams and above sand, at both orders; a wall and a held level "
    "send it back") {
    for (const int order : {1, 2}) {
        for (const double froude : {0.0, 0.3, 0.6}) {
            CHECK(comes_back(froude, {SideKind::outflow, 0, 1e30, {}}, order) < (order == 1 ? 0.025 : 0.04));
            CHECK(comes_back(froude, at_stream(SideKind::waves, froude), order) < 0.025);
        }
        for (const double sand : {0.5, 3.0}) CHECK(comes_back(0, {SideKind::outflow, 0, 1e30, {}}, order, sand) < 0.025);
        CHECK(comes_back(0, {}, order) > 0.9);
        CHECK(comes_back(0, at_stream(SideKind::level, 0), order) > 0.9);
        auto absorbs = at_stream(SideKind::level, 0);
        absorbs.absorb = 20;
        CHECK(comes_back(0, absorbs, order) < 0.025);
    }
}

namespace {

/// Depths in the middle of a river of 1 m2/s and 100 m after 500 and 1000 s, from three starts: near its normal depth, dry, and
/// drowned to twice that depth above the highest bed.
std::vector<double> river_depths(const std::function<double(double)>& bed, double fall, int order, double given = 0) {
    const double drag = 0.01, normal = std::cbrt(drag / (9.81 * fall));
    std::vector<double> depths;
    for (const int start : {0, 1, 2}) {
        auto scene = flat_scene(100, 1, 1, 0.3 / (std::sqrt(9.81 * 2.5 * normal) + 1 / normal));
        scene.settings.method.water_transport_order = order;
        scene.settings.material.bed_friction = drag;
        scene.fill(scene.fields.terrain, [&](double x, double) { return bed(x); });
        double top = 0;
        for (int i = 0; i < 100; ++i) top = std::max(top, bed(i + 0.5));
        scene.fill(scene.fields.water, [&](double x, double) {
            return start == 0 ? normal : start == 1 ? 0 : 2 * normal + top - bed(x);
        });
        scene.fill(scene.fields.velocity_x, [&](double, double) { return start == 0 ? 1 / normal : 0; });
        scene.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, 1}}}};
        scene.settings.sides[SIDE_EAST].kind = SideKind::outflow;
        scene.settings.sides[SIDE_EAST].slope = given;
        auto world = make_world(scene);
        for (const double seconds : {500.0, 500.0}) {
            step(*world, static_cast<int>(seconds / scene.settings.dt));
            depths.push_back(cells_of(*world, "water_height").at(50, 0));
        }
    }
    MESSAGE("order " << order << ", fall " << fall << ", normal depth " << normal << ": " << depths[0] << ", " << depths[1]
                     << "; " << depths[2] << ", " << depths[3] << "; " << depths[4] << ", " << depths[5]);
    return depths;
}

} // namespace

TEST_CASE("a river leaves over an outflow side as deep as it is, whatever its last cells and its start") {
    const auto falls = [](double slope) { return [=](double x) { return slope * (100 - x); }; };
    const auto sill = [](double high) { return [=](double x) { return 1e-3 * (100 - x) + (x > 99 ? high : 0); }; };
    const auto ends_level = [](double x) { return 1e-3 * (100 - std::min(x, 90.0)); };
    const auto check = [](const std::vector<double>& depths, double right) {
        for (const double depth : depths) CHECK(std::abs(depth / right - 1) < 0.02);
    };
    for (const int order : {1, 2}) {
        for (const double slope : {1e-3, 5e-3, 2e-2, 4e-2})
            check(river_depths(falls(slope), slope, order), std::cbrt(0.01 / (9.81 * slope)));
        for (const double high : {0.02, 0.05, 0.1}) check(river_depths(sill(high), 1e-3, order), 1.009);
        check(river_depths(ends_level, 1e-3, order), 1.01);
    }
}

TEST_CASE("an outflow side leaves fast streams and even slopes alone, every kind lakes over rough ground") {
    for (const int order : {1, 2}) {
        // Fast: what no wave can run up leaves as it comes.
        const auto depths = [&](int times) {
            auto scene = flat_scene(80 * times, 1, 0.1, 0.01);
            scene.settings.method.water_transport_order = order;
            scene.fill(scene.fields.water, [](double x, double) { return 0.2 + (x > 3 ? 0 : 0.1); });
            scene.fill(scene.fields.velocity_x, [](double, double) { return 3.0; });
            scene.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, 0.09}}}};
            scene.settings.sides[SIDE_EAST].kind = SideKind::outflow;
            auto world = make_world(scene);
            step(*world, 250);
            return cells_of(*world, "water_height");
        };
        const auto one = depths(1), three = depths(3);
        double most = 0;
        for (int i = 0; i < 80; ++i) most = std::max(most, static_cast<double>(std::abs(one.at(i, 0) - three.at(i, 0))));
        MESSAGE("fast: " << most);
        CHECK(most < 0.002);
        // Uniform flow down a slope is as deep in the last cell as inside: its surface falls there without a wave.
        auto slope = flat_scene(100, 1, 0.5, 0.02);
        slope.settings.method.water_transport_order = order;
        slope.fill(slope.fields.terrain, [](double x, double) { return 1 - 0.01 * x; });
        slope.fill(slope.fields.water, [](double, double) { return 0.5; });
        slope.settings.material.bed_friction = 0.02;
        const double speed = std::sqrt(9.81 * 0.01 * 0.5 / 0.02);
        slope.fill(slope.fields.velocity_x, [=](double, double) { return speed; });
        slope.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, 0.5 * speed * 0.5}}}};
        slope.settings.sides[SIDE_EAST].kind = SideKind::outflow;
        auto stream = make_world(slope);
        step(*stream, 5000);
        const auto h = cells_of(*stream, "water_height");
        MESSAGE("slope: " << h.at(50, 0) << " and " << h.at(99, 0));
        CHECK(std::abs(h.at(99, 0) - h.at(60, 0)) < 0.01);
        // A lake stands on uneven ground at the side, to the bit.
        auto lake = flat_scene(30, 20, 0.2, 0.015);
        lake.settings.method.water_transport_order = order;
        const auto bed = [](double x, double y) { return 0.3 + 0.2 * std::sin(3 * x) * std::cos(2 * y); };
        lake.fill(lake.fields.terrain, bed);
        lake.fill(lake.fields.water, [&](double x, double y) { return 1 - bed(x, y); });
        auto absorbs = at_stream(SideKind::level, 0);
        absorbs.absorb = 1;
        for (const Side& kind :
             {Side{SideKind::outflow, 0, 1e30, {}}, at_stream(SideKind::level, 0), at_stream(SideKind::waves, 0), absorbs}) {
            for (auto& side : lake.settings.sides) side = kind;
            on_every_backend(lake, [](World& world) {
                step(world, 1); // sets what sides remember
                const auto before = hash_of(world);
                const auto stood = cells_of(world, "water_height").values;
                step(world, 100);
                CHECK(hash_of(world) == before);
                CHECK(cells_of(world, "water_height").values == stood);
            });
        }
    }
}

TEST_CASE("a level side holds: gates between tail water and free fall, tides at a basin's mouth, a stream's end") {
    for (const int order : {1, 2}) {
        // A tank 1 m deep beside a sea: by Riemann's invariant the side gives h 2 (sqrt(g) - sqrt(g h)), critical at most.
        for (const double sea : {0.2, 0.6, 0.8, 0.95, 1.2}) {
            auto scene = flat_scene(200, 1, 0.5, 0.02);
            scene.settings.method.water_transport_order = order;
            scene.fill(scene.fields.water, [](double, double) { return 1; });
            scene.settings.sides[SIDE_EAST] = {SideKind::level, 0, 1e30, {{{0, sea}}}};
            auto world = make_world(scene);
            step(*world, 250);
            const double early = total(cells_of(*world, "water_height"));
            step(*world, 250);
            const double flow = (early - total(cells_of(*world, "water_height"))) * 0.5 / 5, g = 9.81;
            const double deep = std::max(sea, 4.0 / 9);                                   // critical behind it
            const double exact = sea > 1 ? -sea * 2 * (std::sqrt(g * sea) - std::sqrt(g)) // to first order in the jump
                                         : deep * 2 * (std::sqrt(g) - std::sqrt(g * deep));
            MESSAGE("order " << order << ", sea at " << sea << ": " << flow / exact);
            CHECK(std::abs(flow / exact - 1) < (sea > 1 || sea < 0.4 ? 0.03 : 0.01));
        }
    }
    for (const double period : {400.0, 800.0}) { // 9 and 18 times what a wave takes through the basin
        auto scene = flat_scene(50, 1, 4, 0.2);
        scene.fill(scene.fields.water, [](double, double) { return 2; });
        auto& mouth = scene.settings.sides[SIDE_EAST] = {SideKind::level, 0, 1e30, {}};
        for (int n = 0; n <= 400; ++n)
            mouth.value.samples.push_back({n * period / 100, 2 + 0.1 * (1 - std::cos(2 * std::numbers::pi * n / 100))});
        auto world = make_world(scene);
        const int steps = static_cast<int>(period / 0.2 / 50);
        double low = 9, high = 0;
        for (int n = 0; n < 200; ++n) {
            step(*world, steps);
            const double h = cells_of(*world, "water_height").at(49, 0);
            if (n >= 100) low = std::min(low, h), high = std::max(high, h);
        }
        MESSAGE("tide of " << period << " s: half its range " << (high - low) / 2);
        CHECK(std::abs((high - low) / 0.2 - 1) < (period > 500 ? 0.01 : 0.03));
    }
    // A basin 0.1 m below waves without any, and a stream that began with that depth but not with that speed.
    for (const auto& [kind, discharge, order] : {std::tuple{SideKind::waves, 0.0, 1},
                                                 {SideKind::waves, 0.5, 1},
                                                 {SideKind::waves, 0.0, 2},
                                                 {SideKind::level, 0.5, 1},
                                                 {SideKind::level, 0.5, 2}}) {
        auto scene = flat_scene(100, 1, 0.1, 0.01);
        scene.settings.method.water_transport_order = order;
        scene.settings.method.rest_rule = false;     // the rule would stop the last millimetres
        scene.settings.material.bed_friction = 0.01; // the stream's surface falls towards its end
        scene.fill(scene.fields.water, [](double, double) { return 0.9; });
        scene.settings.sides[SIDE_EAST] = {kind, 0, 1e30, {{{0, 1}}}};
        if (discharge > 0) scene.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, discharge * 0.1}}}};
        auto world = make_world(scene);
        step(*world, 500);
        const double early = std::abs(cells_of(*world, "water_height").at(99, 0) - 1);
        step(*world, 11500);
        const double late = std::abs(cells_of(*world, "water_height").at(99, 0) - 1);
        MESSAGE("off its level after 5 s: " << early << ", after 120 s: " << late);
        CHECK(late < 1e-3);
    }
}

TEST_CASE("what stands above a brink drains over it at critical speed, and a stream falls off it critical") {
    for (const int order : {1, 2}) {
        auto scene = flat_scene(200, 1, 0.5, 0.02);
        scene.settings.method.water_transport_order = order;
        scene.fill(scene.fields.water, [](double, double) { return 1; });
        scene.settings.sides[SIDE_EAST].kind = SideKind::brink;
        auto world = make_world(scene);
        step(*world, 250);
        const double early = total(cells_of(*world, "water_height"));
        step(*world, 250);
        const double flow = (early - total(cells_of(*world, "water_height"))) * 0.5 / 5;
        const double exact = 8.0 / 27 * std::sqrt(9.81); // a dam break's at the dam
        MESSAGE("order " << order << ": " << flow / exact);
        CHECK(std::abs(flow / exact - 1) < 0.02);
        step(*world, 50000);
        const double left = cells_of(*world, "water_height").at(199, 0);
        MESSAGE("left " << left);
        CHECK(left < 0.01);
    }
}

TEST_CASE("waves come in through a side of waves as high as they are") {
    // A wave of 2 cm and 10 m, for as long as it does not reach the far end.
    auto sea = flat_scene(1000, 1, 0.1, 0.01);
    sea.fill(sea.fields.water, [](double, double) { return 1; });
    const double period = 10 / std::sqrt(9.81);
    auto& side = sea.settings.sides[SIDE_WEST] = {SideKind::waves, 0, 1e30, {{{0, 1}}}};
    for (int n = 0; n <= 1000; ++n)
        side.wave.samples.push_back({n * 0.03, 0.02 * std::sin(2 * std::numbers::pi * n * 0.03 / period)});
    auto world = make_world(sea);
    step(*world, 2500);
    const auto h = cells_of(*world, "water_height");
    double high = 0, low = 2;
    for (int i = 100; i < 400; ++i) high = std::max(high, double(h.at(i, 0))), low = std::min(low, double(h.at(i, 0)));
    MESSAGE("wave from " << low - 1 << " to " << high - 1);
    CHECK(high - 1 > 0.018);
    CHECK(high - 1 < 0.021);
    CHECK(low - 1 < -0.018);
    CHECK(low - 1 > -0.021);
}

namespace {

/// A channel of 48 m between two sides of waves, water of 4 m, over `sand` metres of sand or solid ground: waves of 10 cm and 8 s
/// come in from the west for five periods and leave in the east.
Scene wave_channel(double dx, double sand, double exchange, int order) {
    auto scene = flat_scene(static_cast<int>(48 / dx), 1, dx, 0.02 * dx);
    scene.settings.method.water_transport_order = order;
    scene.settings.material.exchange_rate = exchange;
    scene.fill(scene.fields.terrain, [=](double, double) { return 2 - sand; });
    if (sand > 0) scene.fill(scene.fields.sand, [=](double, double) { return sand; });
    scene.fill(scene.fields.water, [=](double, double) { return 4 + sand; });
    auto& west = scene.settings.sides[SIDE_WEST] = {SideKind::waves, 0, 1e30, {{{0, 6}}}};
    for (int n = 0; n <= 400; ++n) west.wave.samples.push_back({n * 0.1, 0.1 * std::sin(std::numbers::pi / 4 * n * 0.1)});
    scene.settings.sides[SIDE_EAST] = {SideKind::waves, 0, 1e30, {{{0, 6}}}};
    return scene;
}

/// Highest and lowest surface beside the side where they come in, in the last period, as shares of their height.
std::pair<double, double> swing(double dx, double sand, double exchange, int order) {
    auto world = make_world(wave_channel(dx, sand, exchange, order));
    const int period = static_cast<int>(8 / (0.02 * dx)), part = period / 40;
    step(*world, period * 4);
    double high = -1, low = 1;
    for (int n = 0; n < 40; ++n) {
        step(*world, part);
        const double rise = (cells_of(*world, "water_height").at(static_cast<int>(2 / dx), 0) - 4 - sand) / 0.1;
        high = std::max(high, rise), low = std::min(low, rise);
    }
    MESSAGE("order " << order << ", cells of " << dx << " m, " << sand << " m of sand, exchange " << exchange << ": " << low
                     << " to " << high);
    return {low, high};
}

} // namespace

TEST_CASE("waves come in through their side as high over sand as over solid ground, on coarse and on fine grids" *
          doctest::test_suite("long")) {
    for (const int order : {1, 2}) {
        for (const double dx : {1.0, 0.25}) {
            const auto [low, high] = swing(dx, 2, 1e5, order);
            const auto [ground_low, ground_high] = swing(dx, 0, 1e5, order);
            CHECK(std::abs(high - ground_high) < 0.03);
            CHECK(std::abs(low - ground_low) < 0.03);
        }
        // Loose sand through which water runs easily takes its part of a wave, but not with the grid.
        const auto [coarse_low, coarse_high] = swing(1, 2, 1e4, order);
        const auto [fine_low, fine_high] = swing(0.25, 2, 1e4, order);
        CHECK(std::abs(coarse_high - fine_high) < 0.04);
        CHECK(std::abs(coarse_low - fine_low) < 0.04);
    }
}

TEST_CASE("what comes in through a level side over sand comes straight in and as fast row by row, on cells of 8 mm as on coarser "
          "ones") {
    // A beach of damp sand, a little thicker in places; the level rises by 0.8 m.
    for (const double dx : {0.016, 0.008}) {
        auto scene = flat_scene(static_cast<int>(1.0 / dx), static_cast<int>(0.256 / dx), dx, 0.06 * dx);
        const auto bed = [](double x, double y) { return 0.179 * x + 0.02 * std::sin(12 * y + 5 * x); };
        scene.fill(scene.fields.terrain, bed);
        scene.fill(scene.fields.sand, [&](double x, double y) { return 0.529 + 0.179 * x - bed(x, y); });
        scene.fill(scene.fields.water, [&](double x, double y) { return 1.36 - bed(x, y); });
        auto& material = scene.settings.material;
        material.friction = 0.655, material.exchange_rate = 14600, material.diffusion_rate = 0.0131;
        scene.settings.method.substeps = 3;
        scene.settings.method.water_transport_order = 2;
        scene.settings.sides[SIDE_WEST] = {SideKind::level, 0, 1e30, {{{0, 1.36}, {1.64, 2.16}}}};
        auto world = make_world(scene);
        const auto alternates = [&](const char* velocity) { // from row to row, m/s
            const auto v = cells_of(*world, velocity);
            double most = 0;
            for (int j = 1; j + 1 < v.ny; ++j)
                for (int i = 0; i * dx < 0.3; ++i)
                    most = std::max(most, std::abs(v.at(i, j) - (v.at(i, j - 1) + v.at(i, j + 1)) / 2));
            return most;
        };
        step(*world, static_cast<int>(1 / (0.06 * dx)));
        const double along_side = alternates("water_velocity_y");
        CHECK(along_side < 0.0005);
        step(*world, static_cast<int>(0.6 / (0.06 * dx)));
        const double inward = alternates("water_velocity_x");
        CHECK(inward < 0.005);
        MESSAGE("cells of " << dx << " m: " << along_side << " m/s along the side, " << inward << " inward from row to row");
    }
}
