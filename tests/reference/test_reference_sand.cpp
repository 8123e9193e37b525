// The reference solver's sand and wet sand against exact solutions of the model itself.
#include "tests/reference/test_support.hpp"
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::reference;
using namespace wadi::reference::test;

TEST_CASE("reference: a layer on an incline stays below the friction slope and slides with g (slope - mu) above it") {
    for (const bool along_y : {false, true}) {
        for (const double slope : {0.49, 0.6}) {
            const int n = 200;
            Settings set = along_y ? make_settings(1, n, 0.5, 0.01) : make_settings(n, 1, 0.5, 0.01);
            set.method.largest_height = 256;
            Solver<double> s(set, EFFECT_SAND);
            fill(s, s.terrain, [&](double x, double y) { return slope * ((along_y ? y : x)); });
            fill(s, s.sand, [](double, double) { return 0.5; });
            round_heights(s);
            const Solver<double> start = s;
            for (int step = 0; step < 100; ++step) s.step();
            const double u = along_y ? s.sand_velocity.y[index(n / 2)] : s.sand_velocity.x[index(n / 2)];
            if (slope < 0.5)
                CHECK(same(s, start));
            else
                CHECK(within(-u, 9.81 * (slope - 0.5) * 1.0, 1e-4));
        }
    }
}

TEST_CASE("reference: a layer on the flat stops after u0^2 / (2 mu g), longer under water") {
    const auto slide = [](double water, double exchange, double friction) {
        const int n = 400;
        Settings set = make_settings(n, 1, 0.05, 0.002);
        set.material.friction = friction;
        set.material.exchange_rate = exchange;
        Solver<double> s(set, WET_SAND);
        fill(s, s.sand, [](double, double) { return 0.5; });
        fill(s, s.water, [&](double, double) { return water; });
        round_heights(s);
        for (int i = 1; i < n; ++i) s.sand_velocity.x[index(i)] = s.mixed_velocity.x[index(i)] = 1;
        double way = 0;
        for (int step = 0; step < 500; ++step) {
            s.step();
            way += s.sand_velocity.x[index(n / 2)] * set.dt;
        }
        return way;
    };
    const double dry = 1 / (2 * 0.5 * 9.81);
    const double r = 1000.0 * 0.3 / (2000.0 * 0.5);
    MESSAGE("slide: dry " << slide(0, 0, 0.5) / dry << ", buoyant " << slide(0.3, 0, 0.5) / dry << " (" << 1 / (1 - r)
                          << "), dragging " << slide(0.3, 1e8, 0.5) / dry << " (" << (1 + r) / (1 - r) << ")");
    CHECK(within(slide(0, 0, 0.5), dry, 0.02));
    CHECK(within(slide(0.3, 0, 0.5), dry / (1 - r), 0.02));
    CHECK(within(slide(0.3, 1e8, 0.5), dry * (1 + r) / (1 - r), 0.02));
    CHECK_FALSE(within(slide(0, 0, 0.55), dry, 0.05)); // control: another friction
}

TEST_CASE("reference: relative speed of a drag pair decays by the discrete factor, momentum stays") {
    for (const double exchange : {1e3, 1e5}) {
        const int n = 120;
        Settings set = make_settings(n, 1, 1, 0.001);
        set.gravity = 0;
        set.material.exchange_rate = exchange;
        set.material.diffusion_rate = 0;
        set.method.quantum = 0;
        Solver<double> s(set, WET_SAND);
        fill(s, s.sand, [](double, double) { return 1; });
        fill(s, s.water, [](double, double) { return 0.6; });
        for (int i = 1; i < n; ++i) s.mixed_velocity.x[index(i)] = 1;
        const double momentum = 1000 * 0.6;
        const int steps = 20;
        for (int step = 0; step < steps; ++step) s.step();
        const double us = s.sand_velocity.x[index(n / 2)];
        const double um = s.mixed_velocity.x[index(n / 2)];
        const double kd = set.dt / 3 * exchange;
        const double kappa = 0.6 / 2000.0 * 1000 * kd / (1000 + kd);
        const double factor = 1000 / ((1000 + kd) * (1 + kappa));
        const double exact = std::exp(-exchange * (0.6 / 2000 + 1.0 / 1000) * steps * set.dt);
        MESSAGE("drag pair c_e " << exchange << ": " << um - us << " (discrete " << std::pow(factor, 3 * steps) << ", exact "
                                 << exact << ")");
        CHECK(std::abs(um - us - std::pow(factor, 3 * steps)) < 1e-12);
        CHECK(within(2000 * us + 1000 * 0.6 * um, momentum, 1e-12));
    }
}

TEST_CASE("reference: Dupuit's dam, the same flow for every number of substeps" * doctest::test_suite("long")) {
    const int n = 41;
    const double dx = 0.25, h1 = 1, h2 = 0.5, L = (n - 1) * dx;
    for (const double diffusion : {0.0, 0.02}) {
        for (const int T : {1, 2, 3}) {
            for (const double exchange : {1e5, 3e5}) {
                Settings set = make_settings(n, 1, dx, 0.02);
                set.method.substeps = T;
                set.material.exchange_rate = exchange;
                set.material.diffusion_rate = diffusion;
                Solver<double> s(set, WET_SAND);
                fill(s, s.sand, [](double, double) { return 1.5; });
                const double K = 1000 * 9.81 / exchange;
                // Starts from the exact profile: K h^2/2 + c_d h linear in x.
                fill(s, s.water, [&](double x, double) {
                    const double at = (x - dx / 2) / L;
                    const auto f = [&](double h) { return K * h * h / 2 + diffusion * h; };
                    const double value = f(h1) + at * (f(h2) - f(h1));
                    return (-diffusion + std::sqrt(diffusion * diffusion + 2 * K * value)) / K;
                });
                round_heights(s);
                double flow = 0;
                const int steps = 8000;
                const int last = 2000;
                for (int step = 0; step < steps; ++step) {
                    s.step();
                    s.water[0] = h1;
                    s.water[index(n - 1)] = h2;
                    const std::size_t f = index(n / 2);
                    if (step >= steps - last) flow += (s.mixed_flux.x[f] + s.pure_flux.x[f]) / s.P.k / last;
                }
                const double exact = (K * (h1 * h1 - h2 * h2) / 2 + diffusion * (h1 - h2)) / L;
                MESSAGE("Dupuit T " << T << ", c_e " << exchange << ", c_d " << diffusion << ": q / exact " << flow / exact);
                CHECK(within(flow, exact, 0.02));
                CHECK(largest(s.sand_velocity) == 0);
                CHECK_FALSE(within(flow, exact * 1.1, 0.02)); // control: 10 % more permeable
            }
        }
    }
}

TEST_CASE_TEMPLATE("reference: a rigidly turning strained disc keeps its strain", Real, float, double) {
    for (const bool rigid : {true, false}) {
        const int n = 40;
        const double dx = 0.1;
        const double omega = 1;
        Settings set = make_settings(n, n, dx, 0.01);
        set.method.substeps = 1;
        set.method.quantum = 0;
        Solver<Real> s(set, EFFECT_SAND | EFFECT_ELASTOPLASTIC);
        fill(s, s.sand, [](double x, double y) { return std::hypot(x - 2, y - 2) < 1 ? 0.5 : 0; });
        const Real stretch = std::exp(Real(0.1));
        for (std::size_t c = 0; c < s.sand.size(); ++c)
            if (s.sand[c] > Real(0)) {
                s.Vxx[c] = stretch;
                s.Vyy[c] = Real(1) / stretch;
            }
        const int quarter = 157; // omega dt = 0.01
        double worst = 0;
        double misaligned = 0;
        for (int step = 1; step <= 4 * quarter; ++step) {
            // The imposed field on faces beside sand; 0 elsewhere, as friction leaves it. The film that upwinding sheds
            // reaches the walls: they turn too, and let nothing through.
            for_all_faces(s, [&](const Axis& ax, int a, int b) {
                const bool wet =
                    (a > 0 && s.sand[ax.cell(a - 1, b)] > s.P.eps) || (a < ax.along() && s.sand[ax.cell(a, b)] > s.P.eps);
                const double across = (b + 0.5) * dx - 2;
                const double u = ax.is_y ? omega * across : (rigid ? -1.0 : -0.9) * omega * across;
                s.sand_velocity.along(ax)[ax.face(a, b)] = wet ? static_cast<Real>(u) : Real(0);
            });
            s.limit_sand_outflow();
            s.compute_sand_flux();
            s.integrate_sand_height();
            s.evolve_deformation_gradient();
            if (step != 4 * quarter) continue;
            for (std::size_t c = 0; c < s.sand.size(); ++c) {
                if (s.sand[c] <= s.P.eps) continue;
                const double d = static_cast<double>(s.Vxx[c] - s.Vyy[c]) / 2;
                const double m = static_cast<double>(s.Vxx[c] + s.Vyy[c]) / 2;
                const double strain = std::atanh(std::hypot(d, static_cast<double>(s.Vxy[c])) / m);
                worst = std::max(worst, std::abs(strain - 0.1));
                const double angle = 2 * omega * step * 0.01;
                misaligned = std::max(misaligned, std::abs(d - std::sinh(0.1) * std::cos(angle)));
            }
        }
        MESSAGE("turn, rigid " << rigid << ": largest change of strain " << worst << ", of axes " << misaligned);
        CHECK((rigid ? worst < 1e-5 : worst > 1e-3));
        if (rigid) CHECK(misaligned < 1e-3);
    }
}

// Two halves of a sheet, unstrained and turned by +angle and -angle, slide through each other's border: the least det F.
double least_det_where_turns_mix(std::uint32_t strain, double angle) {
    const int n = 20;
    Settings set = make_settings(n, 4, 0.1, 0.01);
    set.method.substeps = 1;
    set.method.quantum = 0;
    Solver<double> s(set, EFFECT_SAND | EFFECT_ELASTOPLASTIC | strain);
    fill(s, s.sand, [](double, double) { return 0.5; });
    const bool direct = (strain & EFFECT_DIRECT_STRAIN) != 0;
    const Axis x = s.axis(false);
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < n; ++i) {
            const double turn = i < n / 2 ? angle : -angle;
            const std::size_t c = x.cell(i, j);
            s.rotation[c] = direct ? std::sin(turn) : turn;
            s.Vxx[c] = s.Vyy[c] = direct ? std::cos(turn) : 1;
        }
    for_all_faces(s, [&](const Axis& ax, int a, int b) {
        if (!ax.is_y && a > 0 && a < n) s.sand_velocity.x[ax.face(a, b)] = 1;
    });
    for (int step = 0; step < 5; ++step) {
        s.limit_sand_outflow();
        s.compute_sand_flux();
        s.integrate_sand_height();
        s.advect_deformation_gradient();
    }
    double least = 1;
    for (std::size_t c = 0; c < s.sand.size(); ++c) {
        const double turn = direct ? s.rotation[c] : 0;
        least = std::min(least, s.Vxx[c] * s.Vyy[c] - (s.Vxy[c] - turn) * (s.Vxy[c] + turn));
    }
    return least;
}

// Strain of a disc that turns once by the imposed field, 0.1 at first: as in the case before, with F kept whole.
double strain_after_a_turn(double dt) {
    const int n = 24;
    const double dx = 0.1, omega = 1;
    Settings set = make_settings(n, n, dx, dt);
    set.method.substeps = 1;
    set.method.quantum = 0;
    Solver<double> s(set, EFFECT_SAND | EFFECT_ELASTOPLASTIC | EFFECT_PUBLISHED);
    fill(s, s.sand, [](double, double) { return 0.5; });
    for (std::size_t c = 0; c < s.sand.size(); ++c) {
        s.Vxx[c] = std::exp(0.1);
        s.Vyy[c] = std::exp(-0.1);
    }
    for_all_faces(s, [&](const Axis& ax, int a, int b) {
        const double across = (b + 0.5) * dx - 0.5 * n * dx;
        s.sand_velocity.along(ax)[ax.face(a, b)] = (ax.is_y ? omega : -omega) * across;
    });
    s.extrapolated = s.sand_velocity; // what the paper's stretch takes its gradient from
    const int steps = static_cast<int>(std::lround(2 * PI / (omega * dt)));
    for (int step = 0; step < steps; ++step) s.stretch_deformation_gradient();
    const std::size_t c = s.axis(false).cell(n / 2, n / 2);
    return std::log(s.Vxx[c] * s.Vyy[c] - s.Vxy[c] * s.Vxy[c]);
}

TEST_CASE("reference: F moved as it is shrinks where turns meet, angle and stretch moved apart do not (paper 4.2.2)") {
    for (const double angle : {0.4, 1.2}) {
        const double polar = least_det_where_turns_mix(EFFECT_PUBLISHED, angle),
                     direct = least_det_where_turns_mix(EFFECT_PUBLISHED | EFFECT_DIRECT_STRAIN, angle);
        MESSAGE("turns of +-" << angle << ": least det F " << polar << " polar, " << direct << " direct");
        CHECK(std::abs(polar - 1) < 1e-14);
        CHECK(direct < std::cos(angle)); // halfway between the two it is cos^2
    }
}

TEST_CASE("reference: F + dt grad(v) F inflates a turning disc by (omega dt)^2 a step, as the paper's formula does") {
    for (const double dt : {0.02, 0.01}) {
        const double grown = strain_after_a_turn(dt);
        MESSAGE("dt " << dt << ": ln det F after a turn " << grown);
        CHECK(within(grown, 2 * PI * dt, 0.02));
    }
}

TEST_CASE("reference: the projection ends on the yield surface and leaves what is inside it") {
    const int n = 60;
    Settings set = make_settings(n, n, 0.1, 0.001);
    set.material.young_modulus = 5e5;
    set.material.cohesion_dry = 3000;
    Solver<double> s(set, EFFECT_SAND | EFFECT_ELASTOPLASTIC);
    fill(s, s.sand, [](double, double) { return 1.2; });
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const std::size_t c = s.axis(false).cell(i, j);
            s.Vxx[c] = 1 + 0.002 * (i - n / 2);
            s.Vyy[c] = 1 + 0.0015 * (j - n / 2);
            s.Vxy[c] = 0.001 * ((i * 7 + j * 3) % 20 - 10);
        }
    const Field<double> before = s.Vxx;
    s.project_deformation_gradient();
    const Field<double> once = s.Vxx;
    const double bound = 4 * 0.4 * (0.4 + std::sqrt(1.16)) * 3000; // c_f = 0.4
    int inside = 0;
    for (std::size_t c = 0; c < s.sand.size(); ++c) {
        const double J = s.Vxx[c] * s.Vyy[c] - s.Vxy[c] * s.Vxy[c];
        const double trace = (s.sxx[c] + s.syy[c]) * J; // Kirchhoff
        const double deviator = std::sqrt(2.0) * std::hypot((s.sxx[c] - s.syy[c]) / 2, s.sxy[c]) * J;
        CHECK(0.4 * trace + deviator <= bound * (1 + 1e-9));
        if (0.4 * trace + deviator < bound * 0.99 && std::abs(once[c] - before[c]) < 1e-12) ++inside;
    }
    CHECK(inside > 20);
    s.project_deformation_gradient();
    CHECK(relative_error(s.Vxx, once) < 1e-14);
}
