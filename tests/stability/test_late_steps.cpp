// Worlds that run for months: steps beyond what an int holds.
#include "engine/saves/sealed_bytes.hpp"
#include "engine/saves/snapshot_format.hpp"
#include "engine/step/run/step_number.hpp"
#include "tests/support/worlds.hpp"
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

constexpr std::uint64_t int_end = std::uint64_t{1} << 31;

// The world goes on from that step, as if it had run so long.
void pretend(World& world, std::uint64_t at_step) {
    auto bytes = save(world);
    auto header = read_header(bytes);
    REQUIRE(header);
    header->totals.steps = at_step;
    write_header(*header, bytes);
    seal(bytes);
    REQUIRE(world.snapshots().load(bytes));
    REQUIRE(world.steps() == at_step);
}

// Rain, a source and a side that begin with nothing and, later on, hold what they have come to.
Scene growing_scene() {
    auto scene = mixed_scene(40, 33);
    auto& settings = scene.settings;
    Source source;
    source.center = {3, 3};
    source.radius = 1;
    source.rate.samples = {{0, 0}, {1, 0.2}};
    settings.sources = {source};
    settings.rain.samples = {{0, 0}, {1, 1e-3}};
    settings.sides[SIDE_WEST].kind = SideKind::discharge;
    settings.sides[SIDE_WEST].value.samples = {{0, 0}, {1, 0.3}};
    return scene;
}

} // namespace

TEST_CASE("numbers that stages get of steps are positive, count on by one, and lead back to the step") {
    for (const std::uint64_t from : {std::uint64_t{0}, int_end - 40, int_end + STEP_TURN - 40, 9 * int_end - 40}) {
        for (std::uint64_t step = from; step < from + 80; ++step) {
            CHECK((stage_step(step) > 0 || step == 0));
            CHECK((stage_step(step + 1) == std::int64_t{stage_step(step)} + 1) == !turns(step + 1));
            for (const std::uint64_t later : {step, step + 70})
                CHECK(step_behind(stage_step(step), later) == static_cast<std::int64_t>(step));
        }
    }
    CHECK(stage_step(int_end - 1) == 2147483647);
}

TEST_CASE("sources, rain and sides hold their last value past step 2^31, in the ledger too") {
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto world = make_world(growing_scene(), {backend});
        step(*world, 3);
        pretend(*world, int_end - 4);
        std::vector<std::int64_t> came;
        std::int64_t before = world->reader().stats()->ledger.water_in;
        for (int n = 0; n < 8; ++n) {
            step(*world, 1);
            const auto stats = world->reader().stats();
            REQUIRE(stats);
            came.push_back(stats->ledger.water_in - before);
            before = stats->ledger.water_in;
        }
        CHECK(world->steps() == int_end + 4);
        for (const auto quanta : came) {
            CHECK(quanta > 0);
            CHECK(static_cast<double>(quanta) == doctest::Approx(static_cast<double>(came.front())).epsilon(0.02));
        }
    }
}

TEST_CASE("active tiles and output tiles pass step 2^31 without another bit or another answer") {
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto scene = mixed_scene(96, 80);
        auto tiled = scene;
        tiled.settings.active_tiles = 16;
        auto plain = make_world(scene, {backend}), tiles = make_world(tiled, {backend});
        REQUIRE(plain->outputs().set_mask(tiles_bit));
        for (auto* world : {plain.get(), tiles.get()}) {
            step(*world, 3);
            pretend(*world, int_end - 6);
        }
        std::int64_t newest = 0;
        for (int n = 0; n < 12; ++n) {
            edit_world(*tiles, {brush(EditLayer::water, 4, 4, 1, 0.05)});
            edit_world(*plain, {brush(EditLayer::water, 4, 4, 1, 0.05)});
            step(*tiles, 1);
            Frame frame;
            REQUIRE(plain->update(static_cast<std::uint64_t>(scene.settings.dt * 1e9 + 0.5), frame));
            REQUIRE(hash_of(*plain) == hash_of(*tiles)); // waits: the copies are there in the next update
            const auto found = plain->outputs().tiles();
            if (!found) continue;
            newest = 0;
            for (int t = 0; t < found->count(); ++t) newest = std::max(newest, (*found)[t].changed_step);
            CHECK(newest == static_cast<std::int64_t>(found->step));
        }
        CHECK(newest > static_cast<std::int64_t>(int_end));
    }
}
