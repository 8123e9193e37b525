// What tests/fuzz draws: every setting that levels have, also at the ends of its range and next to nothing.
#include "engine/settings/data/setting_table.hpp"
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
           path != "method.quantum" && path != "method.gravity_cap";
}

} // namespace

TEST_CASE("random worlds draw what levels have beside their settings: kinds of sides and sources, rain, edits") {
    std::set<std::string> drawn;
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        const fuzz::Case c = fuzz::make_case(seed);
        const Settings& s = c.scene.settings;
        for (const Side& side : s.sides) drawn.insert("side " + std::to_string(static_cast<int>(side.kind)));
        for (const Source& source : s.sources) {
            drawn.insert("source " + std::to_string(static_cast<int>(source.shape)));
            drawn.insert(source.material == SourceMaterial::sand ? "source of sand" : "source of water");
            drawn.insert(source.discharge.samples.empty() ? "rate" : "discharge");
            if (!source.level.samples.empty()) drawn.insert(source.drain ? "source that holds and drains" : "source that holds");
            if (source.set_velocity) drawn.insert("source with velocity");
        }
        if (!s.rain.samples.empty()) drawn.insert("rain");
        if (!s.evaporation.samples.empty()) drawn.insert("evaporation");
        if (!s.roughness.empty()) drawn.insert("roughness");
        if (!s.rain_map.empty()) drawn.insert("rain map");
        for (const auto& [name, force] : s.effects) drawn.insert(name + (force == Force::on ? " on" : " off"));
        if (!c.scene.fields.sand_velocity_x.empty()) drawn.insert("velocities");
        for (const Edit& edit : c.commands) drawn.insert("edit " + std::to_string(static_cast<int>(edit.kind)));
        drawn.insert("method " + s.method.name);
    }
    CAPTURE(drawn.size());
    for (const char* what : {"side 0",
                             "side 1",
                             "side 2",
                             "side 3",
                             "source 0",
                             "source 1",
                             "source 2",
                             "source of sand",
                             "source of water",
                             "rate",
                             "discharge",
                             "source with velocity",
                             "source that holds",
                             "source that holds and drains",
                             "rain",
                             "evaporation",
                             "roughness",
                             "rain map",
                             "foam on",
                             "wetness on",
                             "silt on",
                             "velocities",
                             "method robust",
                             "method published"})
        CHECK_MESSAGE(drawn.contains(what), what);
    CHECK(drawn.contains("edit " + std::to_string(static_cast<int>(EditKind::push))));
}

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
    // Negative control: one seed draws one value of each.
    for (const auto& [path, of] : drawn_by(1)) CHECK(of.values.size() == 1);
}
