// Fields too large to pass between host and device at once: written, read, counted and hashed in parts, on several threads.
#include "engine/settings/data/quanta.hpp"
#include "engine/step/run/field_store.hpp"
#include "engine/threads/bands.hpp"
#include "tests/support/worlds.hpp"
#include <bit>
#include <cmath>
#include <doctest/doctest.h>
#include <numeric>

using namespace wadi;
using namespace wadi::test;

namespace {

/// The state's hash by its definition, value by value: the sum of a hash of field, place and bits.
std::uint64_t hash_by_definition(World& world) {
    const auto mixed = [](std::uint64_t x) { // splitmix64's finaliser
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
        return x ^ (x >> 31);
    };
    const auto& layout = world.state().layout();
    std::uint64_t hash = 0, number = 0;
    for (const FieldRow& field : field_table()) {
        if (!field.hashed) continue;
        const std::uint64_t n = number++;
        if (world.plan().find(std::string(field.name)) == nullptr) continue;
        const auto raw = world.reader().read_raw(std::string(field.name));
        REQUIRE(raw);
        for (int j = 0; j < layout.ny + (field.place == FieldPlace::south_face ? 1 : 0); ++j)
            for (int i = 0; i < layout.nx + (field.place == FieldPlace::west_face ? 1 : 0); ++i)
                hash += mixed(mixed((n << 56) ^ (std::uint64_t(j) << 28) ^ std::uint64_t(i)) +
                              std::bit_cast<std::uint32_t>((*raw)[layout.index(i, j)]));
    }
    return hash;
}

} // namespace

TEST_CASE("fields of several parts: written, read, counted and hashed as their cells say, whatever the threads") {
    Scene scene = flat_scene(14000, 400, 1, 0.01);
    const auto pattern = [](double x, double y) { return std::fmod(7 * std::floor(x) + 13 * std::floor(y), 64) / 64; };
    scene.fill(scene.fields.terrain, [&](double x, double y) { return pattern(x, 2 * y) - 0.5; });
    scene.fill(scene.fields.water, pattern);
    scene.fill(scene.fields.velocity_x, [&](double x, double y) { return pattern(3 * x, y) - 0.25; });
    scene.fields.water[14000 * 399 + 13999] = 1.25f; // the largest, in the last part
    const auto world = make_world(scene);
    const auto& layout = world->state().layout();
    REQUIRE(rows_at_once(layout) < 400);

    std::vector<float> cells(scene.fields.water.size());
    for (const auto& [name, field] : {std::pair{"terrain", &scene.fields.terrain}, {"water_height", &scene.fields.water}}) {
        REQUIRE(world->reader().read(name, cells));
        CHECK_MESSAGE(cells == *field, name);
    }
    const auto terrain = world->reader().read_raw("terrain"), speed = world->reader().read_raw("water_velocity_x");
    REQUIRE(terrain);
    REQUIRE(speed);
    CHECK((*terrain)[layout.index(-2, -2)] == scene.fields.terrain.front()); // ghosts repeat the edge
    CHECK((*terrain)[layout.index(14000 + 2, 400 + 2)] == scene.fields.terrain.back());
    const auto face = [&](int i, int j) { return (*speed)[layout.index(i, j)]; };
    const auto cell_speed = [&](int i, int j) { return scene.fields.velocity_x[std::size_t(j) * 14000 + std::size_t(i)]; };
    for (const int j : {0, 200, 399}) {
        CHECK(face(9000, j) == 0.5f * (cell_speed(9000, j) + cell_speed(8999, j)));
        CHECK(face(0, j) == 0);
        CHECK(face(14000, j) == 0);
    }

    const std::uint64_t expected = hash_by_definition(*world);
    const double water = std::accumulate(scene.fields.water.begin(), scene.fields.water.end(), 0.0);
    const double fastest = static_cast<double>(
        *std::max_element(speed->begin(), speed->end(), [](float a, float b) { return std::fabs(a) < std::fabs(b); }));
    for (const int threads : {1, 3}) {
        CAPTURE(threads);
        const ThreadLimit limit(threads);
        const auto stats = world->reader().stats();
        REQUIRE(stats);
        CHECK(stats->hash == expected);
        CHECK(hash_of(*world) == expected);
        CHECK(static_cast<double>(stats->water_quanta) * stats->quantum == water); // exact: multiples of 1/64
        CHECK(stats->water_initial == stats->water_quanta);
        CHECK(stats->largest_water == 1.25);
        CHECK(stats->largest_water_speed == std::fabs(fastest));
        CHECK(stats->smallest_height == 0);
        CHECK(stats->not_finite == 0);
    }
}
