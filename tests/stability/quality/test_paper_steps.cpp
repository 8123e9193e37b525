// The paper's scenes at the paper's time steps, which are beyond what their grids can follow (NUMERICS 4).
#include "tests/stability/quality.hpp"

using namespace wadi;
using namespace wadi::test;

TEST_CASE("the paper's time steps, on grids of the levels' Courant number: no checkerboard in water or sand, exact mass" *
          doctest::test_suite("long")) {
    struct Row {
        const char* level;
        int nx, ny;
        double dt, dx;      // the paper's dt [s] on a grid of the level's dx [m]
        double water, sand; // bounds on the checkerboard
    };
    for (const Row& row : {Row{"castle", 96, 48, 0.009, 0.2, 1e-4, 2e-3},
                           {"letters", 96, 48, 0.027, 0.2, 1e-3, 1e-2},
                           {"seepage", 96, 48, 0.015, 0.2, 1e-5, 1e-4},
                           {"spring", 64, 64, 0.012, 0.05, 5e-3, 1e-4},
                           {"dam_break", 64, 64, 0.045, 0.5, 1e-3, 2e-3},
                           {"canyon", 64, 82, 0.03, 0.5, 5e-3, 1e-3}}) {
        CAPTURE(row.level);
        auto scene = shipped_level(row.level, row.nx, row.ny);
        scene.settings.dt = row.dt * scene.settings.grid.dx / row.dx;
        auto world = make_world(scene);
        double water = 0, sand = 0;
        for (int n = 0; n < 10; ++n) {
            step(*world, 10);
            water = std::max(water, water_checkerboard(*world));
            sand = std::max(sand, checkerboard(cells_of(*world, "sand_height")));
        }
        check_books(*world);
        CHECK(water < row.water);
        CHECK(sand < row.sand);
        if (std::string(row.level) != "spring" && std::string(row.level) != "dam_break") continue;
        scene.settings.method.gravity_cap = 0; // negative control, where dt is beyond the CFL limit
        CHECK(worst(*make_world(scene), 100, 10, water_checkerboard) > 0.1);
    }
}
