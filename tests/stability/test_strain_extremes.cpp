// The stretch of sand far from the identity: any finite V comes back to the yield surface, many turns leave its size, and a
// world stays calm after its strain was torn, turned inside out or filled with repeated singular values.
#include "tests/stability/quality.hpp"
#include <cstring>
#include <limits>
#include <random>

using namespace wadi;
using namespace wadi::test;

namespace {
namespace stage {
// The prelude first.
#include "shaders/language/stage_cpp.h"

#include "shaders/physics/strain.glsl"
} // namespace stage
using namespace stage;

struct Yield { // of the prototype's sand
    float bulk = 2.4e5F, two_shear = 1.54e5F, slope = 0.4F * (1.54e5F + 2 * 0.87e5F * 2), cap = 19620, cohesion = 2e4F;
};

Stretch project(Stretch v, Stress& stress) {
    const Yield y;
    project_stretch(v, stress, y.cohesion, y.cap, y.bulk, 1 / y.bulk, y.two_shear, 1 / y.two_shear, y.slope, 1 / y.slope,
                    1 / 0.4F);
    return v;
}
bool finite(const Stretch& v, const Stress& s) {
    return std::isfinite(v.xx) && std::isfinite(v.xy) && std::isfinite(v.yy) && std::isfinite(s.xx) && std::isfinite(s.xy) &&
           std::isfinite(s.yy);
}
double size(const Stretch& v) {
    return std::sqrt(double(v.xx) * double(v.xx) + 2 * double(v.xy) * double(v.xy) + double(v.yy) * double(v.yy));
}
} // namespace

TEST_CASE("any stretch, torn, inside out, not a number or with repeated singular values, is projected once and for all") {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1, 1);
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
    const float values[] = {0, -1, -2, 1e-7F, -1e-7F, 1e-20F, 1e3F, 1e19F, -1e19F, 3e38F, infinite, nan};
    int not_finite = 0, restless = 0, wrong_reset = 0;
    double largest_stress = 0;
    for (int n = 0; n < 300000; ++n) {
        const float scale = std::pow(10.0F, 4 * uniform(random) - 2);
        Stretch v{scale * uniform(random), scale * uniform(random), scale * uniform(random)};
        if (n % 5 == 0) v.yy = v.xx, v.xy = 0;
        if (n % 7 == 0) v.yy = (1 / (1 + v.xx)) * v.xy * v.xy - 1; // det = 0 but for rounding
        if (n < 12 * 12 * 12) v = {values[n % 12], values[n / 12 % 12], values[n / 144]};
        const float det = 1 + ((v.xx + v.yy) + (v.xx * v.yy - v.xy * v.xy));
        Stress stress{}, again{};
        const Stretch once = project(v, stress), twice = project(once, again);
        if (!finite(once, stress)) ++not_finite;
        if (!(det > 1e-6F) && size(once) != 0) ++wrong_reset;
        if (std::fabs(size(twice) - size(once)) > 1e-7) ++restless;
        largest_stress = std::max({largest_stress, std::fabs(double(stress.xx)), std::fabs(double(stress.yy))});
    }
    CHECK(not_finite == 0);
    CHECK(wrong_reset == 0);
    CHECK(restless == 0);
    CHECK(largest_stress < 5e5); // bounded by the cap on compression and the cone
    // Why the reset is there: clamp and series let NaN through, and a stretch that is inverted twice has a sound determinant.
    CHECK(std::isnan(arc_tanh_over(wclamp(nan, 0, 1))));
}

TEST_CASE("thousands of turns, by angles up to pi, leave a stretch its size and its trace") {
    for (const double angle : {0.01, 0.1, 0.4}) { // per substep; 0.4 is the gradient clamp
        CAPTURE(angle);
        Stretch v{0.1F, 0.03F, -0.05F};
        const double before = size(v);
        const float g = static_cast<float>(2 * std::tan(angle / 2));
        for (int n = 0; n < 100000; ++n) v = evolve_stretch(v, {0, -g, g, 0});
        CHECK(std::fabs(size(v) / before - 1) < 6e-3);
        CHECK(v.xx + v.yy == doctest::Approx(0.05).epsilon(0.01));
    }
    // Half a turn at once: the angle is +-pi to rounding, from both sides. V V^T comes back as it was.
    for (const float tilt : {0.0F, 1e-6F, -1e-6F}) {
        const Stretch v{0.1F, 0.03F, -0.05F};
        Turn by;
        const Stretch right = right_stretch(-2 - v.xx + tilt, -v.xy, -v.xy + tilt, -2 - v.yy, by);
        CHECK(right.xx == doctest::Approx(0.1).epsilon(1e-4));
        CHECK(right.yy == doctest::Approx(-0.05).epsilon(1e-4));
        CHECK(by.cs == doctest::Approx(-1));
    }
    // Negative control: F + G F, the paper's form, swells.
    double stretch = 1;
    for (int n = 0; n < 10000; ++n) stretch *= std::sqrt(1 + 0.01 * 0.01);
    CHECK(stretch > 1.5);
}

TEST_CASE("gradient clamp below 1/2: no velocities around a cell turn its strain inside out, by either form; above it some do") {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-1, 1);
    const auto inside_out = [&](float limit) {
        struct Count {
            int cayley = 0, explicit_form = 0;
        } count;
        for (int n = 0; n < 200000; ++n) {
            const float scale = std::pow(10.0F, 4 * uniform(random));
            const auto u = [&] { return scale * uniform(random); };
            const unsigned wet = n % 16;
            const Gradient g = velocity_gradient(u(), u(), u(), u(), u(), u(), u(), u(), (wet & 1) != 0, (wet & 2) != 0,
                                                 (wet & 4) != 0, (wet & 8) != 0, 1, limit);
            Stress stress{};
            const Stretch v = project({uniform(random), uniform(random), uniform(random)}, stress);
            const Stretch now = evolve_stretch(v, g);
            if (!(double(1 + now.xx) * double(1 + now.yy) > double(now.xy) * double(now.xy))) ++count.cayley;
            if (!(double(1 + g.xx) * double(1 + g.yy) > double(g.xy) * double(g.yx))) ++count.explicit_form; // of F + G F
        }
        return count;
    };
    const auto within = inside_out(0.4F), beyond = inside_out(0.6F), none = inside_out(1e30F);
    CHECK(within.cayley == 0);
    CHECK(within.explicit_form == 0);
    CHECK(beyond.explicit_form > 1000);
    CHECK(none.cayley > 1000);
    CHECK(none.explicit_form > 10000);
}

TEST_CASE("worlds whose steps would turn strain inside out stay finite; what is projected stays within the logarithm's bounds") {
    auto scene = mixed_scene(32, 28);
    scene.settings.dt = 0.3;
    scene.settings.material.young_modulus = 1e9;
    scene.settings.method.gradient_clamp = scene.settings.method.elastic_cap = 0;
    on_every_backend(scene, [&](World& world) {
        step(world, 40);
        const auto sand = cells_of(world, "sand_height");
        double most = 0;
        for (const char* field : {"stretch_xx", "stretch_yy", "stretch_xy"}) {
            const auto stretch = cells_of(world, field);
            for (int j = 0; j < sand.ny; ++j)
                for (int i = 0; i < sand.nx; ++i)
                    if (sand.at(i, j) > 0.01) most = std::max(most, std::fabs(stretch.at(i, j)));
        }
        CHECK(most < std::exp(0.5) - 1 + 1e-3);
    });
}
