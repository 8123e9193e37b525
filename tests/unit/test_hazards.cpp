// The barrier planner on hand-made programs, against barriers worked out on paper.
#include "engine/compute/hazards.hpp"
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::compute;

namespace {

constexpr Buffer a{1}, b{2}, c{3}, d{4};

Copy copy(Buffer from, Buffer to) { return {from, to, 0, 0, 4}; }

Dispatch velocity(Buffer x, Buffer y, Buffer out_x, Buffer out_y) {
    return {Pipeline{1}, find_stage("publish_velocity"), 0, {x, y, out_x, out_y}, {0, 0, 1, 1}, "publish"};
}

Dispatch over_tiles(int stage, Buffer groups) {
    return {Pipeline{1},
            stage,
            0,
            std::vector<Buffer>(16, Buffer{90}),
            {0, 0, 1, 1},
            "tiles",
            {Buffer{91}, Buffer{92}, Buffer{93}, Buffer{94}, groups}};
}

std::vector<bool> memory_barriers(const std::vector<Op>& ops) {
    std::vector<bool> before;
    for (const auto& barrier : plan_barriers(ops)) before.push_back(barrier.memory);
    return before;
}

std::vector<bool> group_barriers(const std::vector<Op>& ops) {
    std::vector<bool> before;
    for (const auto& barrier : plan_barriers(ops)) before.push_back(barrier.groups);
    return before;
}

} // namespace

TEST_CASE("a barrier stands where a read follows a write, and nowhere else") {
    CHECK(memory_barriers({copy(a, b), copy(b, c)}) == std::vector{false, true});  // read after write
    CHECK(memory_barriers({copy(a, b), copy(c, a)}) == std::vector{false, true});  // write after read
    CHECK(memory_barriers({copy(a, c), copy(b, c)}) == std::vector{false, true});  // write after write
    CHECK(memory_barriers({copy(a, b), copy(a, c)}) == std::vector{false, false}); // two readers
    CHECK(memory_barriers({copy(a, b), copy(c, d)}) == std::vector{false, false}); // strangers
}

TEST_CASE("one barrier serves everything before it") {
    CHECK(memory_barriers({copy(a, b), copy(a, c), copy(b, d), copy(c, d)}) == std::vector{false, false, true, true});
    CHECK(memory_barriers({copy(a, b), copy(b, c), copy(a, d)}) == std::vector{false, true, false});
}

TEST_CASE("the first dispatch to read its groups waits for them, and the first after each change") {
    const int cells = find_stage("backtrace_sand_velocity"), rim = find_stage("account_sides");
    const auto tiles = over_tiles(cells, a);
    CHECK(group_barriers({tiles, tiles}) == std::vector{true, false}); // an earlier submission may have written them
    CHECK(group_barriers({tiles, copy(b, a), tiles, tiles}) == std::vector{true, false, true, false});
    CHECK(group_barriers({tiles, copy(a, b), tiles}) == std::vector{true, false, false}); // only read
    CHECK(group_barriers({tiles, over_tiles(cells, b), tiles}) == std::vector{true, true, false});
    CHECK(group_barriers({over_tiles(rim, a), tiles}) == std::vector{false, true}); // a rim runs over all of its range
    CHECK(group_barriers({velocity(a, b, c, d), copy(a, b)}) == std::vector{false, false});
}

TEST_CASE("a stage's access comes from its own binding lines") {
    const auto uses = buffer_uses(velocity(a, b, c, d));
    REQUIRE(uses.size() == 4);
    CHECK(uses[0].reads);
    CHECK_FALSE(uses[0].writes);
    CHECK(uses[2].writes);
    CHECK_FALSE(uses[2].reads);
    CHECK(memory_barriers({copy(d, a), velocity(a, b, c, d), velocity(a, b, Buffer{5}, Buffer{6})}) ==
          std::vector{false, true, false});
}

TEST_CASE("timestamps and bindings that do not exist touch nothing") {
    CHECK(buffer_uses(Timestamp{"t"}).empty());
    const int stage = find_stage("project_deformation_gradient");
    const Dispatch dry{Pipeline{1},  stage,    0, {a, b, c, d, Buffer{5}, Buffer{6}, Buffer{7}, Buffer{8}, Buffer{9}, Buffer{}},
                       {0, 0, 1, 1}, "project"};
    CHECK(buffer_uses(dry).size() == 9);
    auto wet = dry;
    wet.effects = EFFECT_COHESION;
    wet.slots.back() = Buffer{10};
    CHECK(buffer_uses(wet).size() == 10);
}

TEST_CASE("dependencies name the last writer, and the readers before a write") {
    const auto edges = plan_dependencies({copy(a, b), copy(b, c), copy(b, d), copy(a, b)});
    CHECK(edges[0].empty());
    CHECK(edges[1] == std::vector{0});
    CHECK(edges[2] == std::vector{0});
    CHECK(edges[3] == std::vector{1, 2});
}
