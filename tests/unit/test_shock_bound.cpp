// What bounds shock viscosity (NUMERICS 2.3) by itself: no rounding of two speeds may say whose flux counts.
#include <cmath>
#include <doctest/doctest.h>

namespace {
namespace stage {
// The prelude first.
#include "shaders/language/stage_cpp.h"

#include "shaders/physics/shock_viscosity.glsl"
} // namespace stage

double wide(float x) { return static_cast<double>(x); }

} // namespace

TEST_CASE("shock viscosity: the flux that bounds it does not jump where both faces are as fast") {
    for (const float speed : {1e-18F, 1e-3F, 2.0F, 5e4F}) {
        CAPTURE(speed);
        const float less = std::nextafter(speed, 0.0F);
        const float film = 1e-3F, lake = 7.0F;
        const float tie = stage::faster_flux(speed, -speed, film, lake);
        CHECK(tie == lake); // the larger one
        CHECK(wide(stage::faster_flux(speed, -less, film, lake)) == doctest::Approx(wide(lake)).epsilon(1e-5));
        CHECK(wide(stage::faster_flux(less, -speed, film, lake)) == doctest::Approx(wide(lake)).epsilon(1e-5));
        CHECK(stage::faster_flux(speed, -0.7F * speed, film, lake) == film); // the faster one's alone
        CHECK(stage::faster_flux(0.7F * speed, -speed, film, lake) == lake);
        for (const float other : {0.7F * speed, 0.8F * speed, 0.95F * speed, less, speed}) // the same of the image
            CHECK(stage::faster_flux(speed, -other, film, lake) == stage::faster_flux(other, -speed, lake, film));
    }
    CHECK(stage::faster_flux(0, 0, 1e-3F, -7) == 7);
}
