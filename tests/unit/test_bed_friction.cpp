// The formulas of bed friction (NUMERICS 2.4) by themselves: the cube root, what a velocity is left with, and that neither has a
// value at which it breaks.
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

namespace {
namespace stage {
// The prelude first.
#include "shaders/language/stage_cpp.h"

#include "shaders/physics/bed_friction.glsl"
} // namespace stage

double wide(float x) { return static_cast<double>(x); }

} // namespace

TEST_CASE("bed friction: 1 over the cube root, over all depths that a world can have and far beyond") {
    double most = 0;
    for (double h = 1e-30; h < 1e30; h *= 1.00037) {
        const auto depth = static_cast<float>(h);
        most = std::max(most, std::abs(wide(stage::inverse_cube_root(depth)) * std::cbrt(wide(depth)) - 1));
    }
    MESSAGE("relative error " << most);
    CHECK(most < 2e-7);
    CHECK(std::isfinite(stage::inverse_cube_root(0)));
}

TEST_CASE("bed friction: what is left of a velocity") {
    for (const float rate : {0.0F, 1e-6F, 1e-2F, 1.0F, 1e3F, 1e9F}) {
        CAPTURE(rate);
        for (const float u : {0.0F, 1e-4F, 0.1F, 3.0F, 200.0F}) {
            // Along the flow: V' (1 + rate |V'|) = V*.
            const double left = wide(stage::bed_friction(u, 0, 0, rate));
            CHECK(left * (1 + wide(rate) * left) == doctest::Approx(wide(u)).epsilon(1e-6));
            CHECK(stage::bed_friction(-u, 0, 0, rate) == -stage::bed_friction(u, 0, 0, rate));
            for (const float v : {0.0F, 1e-3F, 2.0F}) {
                // Pushed by as much as friction takes from it, a velocity stays, at any angle and rate.
                const double speed = std::hypot(wide(u), wide(v));
                const auto pushed = static_cast<float>(wide(u) * (1 + wide(rate) * speed));
                CHECK(wide(stage::bed_friction(pushed, u, v, rate)) == doctest::Approx(wide(u)).epsilon(1e-6));
                CHECK(stage::bed_friction(u, 1, v, rate) <= u);
                CHECK(stage::bed_friction(u, 1, v, rate) == stage::bed_friction(u, -1, -v, rate));
            }
        }
    }
    const float huge = 1e30F;
    for (const float rate : {1e-6F, 1.0F, 1e30F})
        for (const float pushed : {1.0F, 1e15F, huge})
            for (const float across : {0.0F, 1e10F, huge}) {
                const float left = stage::bed_friction(pushed, huge, across, rate);
                CHECK((left >= 0 && left <= pushed));
            }
}
