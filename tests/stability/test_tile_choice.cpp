// A world that chooses for itself whether its steps run over active tiles: the choice by itself, and that it changes no bit.
#include "engine/step/run/tile_choice.hpp"
#include "tests/support/worlds.hpp"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

struct ChoiceRun {
    double over_tiles = 0; // share of the steps
    int changes = 0;
    bool last = false;
};

/// Steps in twos, the count of each submission known `late` submissions after it.
ChoiceRun run_choice(TileChoice& choice, int steps, double share, std::size_t late, std::uint64_t& step, std::uint64_t& ticket) {
    ChoiceRun run;
    std::deque<std::uint64_t> counted; // tickets of submissions over tiles
    TileChoice::News news;
    int over = 0;
    bool before = false;
    for (int n = 0; n < steps; n += 2) {
        while (!counted.empty() && counted.front() + late <= ticket) {
            news = {counted.front(), share};
            counted.pop_front();
        }
        const bool tiles = choice.wants_tiles(step, news);
        run.changes += n > 0 && tiles != before ? 1 : 0;
        before = tiles;
        choice.submitted(2, tiles, {++ticket});
        if (tiles) counted.push_back(ticket);
        over += tiles ? 2 : 0;
        step += 2;
    }
    run.last = before;
    run.over_tiles = static_cast<double>(over) / steps;
    return run;
}

/// A pond and a pile. Water evaporates in the first second, which keeps every tile awake.
Scene drying(int nx, int ny) {
    auto scene = flat_scene(nx, ny, 0.2, 0.015);
    scene.settings.material.young_modulus = 5e5;
    scene.settings.evaporation.samples = {{0, 1e-4}, {1, 1e-4}, {1.01, 0}};
    scene.fill(scene.fields.water, [](double x, double y) { return x + y < 3 ? 0.5 : 0.0; });
    scene.fill(scene.fields.sand,
               [&](double x, double y) { return std::max(0.0, 0.8 - 0.4 * std::hypot(x - 0.14 * nx, y - 0.14 * ny)); });
    scene.fill(scene.fields.terrain, [](double x, double y) { return 0.5 + 0.02 * (x + y); });
    return scene;
}

bool equal_worlds(World& a, World& b) {
    const auto fields = state_of(a), others = state_of(b);
    bool equal = fields.size() == others.size();
    for (std::size_t n = 0; equal && n < fields.size(); ++n)
        equal = fields[n].first == others[n].first &&
                std::memcmp(fields[n].second.data(), others[n].second.data(), fields[n].second.size() * 4) == 0;
    return equal && hash_of(a) == hash_of(b);
}

} // namespace

TEST_CASE("tile choice: where all is awake few steps run over tiles, where little is nearly all do") {
    for (const std::size_t late : {0, 1, 40}) {
        CAPTURE(late);
        std::uint64_t step = 0, ticket = 0;
        TileChoice awake;
        const auto all = run_choice(awake, 20000, 1, late, step, ticket);
        CHECK(all.over_tiles < 0.01);
        CHECK(all.changes <= 30);
        // What falls asleep is found at the next trial, what wakes at once.
        const auto little = run_choice(awake, 20000, 0.2, late, step, ticket);
        CHECK(little.over_tiles > 0.85);
        CHECK(little.last);
        const auto again = run_choice(awake, 2000, 0.9, late, step, ticket);
        CHECK(!again.last);
        CHECK(again.over_tiles < 0.1);
    }
}

TEST_CASE("tile choice: between its two shares a world stays as it is") {
    const double between = 0.5 * (TileChoice::begin_below + TileChoice::leave_above);
    std::uint64_t step = 0, ticket = 0;
    TileChoice with, without;
    REQUIRE(run_choice(with, 100, 0.1, 1, step, ticket).last);
    CHECK(run_choice(with, 5000, between, 1, step, ticket).over_tiles == 1);
    step = ticket = 0;
    REQUIRE(!run_choice(without, 100, 1, 1, step, ticket).last);
    const auto stays = run_choice(without, 5000, between, 1, step, ticket);
    CHECK(!stays.last);
    CHECK(stays.over_tiles < 0.02);
}

TEST_CASE("tile choice: going back and forth changes no bit") {
    for (const auto& backend : available_backends()) {
        for (const bool fused : {false, true}) {
            if (backend != "cpu" && !fused) continue; // nothing is chosen there
            CAPTURE(backend);
            CAPTURE(fused);
            // Enough tiles and steps for a second trial, where stages are quick.
            const bool large = backend == "cpu" && !fused;
            auto scene = large ? drying(200, 160) : drying(66, 50);
            const auto plain = make_world(scene);
            scene.settings.active_tiles = tiles_where_they_gain;
            scene.settings.fused_stages = fused ? FusedStages::always : FusedStages::never;
            const auto chosen = make_world(scene, {.backend = backend, .shared_device = true});
            if (!chosen->device().capabilities().exact_float) continue;
            REQUIRE(chosen->plan().active_tiles); // begins with a trial
            int changes = 0;
            bool before = true;
            const auto go = [&](int steps) {
                step(*plain, steps);
                step(*chosen, steps);
                changes += chosen->plan().active_tiles != before ? 1 : 0;
                before = chosen->plan().active_tiles;
                CHECK(equal_worlds(*plain, *chosen));
            };
            for (const int steps : {1, 9, 1, 3, 40}) go(steps);
            CHECK(!chosen->plan().active_tiles); // all was awake
            CHECK(chosen->reader().stats()->active_tiles == chosen->reader().stats()->tiles);
            for (World* world : {plain.get(), chosen.get()}) REQUIRE(world->roll_back().set(2, 16));
            for (const int steps : large ? std::vector{30, 7, 130, 71, 16} : std::vector{16, 7}) go(steps);
            if (large) CHECK(chosen->plan().active_tiles); // the next trial
            CHECK(changes >= (large ? 2 : 1));
            auto edit = brush(EditLayer::sand, 4, 4, 1, 0.3);
            for (World* world : {plain.get(), chosen.get()}) edit_world(*world, {edit});
            go(5);
            for (World* world : {plain.get(), chosen.get()}) REQUIRE(world->roll_back().go_back(large ? 304 : 64));
            go(12);
            Material slippery = scene.settings.material;
            slippery.friction -= 0.05;
            for (World* world : {plain.get(), chosen.get()}) REQUIRE(world->stepper().set_material(slippery));
            go(11);
        }
    }
}
