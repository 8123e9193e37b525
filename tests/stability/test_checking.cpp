// The checking mode: silent over worlds that keep their promises, and the first that is broken named with step, field and cell.
#include "engine/settings/data/method_presets.hpp"
#include "tests/support/worlds.hpp"
#include <cmath>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

std::unique_ptr<World> checked_world(const Scene& scene, const std::string& backend = "cpu") {
    auto world = make_world(scene, {backend});
    world->checking().set(true);
    return world;
}

/// What the first of `steps` steps that fails says.
std::string first_fault(World& world, int steps) {
    for (int n = 0; n < steps; ++n) {
        const auto status = world.step(1);
        if (status) continue;
        CHECK(status.code == Code::internal);
        return status.message;
    }
    return "";
}

/// What no call of a host's can do: a number in a field as only a fault of the solver's would leave it.
void overwrite(World& world, const std::string& field, int i, int j, float value) {
    auto& fields = const_cast<WorldState&>(world.state()).fields();
    REQUIRE(fields.write(field, world.state().layout().index(i, j), std::span(&value, 1)));
}

bool says(const std::string& message, const std::string& part) { return message.find(part) != std::string::npos; }

} // namespace

TEST_CASE("checking: a world that keeps its promises steps in silence, runs of steps too, and keeps its bits") {
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        const auto scene = mixed_scene(33, 17);
        auto plain = make_world(scene, {backend}), checked = make_world(scene, {backend});
        checked->checking().set(true);
        const auto status = checked->step(40);
        CHECK_MESSAGE(status, status.message);
        step(*plain, 40);
        CHECK(hash_of(*checked) == hash_of(*plain));
    }
}

TEST_CASE("checking: the step after which quanta are missing is named; unchecked, the same world goes on") {
    auto scene = mixed_scene(40, 36);
    scene.settings.dt = 0.2;
    scene.settings.method.velocity_clamp = 0.9;
    scene.settings.method.outflow_limiter = false;
    auto checked = checked_world(scene), plain = make_world(scene);
    const std::string fault = first_fault(*checked, 60);
    CAPTURE(fault);
    CHECK(says(fault, "after step " + std::to_string(checked->steps())));
    CHECK((says(fault, "more than its books") || says(fault, "no height is negative")));
    CHECK(first_fault(*plain, 60).empty());
    checked->checking().set(false);
    CHECK(first_fault(*checked, 3).empty());
}

TEST_CASE("checking: a number that is not finite is named with field and cell, of method published too") {
    auto scene = mixed_scene(24, 20);
    choose_method(scene.settings, "published");
    auto world = checked_world(scene);
    CHECK(first_fault(*world, 2).empty());
    overwrite(*world, "water_height", 7, 5, std::nanf(""));
    const auto status = world->checking().look();
    CAPTURE(status.message);
    CHECK(says(status.message, "water_height(7, 5) is nan"));
    CHECK(says(status.message, "after step 2 "));
}

TEST_CASE("checking: a negative height and a speed above its clamp are named with their cell or face") {
    const auto scene = mixed_scene(24, 20);
    const auto fault = [&](const char* field, float value) {
        auto world = make_world(scene);
        step(*world, 2);
        overwrite(*world, field, 3, 11, value);
        const auto status = world->checking().look();
        CHECK(status.code == Code::internal);
        return status.message;
    };
    CHECK(says(fault("sand_height", -0.25F), "sand_height(3, 11) is -0.25; promised: no height is negative"));
    CHECK(says(fault("sand_velocity_y", 1e4F), "sand_velocity_y(3, 11) is 10000; promised: no speed is above its clamp"));
    CHECK(says(fault("water_velocity_x", -1e4F), "water_velocity_x(3, 11) is -10000; promised: no speed is above its clamp"));
    CHECK(says(fault("sand_height", 1.5F), "of sand more than its books"));
}
