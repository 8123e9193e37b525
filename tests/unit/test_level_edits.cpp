// engine/level/read_edits.cpp and engine/settings/rules/scripted_edits.cpp: edits in a level, their times, ranges and stretching.
#include "engine/saves/snapshot_format.hpp"
#include "engine/settings/rules/checks.hpp"
#include "engine/settings/rules/level_digest.hpp"
#include "engine/settings/rules/scripted_edits.hpp"
#include "tests/unit/level_text.hpp"
#include <doctest/doctest.h>

using namespace wadi;
using namespace level_text;

namespace {

const std::string DISC = R"("shape": "disc", "center": [3, 4], "radius": 1)";

std::string brush(const std::string& more) { return R"("edits": [{"layer": "sand", "amount": 0.5, )" + DISC + more + "}]"; }

Settings settings_of(const std::string& rest, const LevelOverrides& overrides = {}) {
    auto level = parse(rest, "", overrides);
    REQUIRE_MESSAGE(level, message(level));
    return level->settings;
}

/// Steps at which edits act, among the first 1000; a step counts once per edit.
std::vector<std::uint64_t> steps_of(const Settings& settings) {
    std::vector<std::uint64_t> steps;
    for (std::uint64_t step = 0; step < 1000; ++step) {
        std::vector<Edit> due;
        append_scripted_edits(settings, step, due);
        steps.insert(steps.end(), due.size(), step);
    }
    return steps;
}

using Steps = std::vector<std::uint64_t>;

} // namespace

TEST_CASE("level edits: keys, defaults and kinds") {
    const Settings settings = settings_of(R"("edits": [
        {"time": 0.5, "layer": "water", "shape": "disc", "center": [3, 4], "radius": 2, "amount": -0.25},
        {"time": 1, "until": 2, "every": 0.5, "kind": "push", "shape": "capsule", "from": [1, 2], "to": [3, 4], "radius": 1,
         "softness": 0.25, "strength": 0.75, "velocity": [2, -3], "move": [0.5, -1]}])");
    REQUIRE(settings.edits.size() == 2);
    const ScriptedEdit& first = settings.edits[0];
    CHECK(first.edit.kind == EditKind::brush);
    CHECK(first.edit.layer == EditLayer::water);
    CHECK(!first.edit.capsule);
    CHECK(first.edit.x0 == 3);
    CHECK(first.edit.y0 == 4);
    CHECK(first.edit.radius == 2);
    CHECK(first.edit.softness == 0.5);
    CHECK(first.edit.amount == -0.25);
    CHECK(first.time == 0.5);
    CHECK(first.every == 0);
    const ScriptedEdit& second = settings.edits[1];
    CHECK(second.edit.kind == EditKind::push);
    CHECK(second.edit.capsule);
    CHECK(second.edit.x1 == 3);
    CHECK(second.edit.y1 == 4);
    CHECK(second.edit.softness == 0.25);
    CHECK(second.edit.strength == 0.75);
    CHECK(second.edit.velocity_x == 2);
    CHECK(second.edit.velocity_y == -3);
    CHECK(second.every == 0.5);
    CHECK(second.until == 2);
    CHECK(second.move == std::array<double, 2>{0.5, -1});
}

TEST_CASE("level edits: each acts ahead of the step nearest to its time") {
    CHECK(steps_of(settings_of(brush(R"(, "time": 0)"))) == Steps{0});
    CHECK(steps_of(settings_of(brush(R"(, "time": 0.104)"))) == Steps{10});
    CHECK(steps_of(settings_of(brush(R"(, "time": 0.106)"))) == Steps{11});
    CHECK(steps_of(settings_of(brush(R"(, "time": 0.1, "every": 0.1, "until": 0.5)"))) == Steps{10, 20, 30, 40, 50});
    CHECK(steps_of(settings_of(brush(R"(, "time": 0.1, "every": 0.1, "until": 0.49)"))) == Steps{10, 20, 30, 40});
    CHECK(steps_of(settings_of(brush(R"(, "time": 0.1, "every": 0.1, "until": 0.1)"))) == Steps{10});
    // More often than steps: what is brought does not depend on dt.
    const auto often = settings_of(brush(R"(, "time": 1, "every": 0.003, "until": 2)"));
    CHECK(steps_of(often).size() == 334);
    LevelOverrides coarse;
    coarse.dt = 0.1;
    CHECK(steps_of(settings_of(brush(R"(, "time": 1, "every": 0.003, "until": 2)"), coarse)).size() == 334);
}

TEST_CASE("level edits: the place moves, and edits of a step keep the level's order") {
    const Settings settings = settings_of(R"("edits": [
        {"time": 0.1, "every": 0.1, "until": 1, "layer": "sand", "amount": 1, "shape": "capsule", "from": [0, 0], "to": [1, 2], "radius": 1, "move": [2, -1]},
        {"time": 0.5, "layer": "water", "amount": 1, )" +
                                          DISC + "}]");
    std::vector<Edit> due;
    append_scripted_edits(settings, 50, due);
    REQUIRE(due.size() == 2);
    CHECK(due[0].layer == EditLayer::sand);
    CHECK(due[0].x0 == doctest::Approx(0.8));
    CHECK(due[0].y0 == doctest::Approx(-0.4));
    CHECK(due[0].x1 == doctest::Approx(1.8));
    CHECK(due[0].y1 == doctest::Approx(1.6));
    CHECK(due[1].layer == EditLayer::water);
    CHECK(due[1].x0 == 3);
}

TEST_CASE("level edits: another size moves them with the level") {
    LevelOverrides overrides;
    overrides.size = {10, 16};
    const Settings settings = settings_of(brush(R"(, "time": 0.1, "every": 0.1, "until": 0.5, "move": [1, 1])"), overrides);
    const ScriptedEdit& script = settings.edits[0];
    CHECK(script.edit.x0 == 3);
    CHECK(script.edit.y0 == 8);
    CHECK(script.edit.radius == 1);
    CHECK(script.move == std::array<double, 2>{1, 2});
}

TEST_CASE("level edits: errors name edit, field and range") {
    const auto refuses = [](const std::string& edit, const std::string& part) {
        const auto level = parse(R"("edits": [{"time": 0, "layer": "sand", "amount": 1, )" + DISC + "}, {" + edit + "}]");
        CHECK_MESSAGE(says(message(level), "edits[1]" + part), message(level));
    };
    const std::string sand = R"("layer": "sand", "amount": 1, )" + DISC;
    refuses(sand, ".time: missing");
    refuses(R"("time": -1, )" + sand, ".time: -1 is outside 0 ... 1e+09");
    refuses(R"("time": 1, "every": 0.1, )" + sand, ".until: missing");
    refuses(R"("time": 1, "until": 2, )" + sand, ".every: missing");
    refuses(R"("time": 1, "every": 0.0001, "until": 2, )" + sand, ".every: 0.0001 is outside 0.001 ... 1e+09");
    refuses(R"("time": 1, "every": 0.1, "until": 0.5, )" + sand, ".until: 0.5 is outside 1 ... 1e+09");
    refuses(R"("time": 1, "move": [1, 0], )" + sand, ".move: unknown key");
    refuses(R"("time": 1, "every": 0.1, "until": 2, "move": [1, 2e4], )" + sand, ".move[1]: 20000 is outside -10000 ... 10000");
    refuses(R"("time": 1, "amount": 1, )" + DISC, ".layer: missing");
    refuses(R"("time": 1, "layer": "snow", "amount": 1, )" + DISC, ".layer: \"snow\"");
    refuses(R"("time": 1, "layer": "sand", )" + DISC, ".amount: missing");
    refuses(R"("time": 1, "layer": "sand", "amount": 40, )" + DISC, ".amount: 40 is outside -32 ... 32"); // 2 largest_height
    refuses(R"("time": 1, "kind": "stamp", )" + sand, ".kind: \"stamp\"");
    refuses(R"("time": 1, "kind": "push", )" + DISC, ".velocity: missing");
    refuses(R"("time": 1, "kind": "push", "velocity": [2e4, 0], )" + DISC, ".velocity[0]: 20000 is outside -10000 ... 10000");
    refuses(R"("time": 1, "kind": "push", "velocity": [1, 0], "strength": 2, )" + DISC, ".strength: 2 is outside 0 ... 1");
    refuses(R"("time": 1, "kind": "push", "velocity": [1, 0], "amount": 2, )" + DISC, ".amount: unknown key");
    refuses(R"("time": 1, "layer": "sand", "amount": 1)", ".shape: missing");
    refuses(R"("time": 1, "layer": "sand", "amount": 1, "shape": "disc", "radius": 1)", ".center: missing");
    refuses(R"("time": 1, "layer": "sand", "amount": 1, "shape": "disc", "center": [1, 1])", ".radius: missing");
    refuses(R"("time": 1, "softness": 1.5, )" + sand, ".softness: 1.5 is outside 0 ... 1");
    refuses(R"("time": 1, "layer": "sand", "amount": 1, "shape": "disc", "center": [1, 1], "radius": 0)",
            ".radius: 0 is outside 1e-09");
    refuses(R"("time": 1, "layer": "sand", "amount": 1, "shape": "capsule", "from": [1, 1], "radius": 1)", ".to: missing");
    const auto off = parse(brush(R"(, "time": 1)") + R"(, "effects": {"sand": "off"})");
    CHECK_MESSAGE(says(message(off), "edits[0].layer: effects.sand"), message(off));
    CHECK(says(message(parse(R"("edits": {})")), "edits"));
}

TEST_CASE("level edits: settings made by hand are checked as well") {
    Settings settings = settings_of(brush(R"(, "time": 1)"));
    CHECK(validate(settings));
    const auto refuses = [&](auto change, const std::string& part) {
        Settings bad = settings;
        change(bad.edits[0]);
        CHECK_MESSAGE(says(validate(bad).message, part), validate(bad).message);
    };
    refuses([](ScriptedEdit& e) { e.edit.kind = EditKind::stamp; }, "edits[0].kind");
    refuses([](ScriptedEdit& e) { e.time = -1; }, "edits[0].time: -1 is outside");
    refuses([](ScriptedEdit& e) { e.every = 1e-4; }, "edits[0].every");
    refuses([](ScriptedEdit& e) { e.every = 1; }, "edits[0].until: 0 is outside 1 ...");
    refuses([](ScriptedEdit& e) { e.move[0] = 1e9; }, "edits[0].move[0]");
    refuses([](ScriptedEdit& e) { e.edit.radius = 0; }, "edits[0].radius");
    settings.edits.resize(1001, settings.edits[0]);
    CHECK(says(validate(settings).message, "edits: 1001 are more than 1000"));
}

TEST_CASE("level edits: one that meets no cell gives a warning") {
    const auto warned = [](const std::string& place) {
        const auto level = parse(R"("edits": [{"time": 1, "layer": "sand", "amount": 1, "shape": "disc", )" + place + "}]");
        REQUIRE_MESSAGE(level, message(level));
        return !level->warnings.empty() && says(level->warnings[0], "edits[0]: covers no cell centre");
    };
    CHECK(warned(R"("center": [3, 3], "radius": 0.5)"));
    CHECK(!warned(R"("center": [3.5, 3.5], "radius": 0.5)"));
    CHECK(warned(R"("center": [-5, 3], "radius": 3)"));
    CHECK(!warned(R"("center": [-5, 3], "radius": 7)"));
}

TEST_CASE("level edits: snapshots and logs know a level by its edits too") {
    const Settings none = settings_of("");
    const Settings one = settings_of(brush(R"(, "time": 1)"));
    Settings other = one;
    other.edits[0].edit.amount = 0.25;
    CHECK(level_digest(none) != level_digest(one));
    CHECK(level_digest(one) != level_digest(other));
    CHECK(level_digest(one) == level_digest(settings_of(brush(R"(, "time": 1)"))));
}

TEST_CASE("level edits: no step is brought more than 256") {
    const auto often = [](const char* times, int count, const LevelOverrides& overrides = {}) {
        std::string list;
        for (int n = 0; n < count; ++n)
            list += (n > 0 ? "," : "") + std::string(R"({"layer": "sand", "amount": 0.5, )") + DISC + times + "}";
        return message(parse("\"edits\": [" + list + "]", "", overrides));
    };
    LevelOverrides slow;
    slow.dt = 100;
    CHECK(says(often(R"(, "time": 0, "every": 0.001, "until": 1e9)", 1, slow), "edits: they bring up to 100001 into one step"));
    CHECK(says(often(R"(, "time": 3)", 1000), "edits: they bring up to 1000 into one step, at 3 s; allowed are 256"));
    CHECK(often(R"(, "time": 3)", 256) == "no error");
    CHECK(often(R"(, "time": 0, "every": 0.001, "until": 1e9)", 23) == "no error"); // 11 at most of each in 0.01 s
    CHECK(says(often(R"(, "time": 0, "every": 0.001, "until": 1e9)", 24), "up to 264 into one step"));
    // Seldom ones that could meet in a step, and do not.
    std::string list;
    for (int n = 0; n < 1000; ++n)
        list += (n > 0 ? "," : "") + std::string(R"({"layer": "sand", "amount": 0.5, )") + DISC + R"(, "time": )" +
                std::to_string(n * 0.02) + R"(, "every": 20, "until": 100})";
    CHECK(message(parse("\"edits\": [" + list + "]")) == "no error");
}
