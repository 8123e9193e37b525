// What command logs hold: numbers of the material, which stay what they are when it grows by a key; players; sources.
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

TEST_CASE("command log: players and sources are read as they were written, and a kind that nobody knows is refused") {
    Source source;
    source.shape = SourceShape::box;
    source.material = SourceMaterial::sand;
    source.box = {1, 2, 3, 4};
    source.velocity = {5, 6};
    source.set_velocity = source.drain = true;
    source.rate.samples = {{0, 0.5}, {1, 0.25}};
    source.level.samples = {{2, 7}};
    Edit edit;
    edit.player = 4000000000;
    edit.amount = 0.25;
    const std::vector<Command> commands = {SourceChange{9, 3, 31, source}, edit, Trim{9}};
    const auto log = write_commands(0, {}, commands);
    const auto list = read_commands(log);
    REQUIRE_MESSAGE(list, list.status().message);
    REQUIRE(list->commands.size() == 3);
    const auto& change = std::get<SourceChange>(list->commands[0]);
    CHECK(change.step == 9);
    CHECK(change.player == 3);
    CHECK(change.index == 31);
    CHECK(change.source == source);
    CHECK(std::get<Edit>(list->commands[1]).player == 4000000000);
    CHECK(std::get<Edit>(list->commands[1]).amount == 0.25);
    CHECK(std::holds_alternative<Trim>(list->commands[2]));
    const auto with = [&](std::size_t at, auto value) {
        auto bad = log;
        put(std::span<std::byte>(bad), at, value);
        seal(bad);
        return read_commands(bad).status().message;
    };
    CHECK(with(48, std::uint32_t{5}).find("a command of kind 5, which this library does not know") != std::string::npos);
    constexpr std::size_t source_at = 48 + 24;
    for (const auto& bad : {with(source_at, std::uint32_t{3}), with(source_at + 88, std::uint64_t{1} << 60)})
        CHECK(bad.find("its lists do not end where it does") != std::string::npos);
}
