// Order of convergence of water of second order (NUMERICS 2.16) from 64 to 512 cells, dt halved with dx: humps that are let go on
// still water, while they are smooth, against a solver of another kind.
#include "tests/stability/quality.hpp"
#include <array>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

// A lake 4 m deep: errors on 512 cells are some quanta, 1 um with the default largest height. On 1 m of water they would be two
// of them, and finer cells would gain less.
constexpr double hump_gravity = 9.81, hump_width = 160, hump_time = 4; // [m/s2], [m], [s]

double hump(double r) { return 4 + 0.8 * std::exp(-r * r / 144); }

/// Depth around a hump that is let go at t = 0, by distance from its middle: shallow water along a line (dimensions 1) or around
/// a point (2), differences of sixth order, Runge and Kutta's fourth-order steps. Depth is even in r, velocity odd.
class Truth {
  public:
    explicit Truth(int dimensions) : dimensions_(dimensions), h_(points), u_(points) {
        for (int n = 0; n < points; ++n) h_[at(n)] = hump(radius(n));
        constexpr int steps = 2000;
        for (int n = 0; n < steps; ++n) advance(hump_time / steps);
    }
    /// Cubic between the points.
    double depth(double r) const {
        const int n = static_cast<int>(std::floor(r / spacing - 0.5));
        const double s = r / spacing - 0.5 - n;
        const auto h = [&](int m) { return value(h_, n + m, 1); };
        return h(0) +
               0.5 * s * (h(1) - h(-1) + s * (2 * h(-1) - 5 * h(0) + 4 * h(1) - h(2) + s * (3 * (h(0) - h(1)) + h(2) - h(-1))));
    }

  private:
    using Values = std::vector<double>;
    static constexpr int points = 1500;
    static constexpr double spacing = 0.08;
    static std::size_t at(int n) { return static_cast<std::size_t>(n); }
    static double radius(int n) { return (n + 0.5) * spacing; }
    static double value(const Values& f, int n, double sign) {
        return n < 0 ? sign * f[at(-1 - n)] : f[at(std::min(n, points - 1))];
    }
    static double slope(const Values& f, int n, double sign) {
        const auto d = [&](int m) { return value(f, n + m, sign) - value(f, n - m, sign); };
        return (45 * d(1) - 9 * d(2) + d(3)) / (60 * spacing);
    }
    std::pair<Values, Values> rates(const Values& h, const Values& u) const {
        Values q(points), dh(points), du(points);
        for (int n = 0; n < points; ++n) q[at(n)] = h[at(n)] * u[at(n)];
        for (int n = 0; n < points; ++n) {
            dh[at(n)] = -slope(q, n, -1) - (dimensions_ - 1) * q[at(n)] / radius(n);
            du[at(n)] = -u[at(n)] * slope(u, n, -1) - hump_gravity * slope(h, n, 1);
        }
        return {dh, du};
    }
    void advance(double dt) {
        const Values h0 = h_, u0 = u_;
        Values h = h_, u = u_;
        for (const auto& [share, weight] : {std::pair{0.5, 1.0 / 6}, {0.5, 1.0 / 3}, {1.0, 1.0 / 3}, {0.0, 1.0 / 6}}) {
            const auto [dh, du] = rates(h, u);
            for (std::size_t n = 0; n < points; ++n) {
                h_[n] += dt * weight * dh[n];
                u_[n] += dt * weight * du[n];
                h[n] = h0[n] + dt * share * dh[n];
                u[n] = u0[n] + dt * share * du[n];
            }
        }
    }

    int dimensions_;
    Values h_, u_;
};

/// Mean error of the depth [m] of a world of n cells (1-D) or n x n around that hump, or around the same with `share` of all
/// depths, which takes 1/sqrt(share) of the time.
double hump_error(const Truth& truth, int dimensions, int n, int order, double share = 1,
                  double largest_height = Method{}.largest_height) {
    const double dx = hump_width / n, middle = hump_width / 2;
    const int steps = static_cast<int>(std::lround(hump_time / (0.02 * dx)));
    auto scene = flat_scene(n, dimensions == 1 ? 3 : n, dx, hump_time / steps / std::sqrt(share));
    scene.settings.method.largest_height = largest_height;
    scene.settings.method.water_transport_order = order;
    const auto r = [&](double x, double y) {
        return dimensions == 1 ? std::abs(x - middle) : std::hypot(x - middle, y - middle);
    };
    scene.fill(scene.fields.water, [&](double x, double y) { return share * hump(r(x, y)); });
    auto world = make_world(scene);
    step(*world, steps);
    const auto depth = cells_of(*world, "water_height");
    return sum_over(
               depth,
               [&](int i, int j) { return std::abs(depth.at(i, j) - share * truth.depth(r((i + 0.5) * dx, (j + 0.5) * dx))); }) /
           (depth.nx * depth.ny);
}

} // namespace

TEST_CASE("convergence: a hump on still water, along a line and around a point" * doctest::test_suite("long")) {
    for (const auto& [dimensions, least] : {std::pair{1, 1.9}, std::pair{2, 1.9}}) {
        const Truth truth(dimensions);
        std::array<double, 4> errors{};
        for (std::size_t level = 0; level < errors.size(); ++level) {
            const int n = 64 << level;
            errors[level] = hump_error(truth, dimensions, n, 2);
            MESSAGE(dimensions << "-D, " << n << " cells: error " << errors[level] << " m, order "
                               << (level > 0 ? std::log2(errors[level - 1] / errors[level]) : 0));
        }
        const double order = std::log2(errors.front() / errors.back()) / (errors.size() - 1);
        MESSAGE(dimensions << "-D: order " << order << " between 64 and 512 cells");
        CHECK(order > least);
        CHECK(errors.back() < hump_error(truth, dimensions, 512, 1) / 3);
    }
}

TEST_CASE("convergence: a hump on 1 m of water as on 4 m, where the largest height says how shallow it is; else quanta stop it" *
          doctest::test_suite("long")) {
    const Truth truth(2);
    const double coarse = hump_error(truth, 2, 128, 2, 0.25, 2), fine = hump_error(truth, 2, 512, 2, 0.25, 2);
    const double of_16_m = hump_error(truth, 2, 512, 2, 0.25);
    MESSAGE("error on 128 cells " << coarse << " m, on 512 " << fine << " m, order " << std::log2(coarse / fine) / 2
                                  << "; largest height 16 m: " << of_16_m << " m, order " << std::log2(coarse / of_16_m) / 2);
    CHECK(std::log2(coarse / fine) / 2 > 1.9);
    CHECK(std::log2(coarse / of_16_m) / 2 < 1.7); // control
}
