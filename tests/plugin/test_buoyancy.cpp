// Buoyancy and drag against closed forms, on water given by hand and on a simulated pond.
#include "tests/plugin/abi_worlds.hpp"
#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <numbers>
#include <thread>

using namespace wadi::test;

namespace {

constexpr double weight = 1000 * 9.81; // of a cubic metre of water [N]

struct Wrench {
    float force[3] = {}, torque[3] = {};
};

std::vector<float> points_of(const wadi_body& body) {
    uint32_t count = 0;
    REQUIRE_MESSAGE(wadi_buoyancy_points(&body, nullptr, &count) == WADI_OK, std::string(wadi_get_last_error()));
    std::vector<float> xy(2 * count);
    REQUIRE(wadi_buoyancy_points(&body, xy.data(), &count) == WADI_OK);
    return xy;
}

// Water of a level and depth everywhere.
Wrench in_water(const wadi_body& body, float level, float depth, float u = 0) {
    std::vector<wadi_query_result> water(points_of(body).size() / 2);
    for (auto& w : water) {
        w.inside = 1;
        w.surface = level;
        w.water_depth = depth;
        w.velocity[0] = u;
    }
    Wrench wrench;
    REQUIRE_MESSAGE(wadi_buoyancy_force(&body, water.data(), static_cast<uint32_t>(water.size()), wrench.force, wrench.torque) ==
                        WADI_OK,
                    std::string(wadi_get_last_error()));
    return wrench;
}

wadi_body box(float hx, float hy, float hz) {
    auto body = wadi_default_body();
    body.half_size[0] = hx;
    body.half_size[1] = hy;
    body.half_size[2] = hz;
    body.quadratic_drag = 0;
    return body;
}

void turn_about_y(wadi_body& body, double angle) {
    body.orientation[1] = static_cast<float>(std::sin(angle / 2));
    body.orientation[3] = static_cast<float>(std::cos(angle / 2));
}

} // namespace

TEST_CASE("a box displaces what lies under water") {
    auto body = box(1, 0.5F, 0.25F);
    const double whole = weight * 8 * 0.125;
    CHECK(in_water(body, 5, 20).force[2] == doctest::Approx(whole));
    CHECK(in_water(body, 0, 20).force[2] == doctest::Approx(whole / 2));
    CHECK(in_water(body, 0.125F, 20).force[2] == doctest::Approx(0.75 * whole));
    CHECK(in_water(body, -1, 20).force[2] == 0);                             // above the water
    CHECK(in_water(body, 0.1F, 0).force[2] == 0);                            // dry
    CHECK(in_water(body, 0, 0.125F).force[2] == doctest::Approx(whole / 4)); // half of the wet part stands in the bed
    for (int k = 0; k < 3; ++k) CHECK(in_water(body, 0, 20).torque[k] == doctest::Approx(0).epsilon(1e-3));
    // On its side and turned about the vertical it displaces the same.
    turn_about_y(body, std::numbers::pi / 2);
    CHECK(in_water(body, 0, 20).force[2] == doctest::Approx(whole / 2));
    CHECK(in_water(body, 5, 20).force[2] == doctest::Approx(whole));
}

TEST_CASE("a sphere displaces the cap under water") {
    auto body = wadi_default_body();
    body.shape = WADI_BODY_SPHERE;
    body.radius = 0.8F;
    body.quadratic_drag = 0;
    body.samples = 16;
    const double whole = weight * 4 / 3 * std::numbers::pi * 0.512;
    CHECK(in_water(body, 3, 20).force[2] == doctest::Approx(whole));
    CHECK(in_water(body, 0, 20).force[2] == doctest::Approx(whole / 2));
    const double h = 0.4; // depth of the cap
    CHECK(in_water(body, -0.4F, 20).force[2] ==
          doctest::Approx(weight * std::numbers::pi * h * h * (3 * 0.8 - h) / 3).epsilon(0.03));
    CHECK(in_water(body, -0.9F, 20).force[2] == 0);
}

TEST_CASE("a tilted flat box is righted as its waterplane says, a full one not at all") {
    auto body = box(1, 1, 0.25F);
    body.samples = 16;
    const double angle = 0.05;
    turn_about_y(body, angle);
    const auto afloat = in_water(body, 0, 20);
    // Small angles: moment = weight (waterplane's second moment - volume * depth of its centre below the middle) * angle.
    const double volume = 1, second = 2 * 8 / 12.0, below = 0.125;
    CHECK(afloat.force[2] == doctest::Approx(weight * volume));
    CHECK(afloat.torque[1] == doctest::Approx(-weight * (second - volume * below) * angle).epsilon(0.02));
    CHECK(std::abs(afloat.torque[0]) < 1);
    CHECK(std::abs(in_water(body, 5, 20).torque[1]) < 1);
}

TEST_CASE("drag follows the flow relative to the body, by the share under water") {
    auto body = box(0.5F, 0.5F, 0.5F);
    body.linear_drag = 40;
    CHECK(in_water(body, 5, 20, 2).force[0] == doctest::Approx(80));
    CHECK(in_water(body, 0, 20, 2).force[0] == doctest::Approx(40));
    body.linear_drag = 0;
    body.quadratic_drag = 1.2F;
    CHECK(in_water(body, 5, 20, 2).force[0] == doctest::Approx(0.5 * 1000 * 1.2 * 4));
    body.velocity[0] = 3;
    CHECK(in_water(body, 5, 20, 2).force[0] == doctest::Approx(-0.5 * 1000 * 1.2));
    body.velocity[0] = 0;
    body.angular_velocity[2] = 1; // turning is braked
    CHECK(in_water(body, 5, 20, 0).torque[2] < 0);
    CHECK(in_water(body, 5, 0, 2).force[0] == 0);
}

TEST_CASE("a box in a simulated pond is carried by it, outside the grid by nothing") {
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        auto world = pond(backend, 16, 16, 0.5, 2);
        step(world, 3);
        auto body = box(1, 1, 0.5F);
        body.position[0] = body.position[1] = 4;
        body.position[2] = 2;
        for (const double expected : {weight * 2, 0.0}) {
            const auto xy = points_of(body);
            uint64_t ticket = 0;
            REQUIRE(wadi_world_query(world.id, xy.data(), static_cast<uint32_t>(xy.size() / 2), &ticket) == WADI_OK);
            std::vector<wadi_query_result> water(xy.size() / 2);
            const auto count = static_cast<uint32_t>(water.size());
            while (wadi_world_get_query(world.id, ticket, water.data(), count, nullptr, nullptr) == WADI_NOT_READY)
                std::this_thread::yield();
            Wrench wrench;
            REQUIRE(wadi_buoyancy_force(&body, water.data(), count, wrench.force, wrench.torque) == WADI_OK);
            CHECK(wrench.force[2] == doctest::Approx(expected));
            body.position[0] = -20;
        }
    }
}

TEST_CASE("bad bodies are refused by name") {
    const auto refused = [](auto change, const char* text) {
        auto body = wadi_default_body();
        change(body);
        uint32_t count = 0;
        CHECK(wadi_buoyancy_points(&body, nullptr, &count) == WADI_ERROR_BAD_ARGUMENT);
        CHECK_MESSAGE(error_mentions(text), std::string(wadi_get_last_error()));
    };
    refused([](wadi_body& b) { b.struct_size = 3; }, "struct_size");
    refused([](wadi_body& b) { b.shape = static_cast<wadi_body_shape>(2); }, "shape");
    refused([](wadi_body& b) { b.position[1] = std::nanf(""); }, "position");
    refused([](wadi_body& b) { b.half_size[2] = 0; }, "half_size");
    refused([](wadi_body& b) { b.shape = WADI_BODY_SPHERE, b.radius = -1; }, "radius");
    refused([](wadi_body& b) { b.orientation[3] = 0; }, "orientation");
    refused([](wadi_body& b) { b.orientation[0] = std::nanf(""); }, "orientation");
    refused([](wadi_body& b) { b.samples = 17; }, "samples");
    refused([](wadi_body& b) { b.quadratic_drag = -1; }, "quadratic_drag");
    const auto body = wadi_default_body();
    uint32_t count = 3;
    float xy[6], force[3];
    CHECK(wadi_buoyancy_points(&body, xy, &count) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(count == 16);
    CHECK(wadi_buoyancy_points(&body, xy, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_buoyancy_points(nullptr, xy, &count) == WADI_ERROR_BAD_ARGUMENT);
    const wadi_query_result water[16] = {};
    CHECK(wadi_buoyancy_force(&body, water, 15, force, force) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("16 points"));
    CHECK(wadi_buoyancy_force(&body, nullptr, 16, force, force) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_buoyancy_force(&body, water, 16, nullptr, force) == WADI_ERROR_BAD_ARGUMENT);
}
