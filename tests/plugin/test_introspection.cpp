// What a world says of itself: memory by buffer, effects and why, its error, messages of its device.
#include "tests/plugin/abi_worlds.hpp"
#include <cstring>
#include <doctest/doctest.h>
#include <numeric>
#include <set>

using namespace wadi::test;

namespace {

std::vector<wadi_memory_item> memory_of(const AbiWorld& world) {
    uint32_t count = 0;
    REQUIRE(wadi_world_get_memory(world.id, nullptr, &count) == WADI_OK);
    std::vector<wadi_memory_item> items(count);
    REQUIRE(wadi_world_get_memory(world.id, items.data(), &count) == WADI_OK);
    return items;
}

} // namespace

TEST_CASE("the list of buffers adds up to the bytes on the device, and grows with what is asked for") {
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        auto world = mixed_world(backend, 24);
        const auto total = [](const std::vector<wadi_memory_item>& items) {
            return std::accumulate(items.begin(), items.end(), uint64_t{0},
                                   [](uint64_t sum, const wadi_memory_item& item) { return sum + item.bytes; });
        };
        const auto before = memory_of(world);
        CHECK(total(before) == device_bytes(world.id));
        std::set<std::string> labels;
        for (const auto& item : before) labels.insert(item.label);
        CHECK(labels.size() == before.size());
        CHECK(labels.contains("water_height"));
        CHECK(labels.contains("water_height_next"));
        uint64_t ticket = 0;
        REQUIRE(wadi_world_begin_save(world.id, &ticket) == WADI_OK);
        CHECK(memory_of(world).size() > before.size());
        CHECK(total(memory_of(world)) == device_bytes(world.id));
    }
}

TEST_CASE("effects come with a reason, and the small array is filled no further") {
    auto world = pond("cpu", 4, 4, 1, 1);
    uint32_t count = 0;
    REQUIRE(wadi_world_get_effects(world.id, nullptr, &count) == WADI_OK);
    CHECK(count >= 12);
    std::vector<wadi_effect_info> effects(count);
    effects[1].on = -7;
    uint32_t one = 1;
    REQUIRE(wadi_world_get_effects(world.id, effects.data(), &one) == WADI_OK);
    CHECK(one == count);
    CHECK(effects[1].on == -7);
    REQUIRE(wadi_world_get_effects(world.id, effects.data(), &count) == WADI_OK);
    for (const auto& effect : effects) {
        CHECK(std::strlen(effect.why) > 0);
        CHECK(effect.on == (std::string(effect.name) == "water" ? 1 : 0));
    }
    CHECK(wadi_world_get_effects(world.id, effects.data(), nullptr) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_get_memory(world.id, nullptr, nullptr) == WADI_ERROR_BAD_ARGUMENT);
}

TEST_CASE("tables come as text without a world; a name that is none is refused") {
    for (const char* table : {"settings", "effects", "fields", "stages", "schema"}) {
        CAPTURE(table);
        const size_t length = wadi_describe_table(table, nullptr, 0);
        CHECK(length > 500);
        std::vector<char> text(length + 1, 'x');
        CHECK(wadi_describe_table(table, text.data(), text.size()) == length);
        CHECK(std::strlen(text.data()) == length);
        CHECK(wadi_describe_table(table, text.data(), 10) == length);
        CHECK(std::strlen(text.data()) == 9);
    }
    CHECK(wadi_describe_table("setings", nullptr, 0) == 0);
    CHECK(std::string(wadi_get_last_error()) ==
          "wadi_describe_table: no table is called \"setings\", did you mean \"settings\"?");
    CHECK(wadi_describe_table(nullptr, nullptr, 0) == 0);
    CHECK(std::string(wadi_get_last_error()) == "wadi_describe_table: table is NULL");
}

TEST_CASE("a healthy world has no error") {
    auto world = pond("cpu", 4, 4, 1, 1);
    CHECK(wadi_world_step(wadi_world_id{0, 0}, 1) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_get_error(world.id) == WADI_OK);
    CHECK(std::string(wadi_get_last_error()).find("wadi_world_step") !=
          std::string::npos); // of the newest error, whatever succeeded since
    const char* const kept = wadi_get_last_error();
    CHECK(wadi_world_get_error(wadi_world_id{0, 0}) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(kept == wadi_get_last_error());
    CHECK(std::string(kept).find("wadi_world_get_error") != std::string::npos);
}
