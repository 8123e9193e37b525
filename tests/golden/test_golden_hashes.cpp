// The CPU's state hashes of fixed scenes, kept in hashes.txt: any change of any bit of any stage shows here, whatever compiler,
// optimisation or instruction set built it. tests/golden/update.sh writes the file anew after a wanted change.
#include "tests/support/worlds.hpp"
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fstream>
#include <map>

using namespace wadi;
using namespace wadi::test;

namespace {

const std::string file = std::string(WADI_SOURCE_DIR) + "/tests/golden/hashes.txt";

std::map<std::string, std::string> read_golden() {
    std::map<std::string, std::string> golden;
    std::ifstream in(file);
    for (std::string name, hash; in >> name >> hash;) golden[name] = hash;
    return golden;
}

std::string hash_text(const Scene& scene, int steps) {
    const char* asked = std::getenv("WADI_BACKEND"); // of any device the bits are the CPU's
    auto world = make_world(scene, {asked != nullptr ? asked : "cpu"});
    step(*world, steps);
    char text[17];
    std::snprintf(text, sizeof text, "%016" PRIx64, hash_of(*world));
    return text;
}

} // namespace

TEST_CASE("state hashes equal the golden ones") {
    auto rain = mixed_scene(33, 17);
    rain.settings.rain = {{{0, 2e-4}}};
    rain.settings.sides[SIDE_WEST] = {SideKind::level, 0, 1e30, {{{0, 1.3}}}};
    rain.settings.sides[SIDE_NORTH] = {SideKind::outflow, 0, 1e30, {}};
    auto single = mixed_scene(40, 40);
    single.settings.effects = {{"mixture", Force::off}};
    const std::map<std::string, std::string> now = {
        {"mixed_100", hash_text(mixed_scene(64, 48), 100)},
        {"rain_and_sides_100", hash_text(rain, 100)},
        {"single_layer_100", hash_text(single, 100)},
        {"canyon_50", hash_text(shipped_level("canyon", 100, 128), 50)},
        {"piles_50", hash_text(shipped_level("piles", 96, 64), 50)},
        {"dam_break_50", hash_text(shipped_level("dam_break", 96, 96), 50)},
    };
    if (std::getenv("WADI_UPDATE_GOLDEN") != nullptr) {
        std::ofstream out(file);
        for (const auto& [name, hash] : now) out << name << " " << hash << "\n";
        REQUIRE(out.good());
    }
    const auto golden = read_golden();
    CHECK(golden.size() == now.size());
    for (const auto& entry : now) {
        REQUIRE_MESSAGE(golden.contains(entry.first), entry.first << " has no golden hash; run tests/golden/update.sh");
        CHECK_MESSAGE(golden.at(entry.first) == entry.second,
                      entry.first << " is " << entry.second << ", golden is " << golden.at(entry.first));
    }
}
