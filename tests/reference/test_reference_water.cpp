// The reference solver's water against exact solutions, with the figures of engine/NUMERICS.md, item 8.
#include "tests/reference/test_support.hpp"
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::reference;
using namespace wadi::reference::test;

namespace {

/// Water whose transport has this order (2.2 and 2.3, or 2.16).
constexpr std::uint32_t water_of(int order) { return order == 2 ? EFFECT_WATER | EFFECT_SECOND_ORDER_WATER : EFFECT_WATER; }

} // namespace

TEST_CASE("reference: Ritter's dry dam break") {
    const double expected[2][4] = {{8.7e-3, 5.7e-3, 3.6e-3, 2.1e-3}, {3.32e-3, 1.79e-3, 0.95e-3, 0.51e-3}};
    const double L = 50, t = 3, g = 9.81, c0 = std::sqrt(g);
    for (int turn = 0; turn < 8; ++turn) {
        const int order = 1 + turn / 4, n = 100 << turn % 4;
        Solver<double> s(convergence_settings(n, 1, L / n), water_of(order));
        fill(s, s.water, [&](double x, double) { return x < L / 2 ? 1 : 0; });
        run_to(s, t, 0.45);
        double error = 0;
        double front = 0;
        for (int i = 0; i < n; ++i) {
            const double x = (i + 0.5) * L / n - L / 2;
            const double fan = x <= -c0 * t ? 1 : x >= 2 * c0 * t ? 0 : std::pow(2 * c0 - x / t, 2) / (9 * g);
            error += std::abs(s.water[index(i)] - fan) / n;
            if (s.water[index(i)] > s.P.eps) front = x;
        }
        MESSAGE("Ritter order " << order << ", n = " << n << ": L1 " << error << ", front " << front << " of " << 2 * c0 * t);
        CHECK(within(error, expected[order - 1][turn % 4], 0.03));
    }
    // Control: with the clamp far below the front's speed the error does not fall.
    Settings slow = convergence_settings(400, 1, L / 400);
    slow.method.velocity_clamp = 0.1;
    Solver<double> s(slow, EFFECT_WATER);
    fill(s, s.water, [&](double x, double) { return x < L / 2 ? 1 : 0; });
    run_to(s, t, 0.45);
    double error = 0;
    for (int i = 0; i < 400; ++i) {
        const double x = (i + 0.5) * L / 400 - L / 2;
        const double fan = x <= -c0 * t ? 1 : x >= 2 * c0 * t ? 0 : std::pow(2 * c0 - x / t, 2) / (9 * g);
        error += std::abs(s.water[index(i)] - fan) / 400;
    }
    CHECK(error > 3 * expected[0][2]);
}

TEST_CASE("reference: Stoker's wet dam break") {
    const double expected[2][4] = {{11e-3, 5.95e-3, 3.5e-3, 2.3e-3}, {5.40e-3, 2.63e-3, 1.51e-3, 0.66e-3}};
    const double L = 10, x0 = 5, hl = 0.005, hr = 0.001, t = 6, g = 9.81;
    const double cl = std::sqrt(g * hl);
    const auto residual = [&](double c) {
        return -8 * g * hr * c * c * std::pow(cl - c, 2) + std::pow(c * c - g * hr, 2) * (c * c + g * hr);
    };
    double low = std::sqrt(g * hr) * 1.0001, high = cl;
    for (int n = 0; n < 100; ++n) (residual((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
    const double cm = low;
    const double xA = x0 - t * cl, xB = x0 + t * (2 * cl - 3 * cm);
    const double xC = x0 + 2 * t * cm * cm * (cl - cm) / (cm * cm - g * hr);
    for (int turn = 0; turn < 8; ++turn) {
        const int order = 1 + turn / 4, n = 100 << turn % 4;
        Settings set = convergence_settings(n, 1, L / n);
        set.method.dry_threshold = 1e-9;
        Solver<double> s(set, water_of(order));
        fill(s, s.water, [&](double x, double) { return x < x0 ? hl : hr; });
        run_to(s, t, 0.45);
        Field<double> exact(index(n));
        fill(s, exact, [&](double x, double) {
            if (x < xA) return hl;
            if (x < xB) return 4 / (9 * g) * std::pow(cl - (x - x0) / (2 * t), 2);
            return x < xC ? cm * cm / g : hr;
        });
        const double error = relative_error(s.water, exact);
        MESSAGE("Stoker order " << order << ", n = " << n << ": L1 " << error);
        CHECK(within(error, expected[order - 1][turn % 4], 0.03));
        if (turn % 4 != 3) continue;
        // Control: the exact solution of another time is far off.
        Field<double> early(index(n));
        fill(s, early, [&](double x, double) { return x < x0 ? hl : hr; });
        CHECK(relative_error(s.water, early) > 10 * error);
    }
}

TEST_CASE("reference: Thacker's radial bowl, one period" * doctest::test_suite("long")) {
    const double expected[2][2] = {{3.12e-2, 1.92e-2}, {1.83e-2, 0.71e-2}};
    const double h0 = 0.1, a = 1, r0 = 0.8, L = 4, g = 9.81;
    const double A = (a * a - r0 * r0) / (a * a + r0 * r0);
    const double w = std::sqrt(8 * g * h0) / a;
    const auto bed = [&](double x, double y) { return -h0 * (1 - (std::pow(x - L / 2, 2) + std::pow(y - L / 2, 2)) / (a * a)); };
    const auto depth = [&](double x, double y) { // at whole periods
        const double rr = (std::pow(x - L / 2, 2) + std::pow(y - L / 2, 2)) / (a * a);
        const double q = 1 / (1 - A);
        return std::max(0.0, h0 * (std::sqrt(1 - A * A) * q - 1 - rr * ((1 - A * A) * q * q - 1)) - bed(x, y));
    };
    for (int turn = 0; turn < 4; ++turn) {
        const int order = 1 + turn / 2, n = 64 << turn % 2;
        Solver<double> s(convergence_settings(n, n, L / n), water_of(order));
        fill(s, s.terrain, bed);
        fill(s, s.water, depth);
        const Field<double> exact = s.water;
        run_to(s, PI / w, 0.4);
        const double halfway = relative_error(s.water, exact);
        s = Solver<double>(convergence_settings(n, n, L / n), water_of(order));
        fill(s, s.terrain, bed);
        fill(s, s.water, depth);
        run_to(s, 2 * PI / w, 0.4);
        const double error = relative_error(s.water, exact);
        MESSAGE("Thacker order " << order << ", n = " << n << ": L1 " << error << ", middle "
                                 << s.water[s.axis(false).cell(n / 2, n / 2)]);
        CHECK(within(error, expected[order - 1][turn % 2], 0.07));
        CHECK(halfway > 5 * error); // control: half a period later the bowl looks different
    }
}

TEST_CASE("reference: steady subcritical flow over a bump, discharge and level sides" * doctest::test_suite("long")) {
    const double most[2][2] = {{2.98e-3, 1.52e-3}, {1.4e-3, 0.7e-3}};
    const double L = 25, q = 4.42, hl = 2, g = 9.81;
    for (int turn = 0; turn < 4; ++turn) {
        const int order = 1 + turn / 2, n = 100 << turn % 2;
        for (const bool along_y : {false, true}) {
            if (along_y && turn % 2 == 1) continue; // four times the work
            Settings set = along_y ? convergence_settings(1, n, L / n) : convergence_settings(n, 1, L / n);
            set.sides[along_y ? 2 : 0] = {SideKind::discharge, 0, 1e30, {{{0, q * set.grid.dx}}}};
            set.sides[along_y ? 3 : 1] = {SideKind::level, 0, 1e30, {{{0, hl}}}};
            Solver<double> s(set, water_of(order) | EFFECT_OPEN_SIDES);
            for (int i = 0; i < n; ++i) {
                const double x = (i + 0.5) * set.grid.dx;
                s.terrain[index(i)] = std::max(0.0, 0.2 - 0.05 * (x - 10) * (x - 10));
                s.water[index(i)] = hl - s.terrain[index(i)];
            }
            run_to(s, 400, 0.45);
            Field<double> exact(index(n));
            for (int i = 0; i < n; ++i) {
                double h = hl;
                for (int it = 0; it < 100; ++it) { // Newton on h^3 + b h^2 + q^2/(2g)
                    const double b = s.terrain[index(i)] - q * q / (2 * g * hl * hl) - hl;
                    h -= (h * h * h + b * h * h + q * q / (2 * g)) / (3 * h * h + 2 * b * h);
                }
                exact[index(i)] = h;
            }
            const double error = relative_error(s.water, exact);
            const double inner = along_y ? s.pure_flux.y[index(n / 2)] : s.pure_flux.x[index(n / 2)];
            MESSAGE("bump order " << order << ", n = " << n << ": L1 " << error << ", q " << inner / s.P.k);
            CHECK(error < most[order - 1][turn % 2]);
            CHECK(within(inner / s.P.k, q, 1e-4));
        }
    }
}

TEST_CASE("reference: a discharge with a depth below its critical one comes in as a fast stream, which a bump slows by "
          "Bernoulli's law") {
    const double g = 9.81, q = 0.9, h0 = 0.25, L = 10;
    const auto bump = [](double x) { return std::max(0.0, 0.1 - 0.1 * (x - 5) * (x - 5)); };
    const auto exact = [&](double z) { // the fast root of h + q^2/(2 g h^2) + z = E, by halves
        const double E = h0 + q * q / (2 * g * h0 * h0);
        double low = 0.05, high = std::cbrt(q * q / g);
        for (int n = 0; n < 60; ++n) {
            const double h = (low + high) / 2;
            (h + q * q / (2 * g * h * h) + z > E ? low : high) = h;
        }
        return low;
    };
    const auto error = [&](int order, int n, double depth) {
        Settings set = convergence_settings(n, 1, L / n);
        set.sides[0] = {SideKind::discharge, 0, 1e30, {{{0, q * set.grid.dx}}}, depth};
        set.sides[1].kind = SideKind::outflow;
        Solver<double> s(set, water_of(order) | EFFECT_OPEN_SIDES);
        Field<double> wanted(index(n));
        for (int i = 0; i < n; ++i) {
            s.terrain[index(i)] = bump((i + 0.5) * set.grid.dx);
            wanted[index(i)] = exact(s.terrain[index(i)]);
            s.water[index(i)] = h0;
        }
        std::fill(s.pure_velocity.x.begin(), s.pure_velocity.x.end(), q / h0);
        run_to(s, 60, 0.45);
        const double off = relative_error(s.water, wanted);
        MESSAGE("fast stream over a bump, order " << order << ", n = " << n << ", depth " << depth << ": L1 " << off);
        return off;
    };
    for (const int order : {1, 2}) {
        const double coarse = error(order, 100, h0), fine = error(order, 200, h0);
        CHECK(coarse < 0.006);
        CHECK(fine < 0.6 * coarse);
    }
    CHECK(error(1, 100, 0) > 0.3); // critical or deeper without it
}

TEST_CASE("reference: water runs out at an open side and stays behind a wall") {
    for (const bool open : {true, false}) {
        Settings set = make_settings(40, 3, 0.25, 0.02);
        if (open) set.sides[1].kind = SideKind::outflow;
        Solver<float> s(set, EFFECT_WATER | EFFECT_OPEN_SIDES);
        fill(s, s.water, [](double x, double) { return x < 5 ? 0.5 : 0.1; });
        round_heights(s);
        const double before = sum(s.water);
        for (int n = 0; n < 1000; ++n) s.step();
        CHECK(sum(s.water) == before + s.water_added); // to the last bit
        CHECK((open ? sum(s.water) < 0.5 * before : sum(s.water) == before));
    }
}

TEST_CASE("reference: sources, rain and evaporation give whole quanta and add up") {
    Settings set = make_settings(16, 16, 0.25, 0.01);
    Source disc;
    disc.center = {2, 2};
    disc.radius = 0.6;
    disc.rate.samples = {{0, 0.123}};
    Source point = disc;
    point.shape = SourceShape::point;
    point.center = {0.3, 3.9};
    Source sink = disc;
    sink.shape = SourceShape::box;
    sink.box = {3, 0, 4, 1};
    sink.rate.samples = {{0, -0.5}};
    set.sources = {disc, point, sink};
    set.rain.samples = {{0, 1.7e-5}};
    set.evaporation.samples = {{0, 2e-6}};
    Solver<float> s(set, EFFECT_WATER | EFFECT_SOURCES | EFFECT_RAIN);
    for (int n = 0; n < 500; ++n) s.step();
    CHECK(sum(s.water) == s.water_added);
    CHECK(s.refused == 0);
    set.sources.resize(1);
    std::swap(set.sources[0].rate, set.sources[0].discharge);
    Solver<double> by_volume(set, EFFECT_WATER | EFFECT_SOURCES);
    for (int n = 0; n < 500; ++n) by_volume.step();
    CHECK(sum(by_volume.water) * 0.25 * 0.25 == doctest::Approx(0.123 * 5).epsilon(1e-5));
    set.sources[0].discharge.samples.clear();
    set.sources[0].rate.samples = {{0, 100}};
    set.sources[0].radius = 10;
    Solver<float> full(set, EFFECT_WATER | EFFECT_SOURCES);
    for (int n = 0; n < 50; ++n) full.step();
    CHECK(full.refused > 0);
    CHECK(largest(full.water) <= 16);
    CHECK(sum(full.water) == full.water_added);
}
