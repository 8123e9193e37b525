// What must hold for any scene: rest, exact mass, symmetry, bounds. Float and double.
#include "tests/reference/test_support.hpp"
#include <doctest/doctest.h>
#include <limits>
#include <random>

using namespace wadi;
using namespace wadi::reference;
using namespace wadi::reference::test;

namespace {

constexpr std::uint32_t SLOPES = EFFECT_SLOPE_NORMAL | EFFECT_INTERNAL_FRICTION;
constexpr std::uint32_t MASKS[] = {
    EFFECT_WATER,
    EFFECT_SAND,
    EFFECT_SAND | EFFECT_ELASTOPLASTIC,
    EFFECT_WATER | EFFECT_SAND,
    EFFECT_WATER | EFFECT_SAND | EFFECT_DRAG,
    EFFECT_WATER | EFFECT_SAND | EFFECT_MIXTURE,
    WET_SAND | EFFECT_BED_FRICTION,
    WET_SAND | ELASTIC,
    EFFECT_WATER | EFFECT_SAND | EFFECT_DRAG | ELASTIC,
    EFFECT_SAND | SLOPES,
    WET_SAND | EFFECT_RETENTION | SLOPES,
    WET_SAND | ELASTIC | EFFECT_RETENTION | SLOPES,
};

/// Smooth random heights with dry parts, at rest; `seed` fixes them.
template <class Real> void random_scene(Solver<Real>& s, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    double p[12];
    for (double& v : p) v = uniform(generator);
    const double size = s.settings.grid.dx * s.settings.grid.nx;
    const auto wave = [&, size](double x, double y, int n) {
        return std::sin(2 * PI * (p[n] * x + p[n + 1] * y) * 2 / size + 6 * p[n + 2]);
    };
    fill(s, s.terrain, [&](double x, double y) { return 0.5 + 0.3 * wave(x, y, 0); });
    if (s.has(EFFECT_SAND)) fill(s, s.sand, [&](double x, double y) { return std::max(0.0, 0.6 * wave(x, y, 3)); });
    if (s.has(EFFECT_WATER))
        fill(s, s.water, [&](double x, double y) { return std::max(0.0, 0.2 + 0.8 * wave(x, y, 6) * wave(x, y, 9)); });
    if (s.P.quantum > Real(0)) round_heights(s);
}

Settings scene_settings(int nx, int ny) {
    Settings set = make_settings(nx, ny, 0.1, 0.01);
    set.material.friction = 0.3;
    set.material.bed_friction = 0.01;
    set.material.slope_normal = 1;
    set.material.internal_friction = 0.4;
    set.material.sand_viscosity = 0.05;
    set.material.retention = 0.3;
    return set;
}

/// Copies the state of `a` into `b`, mirrored in x or transposed.
template <class Real> void copy_turned(const Solver<Real>& a, Solver<Real>& b, bool transpose) {
    const Axis x = a.axis(false);
    const Axis bx = b.axis(false);
    for (int j = 0; j < x.ny; ++j)
        for (int i = 0; i < x.nx; ++i) {
            const std::size_t from = x.cell(i, j);
            const std::size_t to = transpose ? bx.cell(j, i) : bx.cell(x.nx - 1 - i, j);
            b.terrain[to] = a.terrain[from];
            b.sand[to] = a.sand[from];
            b.water[to] = a.water[from];
            b.Vxx[to] = transpose ? a.Vyy[from] : a.Vxx[from];
            b.Vyy[to] = transpose ? a.Vxx[from] : a.Vyy[from];
            b.Vxy[to] = transpose ? a.Vxy[from] : -a.Vxy[from];
        }
    const auto faces = [&](const Faces<Real>& from, Faces<Real>& to) {
        for (const bool is_y : {false, true}) {
            const Axis ax = a.axis(is_y);
            for (int v = 0; v < ax.across(); ++v)
                for (int u = 0; u <= ax.along(); ++u) {
                    const Real value = from.along(ax)[ax.face(u, v)];
                    if (transpose) {
                        const Axis other = b.axis(!is_y);
                        to.along(other)[other.face(u, v)] = value;
                    } else if (is_y) {
                        to.y[ax.face(u, x.nx - 1 - v)] = value;
                    } else {
                        to.x[ax.face(x.nx - u, v)] = -value;
                    }
                }
        }
    };
    faces(a.sand_velocity, b.sand_velocity);
    faces(a.pure_velocity, b.pure_velocity);
    faces(a.mixed_velocity, b.mixed_velocity);
}

} // namespace

TEST_CASE_TEMPLATE("reference: a lake over dunes and a shore is a fixed point", Real, float, double) {
    for (const std::uint32_t mask : {WET_SAND | ELASTIC, EFFECT_WATER | EFFECT_SAND | EFFECT_DRAG, WET_SAND,
                                     WET_SAND | SLOPES | EFFECT_RETENTION, WET_SAND | ELASTIC | SLOPES | EFFECT_RETENTION}) {
        Settings set = scene_settings(120, 40);
        set.material.friction = 0.5;
        Solver<Real> s(set, mask);
        const auto bump = [](double x, double y, double cx, double cy, double height, double slope) {
            return std::max(0.0, height - slope * std::hypot(x - cx, y - cy));
        };
        // A covered and an emerging dune in the west, an island and a sloping shore in the east.
        fill(s, s.sand,
             [&](double x, double y) { return std::max(bump(x, y, 0.7, 3.2, 0.2, 0.15), bump(x, y, 3, 1.5, 0.6, 0.18)); });
        fill(s, s.terrain, [&](double x, double y) { return std::max(0.3 * (x - 9), 0.0) + bump(x, y, 7.5, 2.5, 0.7, 1); });
        fill(s, s.water, [](double, double) { return 0; });
        round_heights(s);
        const Real eta = std::nearbyint(Real(0.5) / s.P.quantum) * s.P.quantum;
        for (std::size_t c = 0; c < s.water.size(); ++c) s.water[c] = std::max(eta - s.terrain[c], Real(0));
        const Solver<Real> start = s;
        for (int n = 0; n < 100; ++n) s.step();
        CHECK(same(s, start));
        // Control: two quanta more than the rest rule allows in one cell, and it moves.
        s = start;
        s.water[0] += Real(20) * s.P.quantum;
        s.step();
        CHECK_FALSE(largest(s.pure_velocity) == 0);
    }
}

TEST_CASE("reference: without quantum and rest rule a lake over dunes keeps rounding-level velocities" *
          doctest::test_suite("long")) {
    Settings set = make_settings(48, 40, 0.1, 0.01);
    set.method.quantum = 0;
    set.method.rest_rule = false;
    for (const bool steep : {false, true}) {
        Solver<double> s(set, WET_SAND | ELASTIC);
        fill(s, s.sand, [&](double x, double y) {
            return std::max(0.0, 0.65 - (steep ? 0.6 : 0.2) * std::hypot(x - 2.5, y - 2)) +
                   std::max(0.0, 0.2 - 0.2 * std::hypot(x - 0.9, y - 1));
        });
        fill(s, s.water, [](double, double) { return 0.5; });
        for (int n = 0; n < 400; ++n) s.step();
        const double fastest = std::max(largest(s.pure_velocity), largest(s.mixed_velocity));
        MESSAGE("lake, dune slope " << (steep ? 0.6 : 0.2) << ": |u| " << fastest);
        CHECK((steep ? fastest > 1e-6 : fastest < 1e-11));
    }
}

TEST_CASE_TEMPLATE("reference: a pile below its friction angle keeps every bit, above it slumps", Real, float, double) {
    for (const double steepness : {0.95, 1.03}) {
        Settings set = make_settings(48, 48, 0.1, 0.009);
        Solver<Real> s(set, EFFECT_SAND | EFFECT_ELASTOPLASTIC);
        fill(s, s.sand, [&](double x, double y) { return std::max(0.0, 1 - steepness * 0.5 * std::hypot(x - 2.4, y - 2.4)); });
        round_heights(s);
        const Solver<Real> start = s;
        for (int n = 0; n < 300; ++n) s.step();
        CHECK(same(s, start) == (steepness < 1));
    }
}

TEST_CASE_TEMPLATE("reference: mass is exact with the quantum, heights and velocities stay in bounds", Real, float, double) {
    unsigned seed = 1;
    for (const std::uint32_t mask : MASKS) {
        for (const double dt : {0.01, 0.2}) {
            Settings set = scene_settings(24, 20);
            set.dt = dt;
            Solver<Real> s(set, mask);
            random_scene(s, ++seed);
            const double water = sum(s.water);
            const double sand = sum(s.sand);
            for (int n = 0; n < 150; ++n) s.step();
            CAPTURE(mask);
            CAPTURE(dt);
            CHECK(sum(s.water) == water);
            CHECK(sum(s.sand) == sand);
            CHECK(*std::min_element(s.water.begin(), s.water.end()) >= Real(0));
            CHECK(*std::min_element(s.sand.begin(), s.sand.end()) >= Real(0));
            // The split exchange after the clamp is an average: it may pass the clamp by its rounding.
            const double rounding = 1 + 4 * static_cast<double>(std::numeric_limits<Real>::epsilon());
            CHECK(largest(s.pure_velocity) <= static_cast<double>(s.P.clamp) * rounding);
            CHECK(largest(s.mixed_velocity) <= static_cast<double>(s.P.clamp));
            CHECK(largest(s.sand_velocity) <= static_cast<double>(s.P.clamp_sand));
            CHECK(largest(s.Vxx) < 100);
        }
    }
    // Control: plain arithmetic drifts, and more so without the limiter.
    Settings set = scene_settings(24, 20);
    set.method.quantum = 0;
    Solver<Real> plain(set, WET_SAND | ELASTIC);
    random_scene(plain, 1);
    const double before = sum(plain.water);
    double drift = 0; // the largest of all steps: at one of them the roundings may cancel
    for (int n = 0; n < 150; ++n) {
        plain.step();
        drift = std::max(drift, std::abs(sum(plain.water) / before - 1));
    }
    CHECK(drift > 0);
    CHECK(drift < 100 * static_cast<double>(std::numeric_limits<Real>::epsilon()));
    set.method.outflow_limiter = false;
    set.dt = 0.2;
    Solver<Real> unlimited(set, WET_SAND | ELASTIC);
    random_scene(unlimited, 1);
    for (int n = 0; n < 150; ++n) unlimited.step();
    CHECK_FALSE(std::abs(sum(unlimited.water) / before - 1) <= 1e-3); // nor a number
}

TEST_CASE_TEMPLATE("reference: mirrored and transposed scenes give mirrored and transposed bits", Real, float, double) {
    unsigned seed = 50;
    for (const std::uint32_t mask : MASKS) {
        for (const double quantum : {-1.0, 0.0}) {
            for (const bool transpose : {false, true}) {
                Settings set = scene_settings(20, 17);
                set.method.quantum = quantum;
                set.sides[0].kind = SideKind::outflow;
                set.sides[3] = {SideKind::level, 0.3, 1.2, {{{0, 0.7}}}};
                Settings turned = set;
                if (transpose) {
                    std::swap(turned.grid.nx, turned.grid.ny);
                    turned.sides = {set.sides[2], set.sides[3], set.sides[0], set.sides[1]};
                } else {
                    std::swap(turned.sides[0], turned.sides[1]);
                    turned.sides[3].from = 20 * 0.1 - 1.2;
                    turned.sides[3].to = 20 * 0.1 - 0.3;
                }
                const std::uint32_t open = (mask & EFFECT_WATER) != 0 ? mask | EFFECT_OPEN_SIDES : mask;
                Solver<Real> a(set, open);
                Solver<Real> b(turned, open);
                random_scene(a, ++seed);
                copy_turned(a, b, transpose);
                for (int n = 0; n < 40; ++n) {
                    a.step();
                    b.step();
                }
                Solver<Real> a_turned(turned, open);
                copy_turned(a, a_turned, transpose);
                CAPTURE(mask);
                CAPTURE(quantum);
                CAPTURE(transpose);
                CHECK(same(a_turned, b));
                CHECK(largest(a.sand_velocity) + largest(a.pure_velocity) > 1e-3); // something happened
                b.step();
                CHECK_FALSE(same(a_turned, b)); // control: one step apart
            }
        }
    }
}

TEST_CASE("reference: float follows double") {
    for (const std::uint32_t mask : MASKS) {
        Solver<float> single(scene_settings(24, 20), mask);
        Solver<double> twice(scene_settings(24, 20), mask);
        random_scene(single, 7);
        random_scene(twice, 7);
        for (int n = 0; n < 5; ++n) {
            single.step();
            twice.step();
        }
        double difference = 0;
        for (std::size_t c = 0; c < twice.water.size(); ++c) {
            difference = std::max(difference, std::abs(static_cast<double>(single.water[c]) - twice.water[c]));
            difference = std::max(difference, std::abs(static_cast<double>(single.sand[c]) - twice.sand[c]));
        }
        CAPTURE(mask);
        CHECK(difference < 2e-5);
    }
}
