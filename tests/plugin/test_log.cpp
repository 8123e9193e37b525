// What the log callback hears, and a callback that throws.
#include "tests/plugin/abi_worlds.hpp"
#include <algorithm>
#include <doctest/doctest.h>
#include <stdexcept>

using namespace wadi::test;

namespace {

struct Heard {
    std::vector<std::pair<int, std::string>> messages;
    bool throws = false;
    bool has(int severity, const std::string& text) const {
        for (const auto& [s, message] : messages) {
            if (s == severity && message.find(text) != std::string::npos) return true;
        }
        return false;
    }
};

void hear(void* user, wadi_log_level severity, const char* message) {
    auto& heard = *static_cast<Heard*>(user);
    heard.messages.emplace_back(severity, message);
    if (heard.throws) throw std::runtime_error("from the host's callback");
}

// Water 40 m deep at a step far too long for it: the level gets advice.
AbiWorld deep_pond(const std::string& backend, Heard& heard) {
    const char* settings = R"({ "format_version": 1, "name": "deep pond", "grid": { "nx": 16, "ny": 8, "dx": 0.5 }, "dt": 0.1,
        "water": [ { "shape": "plane", "height": 40 } ], "method": { "largest_height": 64 } })";
    auto options = wadi_default_device_options();
    options.backend = backend.c_str();
    options.log = hear;
    options.log_user = &heard;
    wadi_world_id world{};
    REQUIRE(wadi_create_world_from_level_text(settings, nullptr, nullptr, nullptr, &options, &world) == WADI_OK);
    return AbiWorld(world);
}

} // namespace

TEST_CASE("the log callback hears advice, the world and a promotion; what it throws is swallowed") {
    for (const auto& backend : abi_backends()) {
        for (const bool throws : {false, true}) {
            if (throws && backend != "cpu") continue; // caught where the plugin calls it, whatever the backend
            CAPTURE(backend);
            Heard heard;
            heard.throws = throws;
            const auto world = deep_pond(backend, heard);
            CHECK(heard.has(1, "deep pond: "));
            CHECK(heard.has(2, "16 x 8 cells on "));
            CHECK(heard.has(2, "effects water"));
            CHECK_FALSE(heard.has(2, "sand"));
            const auto before = heard.messages.size();
            step(world, 3);
            CHECK(heard.messages.size() == before); // nothing to tell per step
            auto edit = wadi_default_edit();
            edit.layer = WADI_LAYER_SAND;
            edit.amount = 0.5;
            edit.x0 = 4;
            edit.y0 = 2;
            REQUIRE(wadi_world_edit(world.id, &edit, 1) == WADI_OK);
            step(world, 1);
            CHECK(heard.has(2, "step 3: effects water, sand"));
        }
    }
}

TEST_CASE("the log is told how much of the host's time is dropped, from a whole step on and at ten times as much, and why") {
    for (const bool by_update : {true, false}) {
        CAPTURE(by_update);
        Heard heard;
        const auto world = deep_pond("cpu", heard); // dt is 0.1 s
        auto settings = wadi_default_update_settings();
        settings.max_steps_per_update = by_update ? 1 : 64;
        settings.max_steps_in_flight = by_update ? 0 : 1;
        REQUIRE(wadi_world_set_update_settings(world.id, &settings) == WADI_OK);
        auto frame = wadi_default_frame();
        const auto told = [&] {
            std::vector<std::string> found;
            for (const auto& [severity, message] : heard.messages)
                if (message.find("dropped") != std::string::npos) found.push_back(message);
            return found;
        };
        REQUIRE(wadi_world_update(world.id, 99999999, &frame) == WADI_OK);
        CHECK(told().empty());
        if (by_update) {
            REQUIRE(wadi_world_update(world.id, 100000011, &frame) == WADI_OK);
            REQUIRE(wadi_world_update(world.id, 100000000, &frame) == WADI_OK);
            CHECK(frame.dropped_nanoseconds_total == 11); // a rounding of the host's is not worth a word
            CHECK(told().empty());
            REQUIRE(wadi_world_update(world.id, 400000000, &frame) == WADI_OK);
            REQUIRE(told().size() == 1);
            CHECK_MESSAGE(told()[0].find("updates have dropped 0.3 s of the host's time so far, 42.8 % of it") !=
                              std::string::npos,
                          told()[0]);
        }
        for (int n = 0; n < 50 || (frame.dropped_nanoseconds_total < 60000000000 && n < 5000); ++n)
            REQUIRE(wadi_world_update(world.id, 5000000000, &frame) == WADI_OK);
        REQUIRE(frame.dropped_nanoseconds_total >= 60000000000);
        CHECK(heard.has(1, by_update ? "max_steps_per_update (1)" : "max_steps_in_flight (1)"));
        CHECK(told().size() >= 2); // its real size
        CHECK(told().size() <= 4);
    }
}
