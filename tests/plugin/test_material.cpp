// The material of a running world through the C ABI: a change is the same as a level that had the value, at any step, on every
// backend, in logs, snapshots and kept steps; what cannot be is refused and changes nothing.
#include "tests/plugin/abi_worlds.hpp"
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <map>
#include <string>
#include <vector>

using namespace wadi::test;

namespace {

constexpr int CELLS = 28;

// A heap of sand, half wet, a lake against it and a film of water on the rest.
AbiWorld site(const std::string& backend, const std::string& material = "", const std::string& more = "") {
    std::vector<float> terrain, sand, water;
    for (int j = 0; j < CELLS; ++j) {
        for (int i = 0; i < CELLS; ++i) {
            const double x = (i + 0.5) / CELLS, y = (j + 0.5) / CELLS;
            terrain.push_back(static_cast<float>(0.2 * x + 0.1 * std::sin(6 * y)));
            sand.push_back(static_cast<float>(std::max(0.0, 1.2 - 3 * std::hypot(x - 0.5, y - 0.5))));
            water.push_back(x < 0.35 ? 0.9F : 0.1F * static_cast<float>(y));
        }
    }
    const std::string json = R"({"format_version": 1, "name": "site", "grid": {"nx": 28, "ny": 28, "dx": 0.25}, "dt": 0.012, )" +
                             more + R"("material": {)" + material + "}}";
    return world_of(backend, json, CELLS, CELLS, terrain, sand, water);
}

void set(const AbiWorld& world, const std::string& name, double value) {
    REQUIRE_MESSAGE(wadi_world_set_material(world.id, name.c_str(), value) == WADI_OK, std::string(wadi_get_last_error()));
}

std::vector<wadi_material_info> material_of(const AbiWorld& world) {
    uint32_t count = 0;
    REQUIRE(wadi_world_get_material(world.id, nullptr, &count) == WADI_OK);
    std::vector<wadi_material_info> infos(count);
    REQUIRE(wadi_world_get_material(world.id, infos.data(), &count) == WADI_OK);
    return infos;
}

double value_of(const AbiWorld& world, const std::string& name) {
    for (const auto& info : material_of(world))
        if (name == info.name) return info.value;
    FAIL("no number " << name);
    return 0;
}

bool has_effect(const AbiWorld& world, const std::string& name) {
    uint32_t count = 0;
    REQUIRE(wadi_world_get_effects(world.id, nullptr, &count) == WADI_OK);
    std::vector<wadi_effect_info> effects(count);
    REQUIRE(wadi_world_get_effects(world.id, effects.data(), &count) == WADI_OK);
    return std::any_of(effects.begin(), effects.end(), [&](const auto& e) { return name == e.name && e.on == 1; });
}

// Other values that show, effects switched on and off among them.
const std::map<std::string, double> showing = {
    {"water_density", 1100}, {"sand_density", 2600},   {"friction", 0.05},
    {"young_modulus", 0},    {"poisson_ratio", 0.1},   {"yield_friction", 1.2},
    {"cohesion_dry", 900},   {"cohesion_wet", 100},    {"cohesion_capillary", 150},
    {"exchange_rate", 0},    {"diffusion_rate", 0},    {"bed_friction", 0.3},
    {"bed_shear", 0.5},      {"grain_size", 0.1}, // needs bed_shear to show
    {"slope_normal", 0.5},   {"internal_friction", 0}, {"sand_viscosity", 0},
    {"retention", 0.1},      {"manning", 0.2},         {"saturation[0]", 0.02},
    {"saturation[1]", 0.3},  {"saturation[2]", 0.49},  {"bed_adhesion", 0},
};

/// Another value for every number.
std::map<std::string, double> other_values() {
    std::map<std::string, double> others;
    for (const auto& info : material_of(site("cpu"))) {
        const auto found = showing.find(info.name);
        others[info.name] = found != showing.end() ? found->second : std::min(info.most, info.value > 0 ? 2 * info.value : 1.0);
    }
    return others;
}

/// As a level writes it.
std::string in_level(const std::string& name, double value) {
    if (!name.starts_with("saturation")) return '"' + name + "\": " + std::to_string(value);
    double phi[3] = {0.2, 0.25, 0.33};
    phi[name[11] - '0'] = value;
    return R"("saturation": [)" + std::to_string(phi[0]) + ", " + std::to_string(phi[1]) + ", " + std::to_string(phi[2]) + "]";
}

// Changes between and inside steps, effects switched off and on again.
void session(const AbiWorld& world) {
    step(world, 6);
    set(world, "friction", 0.1);
    step(world, 5);
    set(world, "young_modulus", 0);
    set(world, "bed_shear", 0.2);
    auto settings = wadi_default_update_settings();
    settings.spread = 1;
    REQUIRE(wadi_world_set_update_settings(world.id, &settings) == WADI_OK);
    auto frame = wadi_default_frame();
    REQUIRE(wadi_world_update(world.id, 18'000'000, &frame) == WADI_OK); // one step and half of the next
    set(world, "young_modulus", 3e5);
    step(world, 4);
    set(world, "bed_shear", 0);
    step(world, 7);
}

} // namespace

TEST_CASE("every number changed at the start is the same to the bit as a level that had it, on every backend") {
    const auto plain = [] {
        const auto world = site("cpu");
        step(world, 25);
        return hash_of(world);
    }();
    std::map<std::string, std::uint64_t> expected;
    const auto others = other_values();
    for (const auto& [name, other] : others) {
        const auto level = site("cpu", in_level(name, other));
        step(level, 25);
        expected[name] = hash_of(level);
    }
    for (const auto& backend : abi_backends()) {
        int telling = 0;
        const auto changed = site(backend); // one for all: going back to its start brings the material back
        const auto start = saved(changed);
        for (const auto& [name, other] : others) {
            CAPTURE(name);
            REQUIRE(wadi_world_load(changed.id, start.data(), start.size()) == WADI_OK);
            set(changed, name, other);
            CHECK(value_of(changed, name) == value_of(site("cpu", in_level(name, other)), name));
            step(changed, 25);
            CHECK(hash_of(changed) == expected[name]);
            telling += hash_of(changed) != plain ? 1 : 0;
        }
        CHECK(telling >= 18); // grain_size is nothing without bed_shear, and no sand here is full enough for the others
        MESSAGE(backend << ": " << telling << " of " << others.size() << " numbers show within 25 steps");
    }
}

TEST_CASE("a change acts from the next whole step, also in the middle of one; the same value changes nothing") {
    const auto twin = site("cpu"), world = site("cpu"), late = site("cpu"), spread = site("cpu");
    for (const auto* w : {&twin, &world, &late}) step(*w, 10);
    set(world, "friction", 0.02);
    CHECK(hash_of(world) == hash_of(twin));
    set(twin, "friction", 0.5);
    for (const auto* w : {&twin, &world, &late}) step(*w, 1);
    CHECK(hash_of(world) != hash_of(twin));
    CHECK(hash_of(twin) == hash_of(late));
    auto settings = wadi_default_update_settings();
    settings.spread = 1;
    settings.max_steps_per_update = 64;
    settings.max_steps_in_flight = 0; // drops nothing
    REQUIRE(wadi_world_set_update_settings(spread.id, &settings) == WADI_OK);
    auto frame = wadi_default_frame();
    REQUIRE(wadi_world_update(spread.id, 9 * 12'000'000 + 8'000'000, &frame) == WADI_OK); // nine steps and parts of the tenth
    set(spread, "friction", 0.02);
    CHECK(steps_of(spread) == 10);
    step(spread, 1);
    CHECK(hash_of(spread) == hash_of(world));
}

TEST_CASE("a log of changes replays to the same hash on every backend, in steps of any number") {
    const auto first = site("cpu");
    REQUIRE(wadi_world_set_command_log(first.id, 1) == WADI_OK);
    session(first);
    const auto hash = hash_of(first), steps = steps_of(first);
    const auto log = log_of(first);
    const auto unchanged = site("cpu");
    step(unchanged, static_cast<unsigned>(steps));
    CHECK(hash_of(unchanged) != hash);
    for (const auto& backend : abi_backends()) {
        for (const unsigned at_once : {1u, 9u, 24u}) {
            const auto again = site(backend);
            REQUIRE_MESSAGE(wadi_world_play_commands(again.id, log.data(), log.size()) == WADI_OK,
                            std::string(wadi_get_last_error()));
            for (unsigned done = 0; done < steps; done += at_once)
                step(again, std::min(at_once, static_cast<unsigned>(steps) - done));
            CHECK(hash_of(again) == hash);
            CHECK(value_of(again, "friction") == 0.1);
        }
    }
}

TEST_CASE("snapshots hold the material of their moment and bring it to a world of the same level") {
    for (const auto& backend : abi_backends()) {
        const auto world = site(backend);
        session(world);
        set(world, "diffusion_rate", 0); // an effect less than the level's
        set(world, "bed_shear", 0.1);    // and one more
        step(world, 2);
        const auto snapshot = saved(world);
        step(world, 6);
        const auto hash = hash_of(world);
        for (const auto& other : abi_backends()) {
            const auto fresh = site(other);
            REQUIRE_MESSAGE(wadi_world_load(fresh.id, snapshot.data(), snapshot.size()) == WADI_OK,
                            std::string(wadi_get_last_error()));
            CHECK(value_of(fresh, "bed_shear") == 0.1);
            CHECK(has_effect(fresh, "bed_shear"));
            CHECK(!has_effect(fresh, "diffusion"));
            step(fresh, 6);
            CHECK(hash_of(fresh) == hash);
        }
        const auto before = saved(site(backend)); // and back to the level's own
        REQUIRE(wadi_world_load(world.id, before.data(), before.size()) == WADI_OK);
        CHECK(value_of(world, "friction") == 0.5);
        step(world, 5);
        const auto level = site(backend);
        step(level, 5);
        CHECK(hash_of(world) == hash_of(level));
        const auto foreign = site(backend, R"("friction": 0.4)"); // of another level, even if its material is the same now
        set(foreign, "friction", 0.5);
        CHECK(wadi_world_load(foreign.id, before.data(), before.size()) == WADI_ERROR_BAD_ARGUMENT);
    }
}

TEST_CASE("going back brings the material of that step, and the same changes the same hashes") {
    for (const auto& backend : abi_backends()) {
        const auto world = site(backend);
        REQUIRE(wadi_world_set_rollback(world.id, 32, 1) == WADI_OK);
        const auto play = [&] {
            set(world, "friction", 0.2);
            step(world, 4);
            set(world, "bed_friction", 0.2); // brings its effect
            step(world, 4);
            return hash_of(world);
        };
        step(world, 5);
        const auto first = play();
        CHECK(has_effect(world, "bed_friction"));
        uint64_t reached = 0;
        REQUIRE_MESSAGE(wadi_world_roll_back(world.id, 5, &reached) == WADI_OK, std::string(wadi_get_last_error()));
        CHECK(reached == 5);
        CHECK(value_of(world, "friction") == 0.5);
        CHECK(value_of(world, "bed_friction") == 0);
        CHECK(!has_effect(world, "bed_friction"));
        CHECK(play() == first);
        REQUIRE(wadi_world_roll_back(world.id, 7, &reached) == WADI_OK);
        CHECK(value_of(world, "friction") == 0.2);
        set(world, "friction", 0.9); // another future
        step(world, 6);
        CHECK(hash_of(world) != first);
        // An effect that is gone takes the steps that had it along.
        set(world, "young_modulus", 0);
        CHECK(wadi_world_roll_back(world.id, 8, &reached) == WADI_ERROR_BAD_ARGUMENT);
        step(world, 1);
        CHECK(wadi_world_roll_back(world.id, 14, &reached) == WADI_OK);
    }
}

TEST_CASE("effects and memory follow the value; where they stay, no buffer is made") {
    const auto world = site("cpu");
    step(world, 3);
    const auto bytes = device_bytes(world.id);
    set(world, "cohesion_wet", 3e4);
    CHECK(device_bytes(world.id) == bytes);
    set(world, "young_modulus", 0);
    CHECK(!has_effect(world, "elastoplastic"));
    CHECK(!has_effect(world, "cohesion"));
    CHECK(device_bytes(world.id) < bytes);
    set(world, "young_modulus", 2e5);
    CHECK(has_effect(world, "cohesion"));
    CHECK(device_bytes(world.id) == bytes);
    step(world, 3);
    uint32_t count = 0;
    REQUIRE(wadi_world_get_effects(world.id, nullptr, &count) == WADI_OK);
    std::vector<wadi_effect_info> effects(count);
    set(world, "bed_friction", 0.5);
    REQUIRE(wadi_world_get_effects(world.id, effects.data(), &count) == WADI_OK);
    for (const auto& effect : effects)
        if (std::string(effect.name) == "bed_friction") CHECK(std::string(effect.why) == "bed_friction is above 0");
}

TEST_CASE("what cannot be is refused with its reason and changes nothing") {
    const auto twin = site("cpu"), world = site("cpu");
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
    for (const auto& info : material_of(world)) {
        CAPTURE(std::string(info.name));
        const auto refuse = [&](double value) {
            CHECK(wadi_world_set_material(world.id, info.name, value) == WADI_ERROR_BAD_ARGUMENT);
            CHECK(error_mentions(std::string("material.") + info.name));
        };
        for (const double value : {nan, infinite, -infinite, std::nextafter(info.least, -1e30), std::nextafter(info.most, 1e30)})
            refuse(value);
    }
    CHECK(wadi_world_set_material(world.id, "friction", 11) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("0 ... 10"));
    CHECK(wadi_world_set_material(world.id, "saturation[1]", 0.2) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("above saturation[0]"));
    CHECK(wadi_world_set_material(world.id, "frictoin", 0.5) == WADI_ERROR_NOT_FOUND);
    CHECK(error_mentions("friction"));
    CHECK(wadi_world_set_material(world.id, "", 0.5) == WADI_ERROR_NOT_FOUND);
    CHECK(wadi_world_set_material(world.id, nullptr, 0.5) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_set_material({}, "friction", 0.5) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_get_material(world.id, nullptr, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    step(world, 8);
    step(twin, 8);
    CHECK(hash_of(world) == hash_of(twin));

    const auto dry = site("cpu", "", R"("effects": {"diffusion": "off"}, )");
    CHECK(wadi_world_set_material(dry.id, "diffusion_rate", 0.02) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("effects.diffusion"));
    set(dry, "friction", 0.6); // its other numbers are free
    uint32_t few = 2;
    std::vector<wadi_material_info> infos(2);
    REQUIRE(wadi_world_get_material(dry.id, infos.data(), &few) == WADI_OK);
    CHECK(few == material_of(site("cpu")).size());
    CHECK(std::string(infos[1].name) == "sand_density");
}
