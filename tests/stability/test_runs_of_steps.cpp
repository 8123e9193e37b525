// Many steps at once go to the device in runs of Stepper::run_steps. Every bit must be that of as many single steps, with all
// that happens between two steps where it happened.
#include "tests/support/worlds.hpp"
#include <cstring>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

void step_singly(World& world, int count) {
    for (int n = 0; n < count; ++n) test::step(world, 1);
}

bool same_state(World& a, World& b) {
    const auto fields = state_of(a), others = state_of(b);
    if (fields.size() != others.size()) return false;
    for (std::size_t n = 0; n < fields.size(); ++n) {
        if (fields[n].first != others[n].first || fields[n].second.size() != others[n].second.size()) return false;
        if (std::memcmp(fields[n].second.data(), others[n].second.data(), fields[n].second.size() * 4) != 0) return false;
    }
    const auto stats = a.reader().stats(), other = b.reader().stats();
    return stats && other && stats->ledger.water_in == other->ledger.water_in &&
           stats->ledger.water_out == other->ledger.water_out && hash_of(a) == hash_of(b);
}

Scene poured_on(int tiles) {
    auto scene = mixed_scene(40, 24);
    scene.settings.active_tiles = tiles;
    Source source;
    source.shape = SourceShape::disc;
    source.center = {1, 1};
    source.radius = 0.5;
    source.rate.samples = {{0, 0.05}, {0.4, 0}};
    scene.settings.sources = {source};
    scene.settings.rain.samples = {{0, 0.001}};
    scene.settings.sides[SIDE_EAST].kind = SideKind::outflow;
    return scene;
}

Edit poured_at(std::uint64_t step) {
    auto edit = brush(EditLayer::water, 2, 1, 0.6, 0.2);
    edit.step = step;
    return edit;
}

} // namespace

TEST_CASE("runs of steps: the bits of single steps, with edits, roll-back and active tiles between") {
    for (const auto& backend : available_backends()) {
        for (const int tiles : {0, 8}) {
            CAPTURE(backend);
            CAPTURE(tiles);
            const Target target{.backend = backend, .shared_device = true};
            const auto runs = make_world(poured_on(tiles), target), single = make_world(poured_on(tiles), target);
            if (!runs->device().capabilities().exact_float) continue;
            for (World* world : {runs.get(), single.get()}) edit_world(*world, {poured_at(11), poured_at(16)});
            test::step(*runs, 21);
            step_singly(*single, 21);
            CHECK(same_state(*runs, *single));
            for (World* world : {runs.get(), single.get()}) {
                REQUIRE(world->roll_back().set(4, 6));
                edit_world(*world, {poured_at(31)});
            }
            test::step(*runs, 20);
            step_singly(*single, 20);
            CHECK(same_state(*runs, *single));
            CHECK(runs->roll_back().steps() == single->roll_back().steps());
            for (World* world : {runs.get(), single.get()}) REQUIRE(world->roll_back().go_back(35));
            test::step(*runs, 17);
            step_singly(*single, 17);
            CHECK(same_state(*runs, *single));
        }
    }
}

TEST_CASE("runs of steps: an edit ahead of the first step brings water of second order, whose first step starts otherwise") {
    auto scene = mixed_scene(12, 10);
    scene.fields.water.clear();
    scene.settings.method.water_transport_order = 2;
    const auto runs = make_world(scene), single = make_world(scene);
    for (World* world : {runs.get(), single.get()}) edit_world(*world, {poured_at(0)});
    test::step(*runs, 8);
    step_singly(*single, 8);
    CHECK(same_state(*runs, *single));
}

TEST_CASE("runs of steps: one submission each, and an edit a step later gives other bits") {
    const auto runs = make_world(poured_on(0)), late = make_world(poured_on(0));
    const auto submits = [&] { return runs->device().counters().submits; };
    edit_world(*runs, {poured_at(20)});
    edit_world(*late, {poured_at(21)});
    auto before = submits();
    test::step(*runs, 16);
    CHECK(submits() - before == 2);
    before = submits();
    test::step(*runs, 12); // four steps, the edit, a run
    CHECK(submits() - before == 6);
    test::step(*late, 28);
    CHECK(!same_state(*runs, *late));
}

TEST_CASE("runs of steps: a world that sleeps submits none") {
    auto scene = flat_scene(32, 32, 0.2, 0.02);
    scene.settings.active_tiles = 8;
    scene.fill(scene.fields.water, [](double, double) { return 0.5; });
    const auto world = make_world(scene);
    test::step(*world, 24);
    REQUIRE(world->device().wait(world->stepper().ticket()));
    test::step(*world, 1);
    const auto before = world->device().counters().submits;
    test::step(*world, 64);
    CHECK(world->device().counters().submits == before);
    CHECK(world->steps() == 89);
}

TEST_CASE("runs of steps: an update that catches up takes them, and the state is that of single steps") {
    const auto runs = make_world(poured_on(0)), single = make_world(poured_on(0));
    const double dt = runs->settings().dt;
    REQUIRE(runs->set_update_settings({.max_steps_per_update = 16, .max_steps_in_flight = 0}));
    const auto before = runs->device().counters().submits;
    Frame frame;
    REQUIRE(runs->update(static_cast<std::uint64_t>(19.5 * dt * 1e9), frame));
    CHECK(frame.steps == 16);
    CHECK(frame.dropped > 0);
    CHECK(runs->device().counters().submits - before == 2);
    REQUIRE(runs->update(static_cast<std::uint64_t>(10 * dt * 1e9), frame));
    CHECK(frame.steps == 10);
    CHECK(runs->device().counters().submits - before == 5);
    step_singly(*single, 26);
    CHECK(same_state(*runs, *single));
}
