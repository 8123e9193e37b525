// Bores: how far the surface shoots over the steps that two depths and mass and momentum set, and over how many cells the front
// is spread, with the shock viscosity of method robust and without it (NUMERICS 2.3).
#include "tests/stability/quality.hpp"
#include <array>
#include <numbers>

using namespace wadi;
using namespace wadi::test;

namespace {

constexpr double bore_gravity = 9.81, bore_channel = 100; // [m/s2], [m]

struct BoreCase {
    double behind = 1, ahead = 0.8; // depths [m]
    int cells = 200, order = 1;
    double viscosity = Method{}.shock_viscosity;
    double courant = 0.25;
    bool along_y = false;
};

// Of a jump: how far depths leave its range [1], and cells between a tenth and nine tenths of it.
struct BoreShape {
    double overshoot = 0, width = 0;
};

// Speed of a bore into still water, and of the water behind it (Rankine and Hugoniot).
double bore_speed(const BoreCase& bore) {
    return std::sqrt(bore_gravity * bore.behind * (bore.behind + bore.ahead) / (2 * bore.ahead));
}
double speed_behind(const BoreCase& bore) { return bore_speed(bore) * (1 - bore.ahead / bore.behind); }

Scene bore_scene(int nx, int ny, double dx, const BoreCase& bore, double fastest) {
    auto scene = flat_scene(nx, ny, dx, bore.courant * dx / fastest);
    scene.settings.method.water_transport_order = bore.order;
    scene.settings.method.shock_viscosity = bore.viscosity;
    return scene;
}

// `depths` from the deep side to the shallow one.
BoreShape shape_of(const std::vector<double>& depths, const BoreCase& bore) {
    const double jump = bore.behind - bore.ahead;
    BoreShape shape;
    std::array<double, 2> places{}; // where depths leave nine tenths for good and come to a tenth, in cells
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const double share = (depths[i] - bore.ahead) / jump;
        shape.overshoot = std::max({shape.overshoot, share - 1, -share});
        if (i == 0) continue;
        const double before = (depths[i - 1] - bore.ahead) / jump;
        for (const std::size_t end : {0U, 1U}) {
            const double level = end == 0 ? 0.9 : 0.1;
            if (before >= level && share < level) places[end] = static_cast<double>(i) - (level - share) / (before - share);
        }
    }
    shape.width = places[1] - places[0];
    return shape;
}

// Into still water, from a third of the channel to two thirds.
BoreShape running_bore(const BoreCase& bore) {
    const int n = bore.cells;
    const double dx = bore_channel / n, start = 0.3 * bore_channel, speed = bore_speed(bore), flow = speed_behind(bore);
    const double fastest = flow + std::sqrt(bore_gravity * bore.behind);
    auto scene = bore.along_y ? bore_scene(3, n, dx, bore, fastest) : bore_scene(n, 3, dx, bore, fastest);
    const auto along = [&](double x, double y) { return bore.along_y ? y : x; };
    scene.fill(scene.fields.water, [&](double x, double y) { return along(x, y) < start ? bore.behind : bore.ahead; });
    scene.fill(bore.along_y ? scene.fields.velocity_y : scene.fields.velocity_x,
               [&](double x, double y) { return along(x, y) < start ? flow : 0; });
    auto world = make_world(scene);
    const int steps = static_cast<int>(0.4 * bore_channel / speed / scene.settings.dt);
    step(*world, steps);
    const auto water = cells_of(*world, "water_height");
    const double place = start + speed * steps * scene.settings.dt;
    std::vector<double> depths;
    for (int i = 0; i < n; ++i)
        if (std::abs((i + 0.5) * dx - place) < 0.15 * bore_channel)
            depths.push_back(bore.along_y ? water.at(1, i) : water.at(i, 1));
    return shape_of(depths, bore);
}

// Against a stream as fast as itself, which comes in through one side.
BoreShape standing_bore(const BoreCase& bore) {
    const int n = bore.cells;
    const double dx = bore_channel / n, stream = bore_speed(bore), flow = speed_behind(bore) - stream;
    auto scene = bore_scene(n, 3, dx, bore, stream + std::sqrt(bore_gravity * bore.ahead));
    scene.fill(scene.fields.water, [&](double x, double) { return x < bore_channel / 2 ? bore.behind : bore.ahead; });
    scene.fill(scene.fields.velocity_x, [&](double x, double) { return x < bore_channel / 2 ? flow : -stream; });
    auto& east = scene.settings.sides[static_cast<std::size_t>(SideName::east)];
    east.kind = SideKind::discharge;
    east.value = {{{0, stream * bore.ahead * 3 * dx}}};
    east.depth = bore.ahead;
    auto& west = scene.settings.sides[static_cast<std::size_t>(SideName::west)];
    west.kind = SideKind::level;
    west.value = {{{0, bore.behind}}};
    auto world = make_world(scene);
    step(*world, static_cast<int>(0.2 * bore_channel / stream / scene.settings.dt));
    const auto water = cells_of(*world, "water_height");
    std::vector<double> depths;
    for (int i = n * 35 / 100; i < n * 65 / 100; ++i) depths.push_back(water.at(i, 1));
    return shape_of(depths, bore);
}

// Into still water, turned against the grid, in the middle of a square that nothing from its walls has reached: the worst of its
// rows.
BoreShape oblique_bore(const BoreCase& bore, double degrees) {
    const int n = bore.cells;
    const double dx = bore_channel / n, speed = bore_speed(bore), flow = speed_behind(bore);
    const double cosine = std::cos(degrees * std::numbers::pi / 180), sine = std::sin(degrees * std::numbers::pi / 180);
    auto scene = bore_scene(n, n, dx, bore, flow + std::sqrt(bore_gravity * bore.behind));
    const auto ahead_of = [&](double x, double y) {
        return (x - bore_channel / 2) * cosine + (y - bore_channel / 2) * sine + 0.1 * bore_channel;
    };
    scene.fill(scene.fields.water, [&](double x, double y) { return ahead_of(x, y) < 0 ? bore.behind : bore.ahead; });
    scene.fill(scene.fields.velocity_x, [&](double x, double y) { return ahead_of(x, y) < 0 ? flow * cosine : 0; });
    scene.fill(scene.fields.velocity_y, [&](double x, double y) { return ahead_of(x, y) < 0 ? flow * sine : 0; });
    auto world = make_world(scene);
    const int steps = static_cast<int>(0.2 * bore_channel / speed / scene.settings.dt);
    step(*world, steps);
    const auto water = cells_of(*world, "water_height");
    const double run = speed * steps * scene.settings.dt;
    BoreShape shape;
    for (int j = n * 45 / 100; j < n * 55 / 100; ++j) {
        std::vector<double> depths;
        for (int i = 0; i < n; ++i)
            if (std::abs(ahead_of((i + 0.5) * dx, (j + 0.5) * dx) - run) < 0.12 * bore_channel) depths.push_back(water.at(i, j));
        const BoreShape row = shape_of(depths, bore);
        shape.overshoot = std::max(shape.overshoot, row.overshoot);
        shape.width = std::max(shape.width, row.width * cosine);
    }
    return shape;
}

// How far up a slope water stands after a bore has run up it [m], and the roughest three cells of its surface behind [m].
struct RunUp {
    double reach = 0, roughest = 0;
};

RunUp run_up(int order, double viscosity, int n) {
    const BoreCase bore{.behind = 1, .ahead = 0.5, .cells = n, .order = order, .viscosity = viscosity};
    const double length = 60, dx = length / n, flow = speed_behind(bore);
    auto scene = bore_scene(n, 3, dx, bore, flow + 2 * std::sqrt(bore_gravity));
    const auto bed = [](double x) { return std::max(0.0, (x - 25) * 0.1); };
    scene.fill(scene.fields.terrain, [&](double x, double) { return bed(x); });
    scene.fill(scene.fields.water, [&](double x, double) { return x < 12 ? 1 : std::max(0.0, 0.5 - bed(x)); });
    scene.fill(scene.fields.velocity_x, [&](double x, double) { return x < 12 ? flow : 0; });
    auto world = make_world(scene);
    RunUp result;
    for (int part = 0; part < 16; ++part) {
        step(*world, static_cast<int>(0.5 / scene.settings.dt));
        const auto water = cells_of(*world, "water_height");
        for (int i = 0; i < n; ++i)
            if (water.at(i, 1) > 1e-3) result.reach = std::max(result.reach, (i + 1) * dx);
        const auto surface = [&](int i) { return water.at(i, 1) + bed((i + 0.5) * dx); };
        for (int i = 1; i < n - 2 && water.at(i + 2, 1) > 0.1; ++i) { // what alternates from cell to cell
            const double a = surface(i) - surface(i - 1), b = surface(i + 1) - surface(i), c = surface(i + 2) - surface(i + 1);
            if (a * b < 0 && b * c < 0)
                result.roughest = std::max(result.roughest, std::min({std::abs(a), std::abs(b), std::abs(c)}));
        }
    }
    return result;
}

} // namespace

TEST_CASE("bores into still water overshoot by less than 2 % of their jump and stand within 4 cells; without viscosity weak ones "
          "ring") {
    for (const int order : {1, 2})
        for (const double ahead : {0.8, 0.4, 0.1})
            for (const int cells : {100, 200, 400}) {
                BoreCase bore{.ahead = ahead, .cells = cells, .order = order};
                const auto damped = running_bore(bore);
                bore.viscosity = 0;
                const auto bare = running_bore(bore);
                MESSAGE("1/" << ahead << " m, order " << order << ", " << cells << " cells: overshoot " << damped.overshoot
                             << ", width " << damped.width << "; without viscosity " << bare.overshoot << ", " << bare.width);
                CHECK(damped.overshoot < 0.02);
                CHECK(damped.width < 4);
                CHECK(damped.width > 1);
                if (ahead == 0.8) CHECK(bare.overshoot > 0.1);
                if (ahead == 0.4) CHECK(bare.overshoot > 0.02);
            }
}

TEST_CASE("bores at other time steps, along y, standing and turned keep their steps, too") {
    for (const int order : {1, 2}) {
        CAPTURE(order);
        for (const double courant : {0.1, 0.4}) {
            const auto bore = running_bore({.order = order, .courant = courant});
            MESSAGE("Courant number " << courant << ", order " << order << ": overshoot " << bore.overshoot << ", width "
                                      << bore.width);
            CHECK(bore.overshoot < 0.02);
            CHECK(bore.width < 4);
        }
        const auto along = running_bore({.cells = 100, .order = order}),
                   across = running_bore({.cells = 100, .order = order, .along_y = true});
        CHECK(along.overshoot == across.overshoot);
        CHECK(along.width == across.width);
        for (const int cells : {100, 200, 400}) {
            const auto standing = standing_bore({.ahead = 0.4, .cells = cells, .order = order});
            MESSAGE("standing 1/0.4 m, order " << order << ", " << cells << " cells: overshoot " << standing.overshoot
                                               << ", width " << standing.width);
            CHECK(standing.overshoot < 0.02);
            CHECK(standing.width < 4);
        }
        for (const double degrees : {30.0, 45.0})
            for (const double ahead : {0.8, 0.4})
                for (const int cells : {100, 200}) {
                    BoreCase bore{.ahead = ahead, .cells = cells, .order = order};
                    const auto turned = oblique_bore(bore, degrees);
                    bore.viscosity = 0;
                    const auto bare = oblique_bore(bore, degrees);
                    MESSAGE("1/" << ahead << " m turned by " << degrees << ", order " << order << ", " << cells
                                 << " cells: overshoot " << turned.overshoot << ", width " << turned.width
                                 << "; without viscosity " << bare.overshoot << ", " << bare.width);
                    CHECK(turned.overshoot < 0.02);
                    CHECK(turned.width < 4);
                    if (ahead == 0.8) CHECK(bare.overshoot > 0.05);
                }
    }
}

TEST_CASE("a bore runs up a slope as far as without viscosity") {
    for (const int order : {1, 2})
        for (const int cells : {150, 300}) {
            const auto damped = run_up(order, Method{}.shock_viscosity, cells), bare = run_up(order, 0, cells);
            MESSAGE("order " << order << ", " << cells << " cells: up to " << damped.reach << " m, alternating "
                             << damped.roughest << " m; without viscosity " << bare.reach << ", " << bare.roughest);
            CHECK(damped.reach > 33); // 3 m beyond the shore at rest
            CHECK(std::abs(damped.reach - bare.reach) < 1.5 * 60 / cells);
            CHECK(damped.roughest <= bare.roughest);
        }
}
