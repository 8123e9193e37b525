// Structs of hosts of other versions, on structs made for it; what the header's initialisers say against the engine's own
// defaults.
#include "engine/frames/frame_driver.hpp"
#include "engine/reads/buoyancy.hpp"
#include "plugin/src/struct_sizes.hpp"
#include <array>
#include <doctest/doctest.h>

namespace {

struct FirstThing {
    std::uint32_t struct_size;
    float amount;
};
struct GrownThing {
    std::uint32_t struct_size;
    float amount;
    double added;
};
constexpr GrownThing grown_default{sizeof(GrownThing), 1, 2.5};

} // namespace

namespace wadi::plugin {
WADI_FIRST_BYTES(GrownThing, amount)
WADI_FIRST_BYTES(FirstThing, amount)
} // namespace wadi::plugin

using namespace wadi;
using namespace wadi::plugin;

TEST_CASE("struct sizes: an older host's struct has defaults for what it lacks, and nothing is written behind it") {
    const FirstThing old_thing{sizeof(FirstThing), 7};
    std::array<std::byte, 32> memory{};
    memory.fill(std::byte{0xA5});
    std::memcpy(memory.data(), &old_thing, sizeof old_thing);
    auto* const host = reinterpret_cast<GrownThing*>(memory.data());
    REQUIRE(understood("thing", host));
    const auto own = taken(host, grown_default);
    CHECK(own.amount == 7);
    CHECK(own.added == 2.5);
    CHECK(own.struct_size == sizeof(GrownThing));
    give(host, GrownThing{sizeof(GrownThing), 9, 4});
    FirstThing after{};
    std::memcpy(&after, memory.data(), sizeof after);
    CHECK(after.struct_size == sizeof(FirstThing));
    CHECK(after.amount == 9);
    CHECK(std::all_of(memory.begin() + sizeof(FirstThing), memory.end(), [](std::byte b) { return b == std::byte{0xA5}; }));
}

TEST_CASE("struct sizes: a newer host's struct is taken while what is not known is zero, and given zeros there") {
    GrownThing newer{sizeof(GrownThing), 7, 0};
    auto* const host = reinterpret_cast<FirstThing*>(&newer);
    REQUIRE(understood("thing", host));
    CHECK(taken(host, FirstThing{sizeof(FirstThing), 1}).amount == 7);
    newer.added = 3;
    const auto refused = understood("thing", host);
    CHECK_FALSE(refused);
    CHECK(refused.message.find("does not know") != std::string::npos);
    give(host, FirstThing{sizeof(FirstThing), 9});
    CHECK(newer.struct_size == sizeof(GrownThing));
    CHECK(newer.amount == 9);
    CHECK(newer.added == 0);
}

TEST_CASE("struct sizes: what no header has is refused: less than the first, more than any") {
    for (const std::uint32_t bytes : {0U, 4U, 7U, 5000U, 0xA5A5A5A5U}) {
        const GrownThing thing{bytes, 1, 2};
        CHECK_FALSE(understood("thing", &thing));
    }
    CHECK_FALSE(understood<GrownThing>("thing", nullptr));
    // Elements are as far apart as the first one says.
    std::array<FirstThing, 3> old_things{{{sizeof(FirstThing), 1}, {sizeof(FirstThing), 2}, {sizeof(FirstThing), 3}}};
    CHECK(element(reinterpret_cast<GrownThing*>(old_things.data()), 2)->amount == 3);
}

TEST_CASE("struct sizes: the header's initialisers are the engine's defaults") {
    const auto pace = wadi_default_update_settings();
    const UpdateSettings engine;
    CHECK(pace.max_steps_per_update == engine.max_steps_per_update);
    CHECK(pace.max_steps_in_flight == engine.max_steps_in_flight);
    CHECK((pace.spread == 1) == engine.spread);
    CHECK((pace.interpolate_outputs == 1) == engine.interpolate_outputs);
    const auto given = wadi_default_body();
    const Body body;
    CHECK(given.shape == WADI_BODY_BOX);
    CHECK(body.shape == BodyShape::box);
    CHECK(given.orientation[3] == body.orientation[3]);
    for (std::size_t n = 0; n < 3; ++n) CHECK(given.half_size[n] == static_cast<float>(body.half_size[n]));
    CHECK(given.radius == static_cast<float>(body.radius));
    CHECK(given.water_density == static_cast<float>(body.water_density));
    CHECK(given.gravity == static_cast<float>(body.gravity));
    CHECK(given.linear_drag == static_cast<float>(body.linear_drag));
    CHECK(given.quadratic_drag == static_cast<float>(body.quadratic_drag));
    CHECK(given.samples == body.samples);
}
