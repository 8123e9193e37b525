// Sand on its slope and water that its pores hold (NUMERICS 2.18, 2.19) in the reference solver, against what the laws say.
#include "tests/reference/test_support.hpp"
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::reference;
using namespace wadi::reference::test;

namespace {

constexpr std::uint32_t LAWS = EFFECT_SLOPE_NORMAL | EFFECT_INTERNAL_FRICTION;

Settings with_laws(Settings set) {
    set.material.slope_normal = 1;
    set.material.internal_friction = 0.4;
    set.material.sand_viscosity = 0.05;
    set.material.retention = 0.4925;
    return set;
}

} // namespace

TEST_CASE("reference: a slab slides with g (S - mu)/(1 + S^2), without slope_normal with g (S - mu)") {
    for (const bool along_y : {false, true}) {
        for (const std::uint32_t laws : {0u, LAWS}) {
            const int n = 200;
            Solver<double> s(with_laws(along_y ? make_settings(1, n, 0.5, 0.01) : make_settings(n, 1, 0.5, 0.01)),
                             EFFECT_SAND | laws);
            fill(s, s.terrain, [&](double x, double y) { return 0.6 * (along_y ? y : x); });
            fill(s, s.sand, [](double, double) { return 0.5; });
            round_heights(s);
            for (int step = 0; step < 100; ++step) s.step();
            const double u = along_y ? s.sand_velocity.y[index(n / 2)] : s.sand_velocity.x[index(n / 2)];
            CHECK(within(-u, 9.81 * 0.1 / (laws != 0 ? 1.36 : 1.0), 1e-4));
        }
    }
}

TEST_CASE("reference: the push of a cliff is that of Coulomb's wedge, of damp sand that holds it the whole") {
    const double wedge = 0.5 + std::sqrt(1.25), height = 2, dx = 0.1;
    // step: how much of the cliff is ground.
    const auto push = [&](double cohesion, std::uint32_t effects, double step = 0) {
        Settings set = with_laws(make_settings(40, 1, dx, 0.003));
        set.method.sand_gravity_cap = 0;
        set.method.quantum = 0;
        set.material.cohesion_dry = cohesion;
        Solver<double> s(set, effects);
        for (int i = 0; i < 20; ++i) {
            s.terrain[index(i)] = step;
            s.sand[index(i)] = height - step;
        }
        if (s.has(EFFECT_ELASTOPLASTIC)) s.project_deformation_gradient();
        s.integrate_sand_velocity();
        return s.sand_velocity.x[20] / (s.P.k_sand * 9.81 * height);
    };
    const auto limited_to = [&](double own) {
        return (wedge * dx + 0.1 * std::max(own - wedge * dx, 0.0)) / height / (1 + wedge * wedge);
    };
    const double limited = limited_to(height);
    CHECK(within(push(0, EFFECT_SAND), 1, 1e-12));
    CHECK(within(push(0, EFFECT_SAND | EFFECT_SLOPE_NORMAL), limited, 1e-12));
    // Of a step in the ground only the sand upon it pushes with more than the wedge.
    CHECK(within(push(0, EFFECT_SAND | EFFECT_SLOPE_NORMAL, 1.5), limited_to(0.5), 1e-12));
    CHECK(within(push(0, EFFECT_SAND | EFFECT_SLOPE_NORMAL, 1.9), limited_to(0), 1e-12));
    const std::uint32_t elastic = EFFECT_SAND | EFFECT_ELASTOPLASTIC | EFFECT_SLOPE_NORMAL;
    CHECK(within(push(0, elastic), limited, 1e-12));
    CHECK(within(push(1e5, elastic), 1, 1e-12));
    CHECK(push(100, elastic) > limited);
    CHECK(push(100, elastic) < 0.9);
}

TEST_CASE_TEMPLATE("reference: with its laws of slopes a pile below its friction angle keeps every bit, above it slumps", Real,
                   float, double) {
    for (const double steepness : {0.98, 1.03}) {
        Solver<Real> s(with_laws(make_settings(48, 48, 0.1, 0.009)), EFFECT_SAND | LAWS);
        fill(s, s.sand, [&](double x, double y) { return std::max(0.0, 1 - steepness * 0.5 * std::hypot(x - 2.4, y - 2.4)); });
        round_heights(s);
        const Solver<Real> start = s;
        for (int n = 0; n < 300; ++n) s.step();
        CHECK(same(s, start) == (steepness < 1));
    }
}

TEST_CASE("reference: in-plane viscosity lets shear die away by the discrete factor, a block does not feel internal friction") {
    for (const bool along_y : {false, true}) {
        const int n = 32;
        const double dx = 0.1;
        Settings set = with_laws(along_y ? make_settings(n, 3, dx, 0.003) : make_settings(3, n, dx, 0.003));
        set.sides[0].kind = set.sides[1].kind = set.sides[2].kind = set.sides[3].kind = SideKind::wall;
        set.material.friction = 0;
        set.material.internal_friction = 0;
        Solver<double> s(set, EFFECT_SAND | EFFECT_INTERNAL_FRICTION);
        fill(s, s.sand, [](double, double) { return 0.5; });
        const Axis ax = s.axis(along_y);
        // The middle of three columns of faces, all with the same velocity: no stretch.
        const auto set_all = [&](Faces<double>& velocity) {
            for (int b = 0; b < n; ++b)
                for (int a = 0; a <= 3; ++a) velocity.along(ax)[ax.face(a, b)] = 0.01 * std::cos(PI * (b + 0.5) / n);
        };
        set_all(s.sand_velocity);
        const Faces<double> before = s.sand_velocity;
        s.integrate_sand_velocity();
        const double factor = 1 - 0.05 * s.P.substep / (dx * dx) * 4 * std::pow(std::sin(PI / n / 2), 2);
        for (int b = 0; b < n; ++b)
            CHECK(within(s.sand_velocity.along(ax)[ax.face(1, b)], factor * before.along(ax)[ax.face(1, b)], 1e-9));
        CHECK(factor < 1 - 1e-5);
        // A layer that all slides at one speed keeps it, one that spreads does not.
        set.material.friction = 0.5;
        set.material.internal_friction = 1;
        set.material.sand_viscosity = 0;
        Solver<double> block(set, EFFECT_SAND | EFFECT_INTERNAL_FRICTION);
        fill(block, block.sand, [](double, double) { return 0.5; });
        for (const double spread : {0.0, 0.1}) {
            for (int b = 0; b < n; ++b)
                for (int a = 0; a <= 3; ++a) block.sand_velocity.along(ax)[ax.face(a, b)] = 1 + spread * a;
            block.integrate_sand_velocity();
            const double u = block.sand_velocity.along(ax)[ax.face(1, n / 2)];
            // u (1 - N y/((p + y) p)) with p = sqrt(u^2 + 0.0025 g h), y = h div, N = mu g dts.
            const double y = 0.5 * spread / dx, old = 1 + spread, p = std::sqrt(old * old + 0.0025 * 9.81 * 0.5);
            CHECK(within(u, old * (1 - 0.5 * 9.81 * block.P.substep * y / ((p + y) * p)), 1e-12));
        }
    }
}

TEST_CASE("reference: pores keep what they hold, and full ones hold nothing") {
    const auto kept = [](double wet, double retention) { // share of a damp pile's water that is still in place after a second
        Settings set = with_laws(make_settings(40, 40, 0.1, 0.006));
        set.material.retention = retention;
        set.material.exchange_rate = 1e3;
        Solver<double> s(set, WET_SAND | EFFECT_RETENTION);
        fill(s, s.sand, [&](double x, double y) { return std::max(0.0, 0.4 - 0.3 * std::hypot(x - 2, y - 2)); });
        for (std::size_t c = 0; c < s.sand.size(); ++c) s.water[c] = wet * s.sand[c];
        round_heights(s);
        const auto start = s;
        for (int n = 0; n < 167; ++n) s.step();
        double stays = 0;
        for (std::size_t c = 0; c < s.sand.size(); ++c) stays += std::min(s.water[c], start.water[c]);
        return stays / sum(start.water);
    };
    MESSAGE("damp pile keeps " << kept(0.3, 0.4925) << ", without retention " << kept(0.3, 0) << ", a full one "
                               << kept(1, 0.4925) << ", without retention " << kept(1, 0));
    CHECK(kept(0.3, 0.4925) > 0.999);
    CHECK(kept(0.3, 0) < 0.99);
    CHECK(kept(1, 0.4925) < 0.9);
}

TEST_CASE("reference: what water brings uphill meets the whole push, of friction alone the passive one") {
    // A slope of sand at rest in its push; mixed water that is carried up it.
    Settings set = with_laws(make_settings(4, 1, 0.1, 0.006));
    set.material.friction = 0;
    set.material.exchange_rate = 1e12;
    set.material.retention = 0;
    set.method.sand_gravity_cap = 0;
    const auto moved = [&](double um, bool law, unsigned more = 0, double cohesive = 0) {
        Solver<double> s(set, WET_SAND | (law ? EFFECT_SLOPE_NORMAL : 0u) | more);
        for (int i = 0; i < 4; ++i) {
            s.terrain[index(i)] = 0.3 * i;
            s.sand[index(i)] = s.water[index(i)] = 0.5;
        }
        std::fill(s.cohesive_share.begin(), s.cohesive_share.end(), cohesive);
        s.split_water();
        s.integrate_sand_velocity();
        std::fill(s.sand_velocity.x.begin(), s.sand_velocity.x.end(), 0.0);
        std::fill(s.mixed_velocity.x.begin(), s.mixed_velocity.x.end(), um);
        const double withheld = s.withheld_push.x[2];
        s.apply_friction();
        return std::pair{s.sand_velocity.x[2] * 1.5, withheld}; // (1 + kappa) us, kappa = 1/2
    };
    const double whole = moved(0, true).second;
    CHECK(whole > 0);
    CHECK(moved(0.8, false).first == doctest::Approx(0.4));
    CHECK(moved(0.8, true).first == doctest::Approx(0.4 - whole));
    CHECK(moved(whole, true).first == doctest::Approx(0)); // half of it arrives, and no more is taken than arrives
    CHECK(moved(-0.8, true).first == doctest::Approx(-0.4));

    // tan^2(45 deg + phi/2) = 4 for tan phi = 3/4, from which what remains of the push on the wedge's slope, 1/(1 + 2^2), goes; a
    // slope of 3 is steeper than the wedge, 2.
    set.material.friction = 0.75;
    const double level = set.dt / set.method.substeps / 0.1 * set.gravity * 0.3, left = (2 + 0.1) / 3 / 5;
    const double borne = 0.5; // of the sand's weight, by the pressure in full pores
    CHECK(moved(0, true).second == doctest::Approx(level * (4 - left) * borne));
    CHECK(moved(0, true, EFFECT_ELASTOPLASTIC).second == doctest::Approx(level * (4 - left) * borne));
    // Where stress bears the rest it is that of level ground, less what a slab on the wedge's slope pushes with.
    CHECK(moved(0, true, EFFECT_ELASTOPLASTIC, 4).second == doctest::Approx(level * (1 - 0.2 * 2 / 3) * borne));
}
