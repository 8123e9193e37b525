#include "samples/tune/candidates.hpp"
#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

using namespace tune;

namespace {

Run still_run(int nx, int ny, float sand, float surface) {
    Run run;
    run.settings.nx = nx;
    run.settings.ny = ny;
    run.has_sand = run.has_water = true;
    const auto cells = static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
    for (int n = 0; n <= CHECKPOINTS; ++n)
        run.at.push_back({nx, ny, std::vector<float>(cells, sand), std::vector<float>(cells, surface)});
    return run;
}

/// Differences of runs of sizes h from one of size 1 where errors are vectors: factor * h^order long, `angle` apart from the
/// reference's.
std::vector<ErrorPoint> made(double factor, double order, double angle, std::initializer_list<double> sizes) {
    std::vector<ErrorPoint> points;
    for (const double h : sizes) {
        const double error = factor * std::pow(h, order);
        points.push_back({h, std::hypot(error * std::cos(angle) - factor, error * std::sin(angle))});
    }
    return points;
}

} // namespace

TEST_CASE("averaged fields keep their sum on any grid, and a slope on one that divides theirs") {
    std::vector<float> slope;
    double sum = 0;
    for (int j = 0; j < 6; ++j) {
        for (int i = 0; i < 10; ++i) {
            slope.push_back(static_cast<float>(i) + 0.5f + 100 * (static_cast<float>(j) + 0.5f));
            sum += static_cast<double>(slope.back());
        }
    }
    for (const auto& [nx, ny] : {std::pair{5, 3}, {4, 4}, {7, 5}, {10, 6}, {1, 1}, {13, 7}}) {
        const std::vector<float> mean = averaged(slope, 10, 6, nx, ny);
        REQUIRE(mean.size() == static_cast<std::size_t>(nx * ny));
        double kept = 0;
        for (const float value : mean) kept += static_cast<double>(value) * 60 / (nx * ny);
        CHECK(kept == doctest::Approx(sum));
        for (int j = 0; j < ny && 10 % nx == 0 && 6 % ny == 0; ++j) {
            for (int i = 0; i < nx; ++i) {
                const double x = (i + 0.5) * 10 / nx, y = (j + 0.5) * 6 / ny;
                CHECK(mean[static_cast<std::size_t>(j * nx + i)] == doctest::Approx(x + 100 * y));
            }
        }
    }
}

TEST_CASE("errors are percent of the range over which the finer run moved a surface") {
    Run fine = still_run(8, 4, 1, 2), coarse = still_run(4, 2, 1, 2);
    CHECK_FALSE(errors_against(coarse, fine).sand); // nothing moved: no number
    CHECK_FALSE(errors_against(coarse, fine).water);
    for (float& value : fine.at.back().surface) value = 2.5f; // by 0.5 m at the last of four times
    CHECK_FALSE(errors_against(coarse, fine).sand);
    REQUIRE(errors_against(coarse, fine).water);
    CHECK(*errors_against(coarse, fine).water == doctest::Approx(100 * 0.5 / CHECKPOINTS / 0.5));
    for (float& value : coarse.at.back().surface) value = 2.4f;
    CHECK(*errors_against(coarse, fine).water == doctest::Approx(100 * 0.1 / CHECKPOINTS / 0.5));
    CHECK_FALSE(errors_against(coarse, fine, CHECKPOINTS - 1).water); // nothing moved until then
    for (float& value : fine.at[1].surface) value = 2.25f;
    CHECK(*errors_against(coarse, fine, 1).water == doctest::Approx(100));
    fine.has_water = false;
    CHECK_FALSE(errors_against(coarse, fine).water);
}

TEST_CASE("times: a fixed part and one per cell, neither negative") {
    const TimeFit fit = fit_time({{1000, 0.011}, {4000, 0.014}, {9000, 0.019}});
    CHECK(fit.fixed == doctest::Approx(0.01));
    CHECK(fit.per_cell == doctest::Approx(1e-6));
    const TimeFit steep = fit_time({{1000, 0.001}, {4000, 0.005}}); // a line through both would begin below 0
    CHECK(steep.fixed == 0);
    CHECK(steep.step(4000) == doctest::Approx(0.005).epsilon(0.15));
    CHECK(fit_time({{1000, 0.002}, {4000, 0.001}}).per_cell == 0);
    CHECK(fit_time({{1000, 0.002}}).step(2000) == doctest::Approx(0.004));
}

TEST_CASE("errors of known size are found again from differences alone") {
    // The tuner takes one angle (41 degrees), levels have theirs.
    for (const double degrees : {30.0, 41.0, 55.0}) {
        for (const double order : {0.5, 0.8, 1.1}) {
            const ErrorFit fit = fit_own(made(0.3, order, degrees * std::numbers::pi / 180, {2, 3, 4, 6}));
            CAPTURE(degrees);
            CAPTURE(order);
            CAPTURE(fit.order);
            CHECK(fit.converges());
            CHECK(fit.at(2.5) > 0.3 * std::pow(2.5, order) / 1.5);
            CHECK(fit.at(2.5) < 0.3 * std::pow(2.5, order) * 1.5);
        }
    }
    CHECK(error_of(0.5, 0) == doctest::Approx(0.25)); // of a reference that nothing is known of
    CHECK(error_of(0.5, 1e-6) == doctest::Approx(0.5));
    CHECK(error_of(0.5, 0.1) > 0.5);
}

TEST_CASE("differences that do not fall are told as such") {
    CHECK_FALSE(fit_own({{2, 1.0}, {3, 1.0}, {4, 1.0}, {6, 1.0}}).converges());
    CHECK_FALSE(fit_own({{2, 1.0}, {3, 0.9}, {4, 0.8}, {6, 0.7}}).converges());
    CHECK_FALSE(fit_own({{2, 1.0}, {3, 0.2}, {4, 2.0}, {6, 0.3}}).converges());
}

TEST_CASE("the order at which runs come closer to each other, on any three grids, and where they come apart") {
    const auto difference = [](double a, double b) { return std::sqrt(a * a + b * b - 1.5 * a * b); };
    for (const double order : {-0.5, 0.0, 0.3, 1.0}) {
        for (const auto& [coarse, middle] : {std::pair{4.0, 2.0}, {5.7, 1.8}, {3.2, 2.1}}) {
            const double far = std::pow(coarse, order), near = std::pow(middle, order);
            CAPTURE(order);
            CAPTURE(coarse);
            CHECK(order_among(coarse, middle, difference(far, near), difference(near, 1)) ==
                  doctest::Approx(order).epsilon(0.02));
        }
    }
    CHECK(order_among(4, 2, 1, 3) < -1); // as far apart as the range of orders goes
}

TEST_CASE("the frontier has rising time and falling error; the best within a budget is its last below it") {
    const Level level(R"({"grid": {"nx": 64, "ny": 48, "dx": 1}, "dt": 0.02})", "", "");
    WayModel first{{2, 1, 1, -1}, {1e-5, 1e-8}, {}, ErrorFit{1, 0.5, 0}}, second = first;
    second.way.water_order = 2;
    second.time.per_cell = 1.5e-8;
    second.water = ErrorFit{0.5, 1, 0};
    const std::vector<Candidate> all = candidates(level, {first, second}, 128, 60, 1), kept = frontier(all);
    REQUIRE(kept.size() > 5);
    CHECK(kept.size() < all.size());
    for (std::size_t n = 1; n < kept.size(); ++n) {
        CHECK(kept[n].frame_ms >= kept[n - 1].frame_ms);
        CHECK(kept[n].sum() < kept[n - 1].sum());
    }
    const double budget = (kept[3].frame_ms + kept[4].frame_ms) / 2;
    REQUIRE(best_within(kept, budget));
    CHECK(best_within(kept, budget)->settings == kept[3].settings);
    CHECK_FALSE(best_within(kept, 0.5 * kept[0].frame_ms));
    // Where no error can be told, cells are what time buys.
    first.water = second.water = std::nullopt;
    const std::vector<Candidate> blind = frontier(candidates(level, {first, second}, 128, 60, 1));
    for (const Candidate& c : blind) CHECK(c.settings.way.water_order == 1);
    CHECK(blind.back().settings.nx == 4 * 64);
}
