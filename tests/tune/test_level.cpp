#include "samples/tune/measure.hpp"
#include "samples/tune/write_variant.hpp"
#include <doctest/doctest.h>
#include <filesystem>

using namespace tune;

namespace {

constexpr const char* SMALL = R"({
    // a comment with { braces } and "variants": {}
    "format_version": 1, "name": "Small \"variants\": {",
    "grid": { "nx": 24, "ny": 16, "dx": 0.5 }, "dt": 0.02, "duration": 0.4,
    "water": [{ "shape": "box", "from": [0, 0], "to": [4, 8], "height": 1 }],
    "method": { "substeps": 3, "largest_height": 4 } /* the last */
})";

std::string text_of(const std::string& variants) {
    std::string text = SMALL;
    return text.insert(text.rfind('}'), variants);
}

} // namespace

TEST_CASE("a level on another grid keeps its sides and its dt per dx") {
    const Level level(SMALL, "", "");
    for (const double nx : {5.0, 12.0, 23.0, 31.0, 100.0}) {
        const Settings s = level.on_grid(nx, {});
        CAPTURE(nx);
        CHECK(s.nx * level.dx(s) == doctest::Approx(12));
        CHECK(s.ny * level.dx(s) == doctest::Approx(8)); // multiples of 3 x 2 cells keep both
        CHECK(level.dt(s) / level.dx(s) == doctest::Approx(0.04));
    }
    const Level odd(R"({"grid": {"nx": 101, "ny": 97, "dx": 1}, "dt": 0.1})", "", "");
    CHECK(odd.on_grid(50, {}).nx == 50);
    CHECK(odd.on_grid(50, {}).ny == 48);
}

TEST_CASE("a run has the settings, whole and in parts") {
    const Level level(SMALL, "", "");
    const Runner runner(level, {"cpu", -1, 1, true}, nullptr);
    Settings settings = level.on_grid(12, {2, 2, 1, -1});
    const Run run = runner.run(settings, {0.4, true, 1e9});
    CHECK(run.dt == doctest::Approx(0.04));
    CHECK(run.steps >= 10);
    CHECK(run.at.size() == CHECKPOINTS + 1);
    CHECK(run.at.back().nx == 12);
    CHECK(run.has_water);
    CHECK_FALSE(run.has_sand);
    CHECK(run.parts.size() == PARTS);
    CHECK(run.seconds() > 0);
    CHECK(runner.run(settings, {0.4, false, 0}).parts.empty()); // no time, no part
    bool asked = false;
    const Runner stopped(level, {"cpu", -1, 1, true}, [&] { return asked = true; });
    CHECK_THROWS_AS((void)stopped.run(settings, {0.4, false, 1e9}), Stopped);
    CHECK(asked);
    CHECK_THROWS_AS((void)Runner(level, {"abacus", -1, 1, false}, nullptr).run(settings, {0.4, false, 1e9}), BadInput);
}

TEST_CASE("a variant is put into a level's text, of which all else stays") {
    const Json patch = Json::parse(R"({"grid": {"nx": 12, "ny": 8, "dx": 1}, "dt": 0.04})");
    for (const char* variants :
         {"", ", \"variants\": {}", ", \"variants\": { /* { */ }", ", \"variants\": { \"dry\": { \"water\": [] } }",
          ", \"variants\": { \"deep\": { \"method\": { \"substeps\": 6 } } } // behind\n"}) {
        const std::string before = text_of(variants);
        CAPTURE(before);
        const Level level(before, "", "");
        const std::string after = with_variant(level, "budget", patch);
        CAPTURE(after);
        Json expected = level.file_json();
        expected["variants"]["budget"] = patch;
        CHECK(nlohmann::json(Json::parse(after, nullptr, true, true)) == nlohmann::json(expected));
        std::size_t at = 0; // the old text is the new one with something put in
        for (const char c : after) at += at < before.size() && before[at] == c ? 1 : 0;
        CHECK(at == before.size());
        CHECK_THROWS_AS((void)with_variant(Level(after, "", ""), "budget", patch), BadInput);
    }
    const Level level(SMALL, "", "");
    for (const char* name : {"", "two words", "a\"b"}) CHECK_THROWS_AS((void)with_variant(level, name, patch), BadInput);
}

TEST_CASE("every shipped level takes one") {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(WADI_SOURCE_DIR "/samples/levels")) {
        const std::filesystem::path file = entry.path() / "level.json";
        if (!std::filesystem::exists(file)) continue;
        CAPTURE(file.string());
        const Level level(file, "");
        const Json patch = variant_of(level, level.on_grid(64, {2, 2, 2, 1}));
        const std::string text = with_variant(level, "budget", patch);
        const Level tuned(text, file.parent_path(), "budget");
        CHECK(tuned.nx() * 1.0 / tuned.ny() == doctest::Approx(level.nx() * 1.0 / level.ny()).epsilon(0.02));
        CHECK(tuned.own_way() == Way{2, 2, 2, -1});
        CHECK(tuned.json()["active_tiles"] == 1);
        ++count;
    }
    CHECK(count >= 10);
}

TEST_CASE("a variant on a variant has both") {
    const Level level(
        text_of(
            ", \"variants\": { \"deep\": { \"water\": [], \"method\": { \"largest_height\": null, \"dry_threshold\": 1e-4 } }, "
            "\"none\": { \"method\": null } }"),
        "", "deep");
    const Settings settings = level.on_grid(12, {1, 2, 1, -1});
    const Level tuned(with_variant(level, "budget", variant_of(level, settings)), "", "budget");
    CHECK(tuned.json()["water"].empty());
    CHECK(tuned.json()["method"] == Json::parse(R"({"substeps": 1, "dry_threshold": 1e-4, "water_transport_order": 2})"));
    CHECK_THROWS_AS((void)Level(SMALL, "", "deep"), BadInput);
    const Level cleared(text_of(", \"variants\": { \"none\": { \"method\": null } }"), "", "none");
    CHECK_THROWS_AS((void)variant_of(cleared, settings), BadInput); // largest_height would come back
}

TEST_CASE("levels that are none are refused") {
    for (const char* text :
         {"", "[]", "{}", R"({"grid": {"nx": 0, "ny": 4, "dx": 1}, "dt": 1})",
          R"({"grid": {"nx": 4, "ny": 4, "dx": "1"}, "dt": 1})", R"({"grid": {"nx": 4, "ny": 4, "dx": 1}, "dt": -1})"}) {
        CAPTURE(text);
        CHECK_THROWS_AS((void)Level(text, "", ""), BadInput);
    }
    CHECK_THROWS_AS((void)Level(std::filesystem::path("nowhere.json"), ""), BadInput);
}
