// What tests/fuzz draws: every setting that levels have, also at the ends of its range and next to nothing.
#include "engine/settings/setting_table.hpp"
#include "tests/fuzz/fuzz_case.hpp"
#include <doctest/doctest.h>
#include <map>
#include <set>
#include <string>

using namespace wadi;

namespace {

struct Drawn {
    std::set<double> values;
    bool tiny = false, most = false;
};

/// What the cases of some seeds have, by setting.
std::map<std::string, Drawn> drawn_by(std::uint64_t seeds) {
    std::map<std::string, Drawn> drawn;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const fuzz::Case c = fuzz::make_case(seed);
        for (const Setting& row : setting_table()) {
            const double value = row.at.get(c.scene.settings);
            Drawn& of = drawn[row.path];
            of.values.insert(value);
            of.tiny = of.tiny || (value > 0 && value < 1e-30);
            of.most = of.most || value == row.values.most;
        }
    }
    return drawn;
}

/// A setting whose range is a range of numbers on which nothing else depends.
bool free_number(const Setting& row) {
    const std::string path = row.path;
    return row.at.kind == SettingKind::number && row.object() != "grid" && row.object() != "" && !row.element() &&
           path != "method.quantum" && path != "method.gravity_cap_least" && path != "method.gravity_cap";
}

} // namespace

TEST_CASE("random worlds draw every setting, at its end and next to nothing too") {
    const auto drawn = drawn_by(20000);
    for (const Setting& row : setting_table()) {
        CAPTURE(std::string(row.path));
        const Drawn& of = drawn.at(row.path);
        CHECK(of.values.size() > 1);
        if (row.at.kind == SettingKind::choice) CHECK(of.values.size() == static_cast<std::size_t>(row.values.most) + 1);
        if (!free_number(row)) continue;
        CHECK(of.most);
        if (row.values.least == 0) CHECK(of.tiny);
    }
    // Seeds that ctest runs against the second solver, which cases at ends are not compared with.
    for (const std::uint64_t seed : {75, 2112, 400532}) CHECK_FALSE(fuzz::make_case(seed).at_ends);
    // Negative control: one seed draws one value of each.
    for (const auto& [path, of] : drawn_by(1)) CHECK(of.values.size() == 1);
}
