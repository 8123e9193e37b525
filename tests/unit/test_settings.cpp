// validate() and TimeSeries of engine/settings/data/settings.hpp.
#include "engine/settings/data/method_presets.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/checks.hpp"
#include "engine/settings/rules/messages.hpp"
#include "tests/unit/level_text.hpp"
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <functional>
#include <limits>

using namespace wadi;
using namespace level_text;

namespace {

Settings good() {
    Settings settings;
    settings.grid = {20, 10, 0.5};
    settings.dt = 0.01;
    return settings;
}

std::string refusal(const std::function<void(Settings&)>& change) {
    Settings settings = good();
    change(settings);
    const Status status = validate(settings);
    CHECK((status || status.code == Code::bad_argument));
    return status.message;
}

constexpr double NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();

struct Anything {
    template <class T> operator T() const;
};

/// How many members an aggregate has.
template <class Owner, class... Members> constexpr std::size_t members() {
    if constexpr (requires { Owner{Members()..., Anything()}; })
        return members<Owner, Members..., Anything>();
    else
        return sizeof...(Members);
}

std::ptrdiff_t rows_of(std::string_view object) {
    const auto table = setting_table();
    return std::count_if(table.begin(), table.end(), [&](const Setting& row) { return row.object() == object; });
}

} // namespace

TEST_CASE("settings: defaults are valid") {
    CHECK(refusal([](Settings&) {}).empty());
}

TEST_CASE("settings: every row is checked, and every number of grid, material and method has one") {
    for (const Setting& row : setting_table()) {
        CAPTURE(row.path);
        const auto with = [&](double value) { return refusal([&](Settings& s) { row.at.set(s, value); }); };
        const std::string name = std::string(row.path) + ": ";
        CHECK(!says(with(row.values.least), " is outside"));
        CHECK(with(row.values.most) != outside_text(row.path, row.values.most, row.values.least, row.values.most));
        CHECK(find_setting(row.path) == &row);
        if (row.at.kind == SettingKind::flag) continue; // holds nothing else
        CHECK(says(with(row.values.most * 2 + 1), name));
        CHECK(says(with(row.at.kind == SettingKind::choice ? 200 : row.values.least - 1), " is outside "));
        if (row.at.kind == SettingKind::number) CHECK(says(with(NOT_A_NUMBER), name));
    }
    CHECK(refusal([](Settings& s) { s.material.friction = 12; }) == "material.friction: 12 is outside 0 ... 10");
    CHECK(refusal([](Settings& s) { s.active_tiles = 9; }) == "active_tiles: 9 is not one of 0, 1, 2, 8, 16, 32, 64");
    CHECK(find_setting("material.frict") == nullptr);
    CHECK(rows_of("grid") == members<Grid>());
    CHECK(rows_of("material") == members<Material>() + 2); // three numbers of saturation
    CHECK(rows_of("method") == members<Method>() - 1);     // name
}

TEST_CASE("settings: grid, time step, gravity") {
    CHECK(refusal([](Settings& s) { s.grid.nx = 0; }) == "grid.nx: 0 is outside 1 ... 16384");
    CHECK(refusal([](Settings& s) { s.grid.ny = 20000; }) == "grid.ny: 20000 is outside 1 ... 16384");
    CHECK(says(refusal([](Settings& s) { s.grid.dx = 0; }), "grid.dx: 0 is outside 0.0001 ... 10000"));
    CHECK(says(refusal([](Settings& s) { s.grid.dx = NOT_A_NUMBER; }), "grid.dx: "));
    CHECK(says(refusal([](Settings& s) { s.dt = 0; }), "dt: 0 is outside 1e-07 ... 100"));
    CHECK(says(refusal([](Settings& s) { s.gravity = -1; }), "gravity: -1 is outside 0 ... 1000"));
}

TEST_CASE("settings: saturation, quantum, caps, names") {
    CHECK(says(refusal([](Settings& s) {
                   s.material.saturation = {0.3, 0.25, 0.4};
               }),
               "saturation[1]: 0.25 must be at least 0.001"));
    CHECK(says(refusal([](Settings& s) { s.material.saturation = {0, 0.25, 0.4}; }), "saturation[0]: 0 must be"));
    CHECK(says(refusal([](Settings& s) { s.material.saturation = {0.1, 0.25, 1.4}; }), "saturation[2]: 1.4 is outside 0 ... 1"));
    CHECK(refusal([](Settings& s) { s.method.quantum = 0; }).empty());
    CHECK(refusal([](Settings& s) { s.method.quantum = std::ldexp(1.0, -20); }).empty());
    CHECK(says(refusal([](Settings& s) { s.method.quantum = 0.001; }), "not a power of two; the next below is 0.000976562"));
    CHECK(says(refusal([](Settings& s) { s.method.quantum = std::ldexp(1.0, -30); }), "largest_height / 2^24"));
    CHECK(says(refusal([](Settings& s) { s.method.quantum = -0.5; }), "neither -1"));
    CHECK(says(refusal([](Settings& s) { s.method.gravity_cap = 0.1; }), "method.gravity_cap: 0.1 is outside 0.15 ..."));
    CHECK(refusal([](Settings& s) { s.method.gravity_cap = 0; }).empty());
    CHECK(says(refusal([](Settings& s) {
                   choose_method(s, "published");
                   s.method.velocity_clamp = 1.5;
               }),
               "method.velocity_clamp: 1.5 is outside 0.01 ... 1 (method published"));
    CHECK(says(refusal([](Settings& s) { s.method.strain_transport = StrainTransport::direct; }),
               "method.strain_transport: \"direct\" goes only with method \"published\""));
    CHECK(says(refusal([](Settings& s) {
                   choose_method(s, "published");
                   s.method.shock_viscosity = 0.1;
               }),
               "method.name: \"published\" goes only with shock_viscosity 0"));
    CHECK(refusal([](Settings& s) { s.method.velocity_clamp = 1.5; }).empty());
    CHECK(refusal([](Settings& s) { s.method.water_transport_order = 2; }).empty());
    CHECK(says(refusal([](Settings& s) { s.method.water_transport_order = 3; }),
               "method.water_transport_order: 3 is outside 1 ... 2"));
    CHECK(refusal([](Settings& s) { s.method.sand_transport_order = 2; }).empty());
    CHECK(says(refusal([](Settings& s) { s.method.sand_transport_order = 0; }),
               "method.sand_transport_order: 0 is outside 1 ... 2"));
    CHECK(says(refusal([](Settings& s) { s.method.name = "robst"; }), "did you mean \"robust\"?"));
    CHECK(says(refusal([](Settings& s) { s.effects = {{"cohesoin", Force::off}}; }), "did you mean \"cohesion\"?"));
    CHECK(refusal([](Settings& s) { s.effects = {{"bed_friction", Force::on}}; }).empty());
}

TEST_CASE("settings: the quantum that is chosen") {
    Method method;
    CHECK(height_quantum(method) == std::ldexp(1.0, -20)); // 16 m
    method.largest_height = 17;
    CHECK(height_quantum(method) == std::ldexp(1.0, -19));
    method.quantum = 0;
    CHECK(height_quantum(method) == 0);
}

TEST_CASE("settings: sides") {
    const auto west = [](const std::function<void(Side&)>& change) { return refusal([&](Settings& s) { change(s.sides[0]); }); };
    CHECK(says(west([](Side& s) { s.kind = SideKind::discharge; }), "sides.west.value: missing"));
    CHECK(says(west([](Side& s) { s.value.samples = {{0, 1}}; }), "only discharge, level and waves have one"));
    CHECK(says(west([](Side& s) { s.kind = SideKind::outflow, s.slope = 2; }), "sides.west.slope: 2 is outside 0 ... 1"));
    CHECK(says(west([](Side& s) { s.kind = SideKind::brink, s.slope = 0.1; }), "only an outflow has one"));
    CHECK(says(west([](Side& s) { s.kind = SideKind::brink, s.wave.samples = {{0, 1}}; }), "only waves have one"));
    CHECK(says(west([](Side& s) { s.kind = SideKind::outflow, s.absorb = 1; }), "only level and waves have one"));
    CHECK(says(west([](Side& s) { s.kind = SideKind::outflow, s.sediment = 1.5; }), "sides.west.sediment: 1.5 is outside"));
    CHECK(says(west([](Side& s) { s.sediment = 0; }), "a wall has none"));
    CHECK(west([](Side& s) { s.kind = SideKind::outflow, s.slope = 0.01, s.sediment = 0.5; }).empty());
    CHECK(says(west([](Side& s) { s.from = 5; }), "sides.west.from: 5 is outside 0 ... 5"));
    CHECK(west([](Side& s) { s.from = 4; }).empty());
    CHECK(says(west([](Side& s) { s.from = 3, s.to = 2; }), "sides.west.to: 2 is not greater than from, 3"));
    CHECK(says(west([](Side& s) { s.kind = SideKind::level, s.value.samples = {{0, 2e6}}; }), "2e+06 is outside"));
    CHECK(says(west([](Side& s) {
                   s.kind = SideKind::level, s.value.samples = {{0, 2}, {0, 3}};
               }),
               "value[1]: the time 0 s does not come after 0 s"));
    CHECK(says(west([](Side& s) { s.kind = SideKind::level, s.value.samples = {{NOT_A_NUMBER, 2}}; }), "not a finite number"));
    CHECK(says(west([](Side& s) { s.kind = SideKind::discharge, s.value.samples = {{0, -1}}; }), "value: -1 is outside 0 ... "));
    CHECK(says(refusal([](Settings& s) { s.sides[2].from = 10; }), "sides.south.from: 10 is outside 0 ... 10"));
}

TEST_CASE("settings: sources and rain") {
    const auto with = [](const std::function<void(Source&)>& change) {
        return refusal([&](Settings& s) {
            Source source;
            source.center = {5, 2};
            source.radius = 1;
            source.box = {1, 1, 2, 2};
            source.rate.samples = {{0, 0.1}};
            change(source);
            s.sources = {source};
        });
    };
    CHECK(with([](Source&) {}).empty());
    CHECK(with([](Source& s) { s.shape = SourceShape::box; }).empty());
    CHECK(with([](Source& s) { s.shape = SourceShape::point; }).empty());
    CHECK(with([](Source& s) { s.shape = SourceShape::point, s.center = {0, 4.99}; }).empty());
    CHECK(says(with([](Source& s) { s.shape = SourceShape::point, s.center = {10, 2}; }), "lies outside the grid"));
    CHECK(says(with([](Source& s) { s.radius = 0; }), "sources[0].radius: 0 is not a positive length"));
    CHECK(says(with([](Source& s) { s.center = {5, 7}; }), "lies outside the grid, which spans 0 ... 5 m in y"));
    CHECK(with([](Source& s) { s.center = {5, 5.5}; }).empty()); // the disc reaches in
    CHECK(says(with([](Source& s) { s.center = {NOT_A_NUMBER, 1}; }), "sources[0].center[0]"));
    CHECK(says(with([](Source& s) {
                   s.shape = SourceShape::box, s.box = {1, 1, 1, 2};
               }),
               "to[0]: 1 is not greater than from, 1"));
    CHECK(says(with([](Source& s) { s.rate.samples.clear(); }), "sources[0].rate: missing"));
    CHECK(says(with([](Source& s) { s.rate.samples = {{0, 1}, {1, 2e4}}; }), "sources[0].rate[1]: 20000 is outside"));
    CHECK(with([](Source& s) { std::swap(s.rate, s.discharge); }).empty());
    CHECK(says(with([](Source& s) { s.discharge = s.rate; }), "sources[0]: give only one of rate and discharge"));
    const auto holding = [&](const std::function<void(Source&)>& change) {
        return with([&](Source& s) {
            s.level.samples = {{0, 3}};
            change(s);
        });
    };
    CHECK(holding([](Source&) {}).empty());
    CHECK(holding([](Source& s) { s.rate.samples.clear(), s.drain = true; }).empty());
    CHECK(holding([](Source& s) { std::swap(s.rate, s.discharge); }).empty());
    CHECK(says(holding([](Source& s) {
                   s.level.samples = {{0, 3}, {1, 17}};
               }),
               "sources[0].level[1]: 17 is outside -16 ... 16 (method.largest_height)"));
    CHECK(says(holding([](Source& s) { s.level.samples = {{0, NOT_A_NUMBER}}; }), "sources[0].level"));
    CHECK(says(holding([](Source& s) { s.rate.samples = {{0, -1}}; }), "sources[0].rate: -1 is outside 0 ... 10000"));
    CHECK(says(holding([](Source& s) { s.material = SourceMaterial::sand; }),
               "sources[0].level: only a source of water holds one"));
    CHECK(says(holding([](Source& s) { s.set_velocity = true; }), "sources[0].velocity: a source with a level has none"));
    CHECK(says(with([](Source& s) { s.drain = true; }), "sources[0].drain: only a source with a level has one"));
    CHECK(says(with([](Source& s) {
                   s.rate.samples.clear(), s.discharge.samples = {{0, 2e9}};
               }),
               "sources[0].discharge: 2e+09 is outside"));
    CHECK(with([](Source& s) { s.set_velocity = true, s.velocity = {1, 2}; }).empty());
    CHECK(says(with([](Source& s) {
                   s.set_velocity = true, s.velocity = {1, 2e5};
               }),
               "sources[0].velocity[1]: 200000 is outside"));
    CHECK(says(with([](Source& s) { s.set_velocity = true, s.material = SourceMaterial::sand; }), "only a source of water"));
    CHECK(says(refusal([](Settings& s) { s.sources.resize(33); }), "33 are more than 32"));
    CHECK(says(refusal([](Settings& s) { s.rain.samples = {{0, -1}}; }), "rain: -1 is outside 0 ... 1"));
    CHECK(says(refusal([](Settings& s) { s.evaporation.samples = {{0, 2}}; }), "evaporation: 2 is outside 0 ... 1"));
}

TEST_CASE("settings: a time series is linear between its samples and constant outside") {
    TimeSeries series;
    CHECK(series.at(1) == 0);
    series.samples = {{2, 5}};
    CHECK(series.at(-1) == 5);
    CHECK(series.at(9) == 5);
    series.samples = {{1, 10}, {2, 20}, {4, 0}};
    CHECK(series.at(0) == 10);
    CHECK(series.at(1) == 10);
    CHECK(series.at(1.5) == doctest::Approx(15));
    CHECK(series.at(2) == 20);
    CHECK(series.at(3.5) == doctest::Approx(5));
    CHECK(series.at(4) == 0);
    CHECK(series.at(1e9) == 0);
}

TEST_CASE("settings: initial fields") {
    const Settings settings = good();
    InitialFields fields;
    CHECK(validate(fields, settings));
    fields.terrain.assign(200, 3.0f);
    fields.water.assign(200, 2.0f);
    CHECK(validate(fields, settings));

    fields.water[43] = -1;
    CHECK(validate(fields, settings).message == "water: -1 is outside 0 ... 16 in cell (3, 2)");
    fields.water[43] = std::numeric_limits<float>::quiet_NaN();
    CHECK(says(validate(fields, settings).message, "in cell (3, 2)"));
    fields.water[43] = 14;
    CHECK(says(validate(fields, settings).message, "cell (3, 2) is 17 m high, above method.largest_height, 16 m"));
    fields.water.assign(7, 0.0f);
    CHECK(validate(fields, settings).message == "water: 7 values for a grid of 20 x 10");
    fields.water.clear();
    fields.terrain[0] = -17;
    CHECK(says(validate(fields, settings).message, "terrain: -17 is outside -16 ... 16"));
    fields.terrain[0] = 0;
    fields.sand_velocity_y.assign(200, std::numeric_limits<float>::infinity());
    CHECK(says(validate(fields, settings).message, "sand_velocity_y: inf is outside"));
}
