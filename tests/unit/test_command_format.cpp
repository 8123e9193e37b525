// Numbers of the material in command logs, which stay what they are when the material grows by a key.
#include "engine/edits/command_log.hpp"
#include "engine/saves/sealed_bytes.hpp"
#include "engine/settings/rules/material_keys.hpp"
#include <doctest/doctest.h>

using namespace wadi;

namespace {

constexpr std::size_t number_at = 48 + 16; // of the only command of a log without stamps, behind its kind, layer and step

int key_of(std::span<const std::byte> log) {
    const auto list = read_commands(log);
    REQUIRE_MESSAGE(list, list.status().message);
    REQUIRE(list->commands.size() == 1);
    return std::get<MaterialChange>(list->commands[0]).key;
}

} // namespace

TEST_CASE("command log: a key of the material is the same one in logs of either version") {
    for (const char* name : {"friction", "saturation[0]", "saturation[2]", "porosity"}) {
        CAPTURE(name);
        const int key = find_material_key(name);
        REQUIRE(key >= 0);
        const std::vector<Command> commands = {MaterialChange{3, key, 0.4}};
        CHECK(key_of(write_commands(0, {}, commands)) == key);
    }
    const std::vector<Command> commands = {MaterialChange{3, find_material_key("saturation[1]"), 0.4}};
    auto older = write_commands(0, {}, commands);
    const auto write = [&](std::uint32_t version, std::uint32_t number) {
        begin_sealed(older, "WADICMDS", version);
        std::size_t at = number_at;
        put(std::span<std::byte>(older), at, number);
        seal(older);
    };
    write(2, 21); // of 23 keys, the last three of which are saturation's
    CHECK(key_of(older) == find_material_key("saturation[1]"));
    write(2, 0);
    CHECK(key_of(older) == 0);
    write(3, 21); // control: the same number is another key where lists have numbers of their own
    CHECK(key_of(older) == 21);
    CHECK(find_material_key("saturation[1]") != 21);
}
