// Friction of water on its bed (NUMERICS 2.4) against closed forms: uniform flow down planes that lie askew to the grid, at any
// time step, and a stream that passes from slow to fast, whose depth is given and whose bed follows.
#include "tests/stability/quality.hpp"
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

constexpr double earth = 9.81, degree = 3.14159265358979323846 / 180;

struct Stream {
    double speed = 0, direction = 0; // [m/s], [degrees] from east
};

constexpr double film_depth = 0.1, film_slope = 0.025; // [m], 1

/// Whether the film runs on the ground, or on a bed of sand whose pores are full.
enum class Bed { ground, sand };

/// The middle of a film that starts at rest on a plane falling towards `angle` [degrees from east], after 40 s, before anything
/// from the sides has come there.
Stream stream_on_plane(const Material& material, double angle, double dt, Bed bed = Bed::ground) {
    const int n = 120;
    auto scene = flat_scene(n, n, 2, dt);
    scene.settings.material = material;
    scene.settings.method.quantum = 0; // a plane of whole quanta has steps
    const double east = std::cos(angle * degree), north = std::sin(angle * degree);
    scene.fill(scene.fields.terrain, [&](double x, double y) { return 8 - film_slope * (x * east + y * north); });
    const double sand = bed == Bed::sand ? 0.05 : 0;
    scene.fill(scene.fields.sand, [&](double, double) { return sand; });
    scene.fill(scene.fields.water, [&](double, double) { return film_depth + sand; });
    auto world = make_world(scene);
    step(*world, static_cast<int>(std::lround(40 / dt)));
    const double u = cells_of(*world, "water_velocity_x").at(n / 2, n / 2);
    const double v = cells_of(*world, "water_velocity_y").at(n / 2, n / 2);
    return {std::hypot(u, v), std::atan2(v, u) / degree};
}

/// c of the stress rho_w c |u|^2 on the bed under water of this depth [m].
double resistance(const Material& material, double depth) {
    return material.bed_friction + earth * material.manning * material.manning / std::cbrt(depth);
}

constexpr double stream_length = 1000, stream_discharge = 2; // [m], [m2/s]

/// Depth of the stream and its rise [1] downstream: slow, of the critical depth half way, then fast (MacDonald et al. 1997).
std::pair<double, double> stream_depth(double x) {
    const double critical = std::cbrt(stream_discharge * stream_discharge / earth), s = x / stream_length - 0.5;
    const double size = s < 0 ? 1.0 / 3 : 1.0 / 6, steep = s < 0 ? 3 : 6, wave = std::tanh(steep * s);
    return {critical * (1 - size * wave), -critical * size * steep * (1 - wave * wave) / stream_length};
}

/// Mean error of the depth, as a share of its mean, of that stream on n cells after 1500 s: its bed is what the depth calls for.
double stream_error(const Material& material, int order, int n) {
    const double dx = stream_length / n, dt = 0.05 * dx;
    auto scene = flat_scene(n, 1, dx, dt);
    scene.settings.material = material;
    scene.settings.method.quantum = 0;
    scene.settings.method.water_transport_order = order;
    scene.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, stream_discharge * dx}}}};
    scene.settings.sides[SIDE_EAST].kind = SideKind::outflow;
    const auto fall = [&](double x) { // of the bed [1]
        const auto [h, rise] = stream_depth(x);
        const double froude2 = stream_discharge * stream_discharge / (earth * h * h * h);
        return (1 - froude2) * rise + resistance(material, h) * froude2;
    };
    constexpr int parts = 40;
    double bed = 6;
    for (int i = 0; i < n; ++i) {
        for (int part = 0; i > 0 && part < parts; ++part) bed -= fall((i - 0.5 + (part + 0.5) / parts) * dx) * dx / parts;
        const double h = stream_depth((i + 0.5) * dx).first;
        scene.fields.terrain.push_back(static_cast<float>(bed));
        scene.fields.water.push_back(static_cast<float>(h));
        scene.fields.velocity_x.push_back(static_cast<float>(stream_discharge / h));
    }
    auto world = make_world(scene);
    step(*world, static_cast<int>(std::lround(1500 / dt)));
    const auto depth = cells_of(*world, "water_height");
    double error = 0, mean = 0;
    for (int i = 0; i < n; ++i) {
        const double exact = stream_depth((i + 0.5) * dx).first;
        error += std::abs(depth.at(i, 0) - exact);
        mean += exact;
    }
    return error / mean;
}

Material chezy(double c) {
    Material material;
    material.bed_friction = c;
    return material;
}

Material manning(double n) {
    Material material;
    material.manning = n;
    return material;
}

/// A film at rest on a plane that falls towards 30 degrees.
Scene film(int n) {
    auto scene = flat_scene(n, n, 2, 0.1);
    scene.settings.method.quantum = 0;
    scene.fill(scene.fields.terrain,
               [](double x, double y) { return 8 - film_slope * (x * std::cos(30 * degree) + y * std::sin(30 * degree)); });
    scene.fill(scene.fields.water, [](double, double) { return film_depth; });
    return scene;
}

} // namespace

TEST_CASE("bed friction: a stream runs down the fall line at Chezy's speed, however the plane lies to the grid") {
    const double exact = std::sqrt(earth * film_depth * film_slope / 0.01);
    for (const double angle : {0.0, 15.0, 30.0, 45.0, 120.0}) {
        const auto found = stream_on_plane(chezy(0.01), angle, 0.1);
        MESSAGE("plane at " << angle << " degrees: " << found.speed << " of " << exact << " m/s at " << found.direction);
        CHECK(std::abs(found.speed / exact - 1) < 0.001);
        CHECK(std::abs(found.direction - angle) < 0.05);
    }
    CHECK(std::abs(stream_on_plane(chezy(0.011), 45, 0.1).speed / exact - 1) > 0.04); // control
}

TEST_CASE("bed friction: uniform flow is the same at any time step") {
    for (const double angle : {0.0, 30.0, 45.0}) {
        const double speed = stream_on_plane(chezy(0.01), angle, 0.025).speed;
        for (const double dt : {0.1, 0.4}) {
            const double longer = stream_on_plane(chezy(0.01), angle, dt).speed;
            MESSAGE("plane at " << angle << " degrees, dt " << dt << " s: " << longer << " m/s, " << speed << " at 0.025 s");
            CHECK(std::abs(longer / speed - 1) < 0.001);
        }
    }
}

TEST_CASE("bed friction: a stream that turns fast keeps the depth that its bed was made for, to second order") {
    for (const auto& [law, material] : {std::pair{"Chezy", chezy(0.005)}, std::pair{"Manning", manning(0.02)}}) {
        double coarser = 0;
        for (const int n : {100, 200}) {
            const double first = stream_error(material, 1, n), second = stream_error(material, 2, n);
            MESSAGE(std::string(law) << ", " << n << " cells: order 1 " << 100 * first << " %, order 2 " << 100 * second << " %");
            CHECK(second < 1e-4);
            CHECK(second < first / 10);
            if (coarser > 0) {
                MESSAGE("order " << std::log2(coarser / second));
                CHECK(std::log2(coarser / second) > 1.7);
            }
            coarser = second;
        }
    }
}

TEST_CASE("bed friction: Manning's law and Chezy's beside it, on planes at any angle and time step") {
    for (const double n : {0.03, 0.1}) {
        const double exact = std::cbrt(film_depth * film_depth) * std::sqrt(film_slope) / n;
        for (const double dt : {0.025, 0.1}) {
            const auto found = stream_on_plane(manning(n), 30, dt);
            MESSAGE("n = " << n << ", dt " << dt << " s: " << found.speed << " of " << exact << " m/s at " << found.direction);
            CHECK(std::abs(found.speed / exact - 1) < 0.001);
            CHECK(std::abs(found.direction - 30) < 0.05);
        }
    }
    auto both = manning(0.03);
    both.bed_friction = 0.01;
    const double exact = std::sqrt(earth * film_depth * film_slope / resistance(both, film_depth));
    CHECK(std::abs(stream_on_plane(both, 45, 0.1).speed / exact - 1) < 0.001);
    CHECK(std::abs(stream_on_plane(manning(0.03), 45, 0.1).speed / exact - 1) > 0.2); // control
}

TEST_CASE("bed friction: bed shear slows water over sand at rest as friction does, at any angle and time step, and adds to it") {
    Material material;
    material.grain_size = 1; // nothing moves it
    for (const double friction : {0.0, 0.005}) {
        material.bed_friction = friction;
        material.bed_shear = 0.01;
        const double exact = std::sqrt(earth * film_depth * film_slope / (friction + material.bed_shear));
        for (const double angle : {0.0, 15.0, 45.0}) {
            const auto found = stream_on_plane(material, angle, angle > 0 ? 0.1 : 0.2, Bed::sand);
            MESSAGE("sand at " << angle << " degrees: " << found.speed << " of " << exact << " m/s at " << found.direction);
            CHECK(std::abs(found.speed / exact - 1) < 0.002);
            CHECK(std::abs(found.direction - angle) < 0.05);
        }
        CHECK(stream_on_plane(material, 45, 0.1, Bed::ground).speed > 1.05 * exact); // control: no sand, no stress of bed load
    }
}

TEST_CASE("bed friction: a channel runs at Manning's normal depth") {
    const int n = 200;
    const double dx = 5, dt = 0.2, discharge = 1, slope = 0.004, rough = 0.03;
    const double normal = std::pow(discharge * rough / std::sqrt(slope), 0.6);
    auto scene = flat_scene(n, 1, dx, dt);
    scene.settings.material = manning(rough);
    scene.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, discharge * dx}}}};
    scene.settings.sides[SIDE_EAST].kind = SideKind::outflow;
    scene.fill(scene.fields.terrain, [&](double x, double) { return 4 - slope * x; });
    auto world = make_world(scene); // dry
    step(*world, static_cast<int>(std::lround(3000 / dt)));
    const double depth = cells_of(*world, "water_height").at(n / 2, 0);
    MESSAGE("depth " << depth << " of " << normal << " m");
    CHECK(std::abs(depth / normal - 1) < 0.01);
    CHECK(std::abs(depth / std::pow(discharge * 0.031 / std::sqrt(slope), 0.6) - 1) > 0.01); // control
}

TEST_CASE("bed friction: each cell's own roughness, on every backend") {
    const int n = 120;
    auto uniform = film(n), mapped = film(n), halves = film(n);
    uniform.settings.material = manning(0.03F); // the same number as a float and as a double
    mapped.settings.roughness.assign(n * n, 0.03F);
    halves.settings.material = manning(0.03F);
    halves.settings.roughness.resize(n * n);
    for (int c = 0; c < n * n; ++c) halves.settings.roughness[static_cast<std::size_t>(c)] = c % n < n / 2 ? 0.02F : 0;
    std::uint64_t hash = 0;
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto a = make_world(uniform, {.backend = backend}), b = make_world(mapped, {.backend = backend});
        CHECK((a->plan().effects & EFFECT_ROUGHNESS) == 0);
        CHECK((b->plan().effects & EFFECT_ROUGHNESS) != 0);
        for (auto* world : {a.get(), b.get()}) step(*world, 40);
        CHECK(hash_of(*a) == hash_of(*b));
        auto c = make_world(halves, {.backend = backend});
        step(*c, 40);
        if (hash == 0) hash = hash_of(*c);
        CHECK(hash_of(*c) == hash);
        CHECK(hash_of(*c) != hash_of(*a));
    }
    auto world = make_world(halves);
    step(*world, 250);
    const auto u = cells_of(*world, "water_velocity_x"), v = cells_of(*world, "water_velocity_y");
    for (const auto& [i, rough] : {std::pair{n / 4, 0.05}, std::pair{3 * n / 4, 0.03}}) {
        const double exact = std::cbrt(film_depth * film_depth) * std::sqrt(film_slope) / rough;
        const double speed = std::hypot(u.at(i, n / 2), v.at(i, n / 2));
        MESSAGE("n = " << rough << ": " << speed << " of " << exact << " m/s");
        CHECK(std::abs(speed / exact - 1) < 0.005);
    }
}
