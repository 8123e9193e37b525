// Snapshots and command logs whose contents make no sense, with a checksum that is right: refused, or harmless.
#include "engine/saves/snapshot_checks.hpp"
#include "engine/settings/rules/material_keys.hpp"
#include "tests/support/worlds.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>

using namespace wadi;
using namespace wadi::test;

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity(), none = std::numeric_limits<float>::quiet_NaN();

template <class T> void set(std::vector<std::byte>& bytes, std::size_t at, T value) {
    put(std::span<std::byte>(bytes), at, value);
}

bool finite(World& world) {
    for (const auto& [name, values] : state_of(world)) {
        const FieldLayout& layout = world.state().layout();
        if (values.size() != layout.size() || field_row(name).role != FieldRole::state) continue;
        for (int j = 0; j < layout.ny; ++j)
            for (int i = 0; i < layout.nx; ++i)
                if (!std::isfinite(values[layout.index(i, j)])) return false;
    }
    return true;
}

} // namespace

TEST_CASE("a snapshot with contents that no world reaches is refused, whatever its checksum; what is taken stays finite") {
    auto scene = mixed_scene(20, 17);
    auto world = make_world(scene);
    step(*world, 5);
    const auto good = save(*world);
    const auto header = read_header(good);
    REQUIRE(header);
    std::mt19937 random(7);
    const auto any = [&](std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random); };
    const std::array<float, 16> odd = {none,   infinite, -infinite, 1e30F, -1e30F, 1e20F, 1e9F, -1,
                                       -1e-7F, 1e-40F,   20,        1000,  1e4F,   -1e4F, 0.3F, 1e7F};
    int taken = 0, refused = 0;
    for (int trial = 0; trial < (few_steps ? 200 : 3000); ++trial) {
        auto bytes = good;
        for (std::size_t change = 0; change <= any(4); ++change) {
            const std::size_t field = any(header->fields.size());
            const auto begin = in_memory(header->begin_of(field));
            const float value = odd[any(odd.size())];
            const std::size_t cells = in_memory(header->fields[field].bytes) / 4, first = any(cells);
            const std::size_t count = any(3) == 0 ? std::min<std::size_t>(cells - first, 200) : 1;
            for (std::size_t n = 0; n < count; ++n) set(bytes, begin + 4 * (first + n), value);
        }
        seal(bytes);
        const auto status = world->snapshots().load(bytes);
        if (!status) {
            CHECK(status.code == Code::bad_file);
            ++refused;
            continue;
        }
        ++taken;
        REQUIRE(finite(*world));
        REQUIRE(world->stepper().steps(3));
        CHECK_MESSAGE(finite(*world), "trial " << trial);
    }
    CHECK(taken > 20); // negative controls: neither answer is the only one
    CHECK(refused > 20);
    // Each kind by name.
    const auto refuses = [&](std::size_t at, auto value, const char* part) {
        auto bytes = good;
        set(bytes, at, value);
        seal(bytes);
        const auto status = world->snapshots().load(bytes);
        CHECK_MESSAGE(status.message.find(part) != std::string::npos, "says: " << status.message);
    };
    const auto place = [&](const char* field) {
        std::size_t n = 0;
        while (header->fields[n].name != field) ++n;
        return in_memory(header->begin_of(n)) + 4 * world->state().layout().index(3, 2);
    };
    refuses(place("water_height"), none, "snapshot: water_height: nan is outside 0 ... 1.6e+07 in cell (3, 2)");
    refuses(place("sand_height"), -0.5F, "snapshot: sand_height: -0.5 is outside");
    refuses(place("water_velocity_x"), 1e6F, "snapshot: water_velocity_x: 1e+06 is outside");
    refuses(place("stretch_xy"), infinite, "snapshot: stretch_xy: inf is outside");
    refuses(56, std::uint64_t{1} << 60, "steps are more than a world takes");
    refuses(64, std::int64_t{-5}, "its books begin with -5 quanta");
    const std::size_t totals = 80 + 8 * material_keys().size() + 8;
    refuses(totals - 8, std::uint64_t{2}, "source 0 passes its end, or is none");
    refuses(totals - 8, ~std::uint64_t{0}, "source 0 passes its end, or is none");
    refuses(totals, std::numeric_limits<double>::quiet_NaN(), "a running total of nan m");
    refuses(totals + 8, 1e6, "is not its 1e+06 quanta");
}

TEST_CASE("what outer faces remember is asked for sense, too") {
    auto scene = mixed_scene(20, 17);
    scene.settings.sides[static_cast<std::size_t>(SideName::east)].kind = SideKind::outflow;
    auto world = make_world(scene);
    step(*world, 5);
    auto bytes = save(*world);
    const auto header = read_header(bytes);
    REQUIRE(header);
    std::size_t field = 0;
    while (header->fields.at(field).name != "side_memory") ++field;
    const auto load = [&](float value) {
        set(bytes, in_memory(header->begin_of(field)) + 4 * 6, value);
        seal(bytes);
        return world->snapshots().load(bytes);
    };
    CHECK(load(none).message.find("snapshot: side_memory, number 6: nan is outside") != std::string::npos);
    CHECK_FALSE(load(1e30F));
    CHECK(load(0.01F));
}

TEST_CASE("a snapshot whose books do not tell what it holds says so when it is loaded") {
    auto world = make_world(mixed_scene(20, 17));
    std::vector<std::string> heard;
    REQUIRE(world->set_log([&](int, const std::string& text) { heard.push_back(text); }));
    step(*world, 5);
    auto bytes = save(*world);
    REQUIRE(world->snapshots().load(bytes));
    CHECK(heard.empty());
    const auto header = read_header(bytes);
    REQUIRE(header);
    set(bytes, 72, header->totals.water_initial - 12);
    seal(bytes);
    REQUIRE(world->snapshots().load(bytes));
    REQUIRE(heard.size() == 1);
    CHECK(heard[0].find("holds 0 quanta of sand and 12 of water that its books do not say") != std::string::npos);
}

TEST_CASE("columns above the declared largest height are counted") {
    auto scene = flat_scene(12, 9, 0.5, 0.02);
    scene.settings.method.largest_height = 1;
    scene.fill(scene.fields.water, [](double x, double) { return x < 2 ? 0.96 : 0.5; });
    auto world = make_world(scene);
    CHECK(world->reader().stats()->limits.high_columns == 0);
    Edit push;
    push.kind = EditKind::push;
    push.x0 = 3;
    push.y0 = 2;
    push.radius = 3;
    push.strength = 1;
    push.velocity_x = -6; // against the wall
    for (std::uint64_t n = 0; n < 10; ++n) {
        edit_world(*world, {push});
        step(*world, 1);
    }
    const auto stats = world->reader().stats();
    REQUIRE(stats);
    std::vector<float> water(12 * 9);
    REQUIRE(world->reader().read("water_height", water));
    const auto high = std::count_if(water.begin(), water.end(), [](float height) { return height > 1; });
    CHECK(high > 0);
    CHECK(stats->limits.high_columns == static_cast<std::uint64_t>(high));
}

TEST_CASE("a command log is refused for what its commands bring, not found out step by step") {
    auto world = make_world(mixed_scene(20, 17));
    const auto played = [&](const std::vector<Command>& commands) {
        return world->commands().play(write_commands(world->state().level(), {}, commands)).message;
    };
    const auto says = [](const std::string& text, const char* part) {
        CHECK_MESSAGE(text.find(part) != std::string::npos, "says: " << text);
    };
    says(played({RegionWrite{3, EditLayer::water, {1, 1, 1, 1}, {none}}}), "a height of a region: nan is outside 0 ... 16");
    says(played({RegionWrite{3, EditLayer::sand, {1, 1, 1, 1}, {-1.0F}}}), "a height of a region: -1 is outside 0 ... 16");
    Source tap;
    tap.radius = 1;
    tap.center = {2, 2};
    tap.rate.samples = {{0, static_cast<double>(none)}};
    says(played({SourceChange{3, 0, 0, tap}}), "play_commands: source.rate: nan is outside");
    tap.rate.samples = {{0, 0.1}};
    says(played({SourceChange{3, 0, 32, tap}}), "play_commands: index: 32 is outside 0 ... 31");
    says(played({SourceChange{3, 0, 4000000000U, tap}}), "play_commands: index: 4e+09 is outside 0 ... 31");
    says(played(std::vector<Command>(LOG_COMMANDS_MOST + 1, SourceChange{3, 0, 0, tap})),
         "more than 256 commands but edits of step 3");
    const int key = find_material_key("friction");
    std::vector<Command> many(LOG_COMMANDS_MOST + 1, MaterialChange{3, key, 0.4});
    says(played(many), "more than 256 commands but edits of step 3 are more than a log may hold");
    many.pop_back();
    CHECK(played(many) == "");
    says(played(std::vector<Command>(LOG_EDITS_MOST + 1, brush(EditLayer::water, 1, 1, 1, 0.1))),
         "more than 4096 edits of step 0");
    REQUIRE(world->stepper().steps(5));
    // Materials count in the order of their steps: the second change is right only after the first.
    const int dense = find_material_key("saturation_1"), low = find_material_key("saturation_0");
    if (dense >= 0 && low >= 0) says(played({MaterialChange{9, low, 0.1}, MaterialChange{8, low, 0.26}}), "saturation");
    // What a log could not hold is not remembered either.
    world->commands().remember(true);
    for (std::uint32_t n = 0; n < LOG_COMMANDS_MOST; ++n) REQUIRE(world->commands().set_material(key, 0.3 + 1e-4 * n));
    const auto status = world->commands().set_material(key, 0.5);
    CHECK(status.code == Code::not_supported);
    says(status.message, "set_material: the command log is on, and more than 256 commands");
    auto other = make_world(mixed_scene(20, 17));
    REQUIRE(other->stepper().steps(5));
    CHECK(other->commands().play(world->commands().bytes()));
}
