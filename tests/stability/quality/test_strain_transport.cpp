// What of the deformation gradient moves with the sand (NUMERICS 2.5, 2.13): backends agree, and each form is another one.
#include "engine/settings/data/method_presets.hpp"
#include "tests/support/worlds.hpp"
#include <cmath>
#include <doctest/doctest.h>
#include <set>

using namespace wadi;
using namespace wadi::test;

namespace {

enum class Form { robust, polar, direct };

void choose(Form form, Settings& settings) {
    choose_method(settings, form == Form::robust ? "robust" : "published");
    if (form == Form::direct) settings.method.strain_transport = StrainTransport::direct;
}

float largest(World& world, const char* field) {
    const auto raw = world.reader().read_raw(field);
    REQUIRE(raw);
    float most = 0;
    for (const float x : *raw) most = std::max(most, std::abs(x));
    return most;
}

} // namespace

TEST_CASE("forms of strain: mass kept, the same bits on every backend, other bits than each other") {
    std::set<std::uint64_t> different;
    for (const auto form : {Form::robust, Form::polar, Form::direct}) {
        std::uint64_t hash = 0;
        auto scene = mixed_scene(48, 40);
        choose(form, scene.settings);
        scene.settings.method.quantum = -1;
        for (const auto& backend : available_backends()) {
            CAPTURE(backend);
            auto world = make_world(scene, {.backend = backend, .shared_device = true});
            step(*world, 60);
            const auto stats = world->reader().stats();
            REQUIRE(stats);
            CHECK(stats->sand_quanta == stats->sand_initial);
            CHECK(stats->not_finite == 0);
            CHECK((largest(*world, "rotation") > 0) == (form != Form::robust));
            if (hash == 0) hash = hash_of(*world);
            CHECK(hash == hash_of(*world));
        }
        different.insert(hash);
    }
    CHECK(different.size() == 3);
}

TEST_CASE("a pile that friction holds gathers strain only where F follows the velocity ahead of friction") {
    for (const auto form : {Form::robust, Form::polar, Form::direct}) {
        auto scene = flat_scene(50, 50, 0.1, 0.009);
        scene.fill(scene.fields.sand, [](double x, double y) { return std::max(0.0, 1.0 - 0.4 * std::hypot(x - 2.5, y - 2.5)); });
        choose(form, scene.settings);
        auto world = make_world(scene);
        step(*world, 100);
        const float strain = std::max(largest(*world, "stretch_xx"), largest(*world, "stretch_yy"));
        MESSAGE("largest strain of a pile at rest after 100 steps: " << strain);
        CHECK((form == Form::robust ? strain == 0 : strain > 1e-6F));
    }
}
