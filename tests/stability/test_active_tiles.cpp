// Active tiles leave tiles out of a step in which nothing changes any more. Every bit must be that of the dense run: step by
// step, with all that can wake a tile, and after a long rest.
#include "engine/settings/data/method_presets.hpp"
#include "engine/settings/rules/material_keys.hpp"
#include "tests/support/worlds.hpp"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

/// Tiles that ran in the last step, as their share of all.
double awake(World& world) {
    const auto stats = world.reader().stats();
    REQUIRE(stats);
    REQUIRE(stats->tiles > 0);
    return static_cast<double>(stats->active_tiles) / static_cast<double>(stats->tiles);
}

/// The scene with and without active tiles, side by side.
struct Twins {
    Twins(Scene scene, int size, const Target& target = {}) {
        scene.settings.active_tiles = 0;
        const auto asked = scene.settings.fused_stages;
        scene.settings.fused_stages = FusedStages::never;
        dense = make_world(scene);
        scene.settings.fused_stages = asked;
        scene.settings.active_tiles = size;
        sparse = make_world(scene, target);
    }
    bool equal() {
        for (const auto& [name, values] : state_of(*dense)) {
            const auto other = sparse->reader().read_raw(name);
            REQUIRE(other);
            if (std::memcmp(values.data(), other->data(), values.size() * 4) != 0) {
                MESSAGE(name << " differs after step " << dense->steps());
                return false;
            }
        }
        return hash_of(*dense) == hash_of(*sparse);
    }
    void step(int count) {
        test::step(*dense, count);
        test::step(*sparse, count);
    }
    /// Steps after which the two differ for the first time, or -1.
    int differ(int steps, int every = 1) {
        for (int done = 0; done < steps; done += every) {
            step(every);
            if (!equal()) return done + every;
        }
        return -1;
    }
    void edit(Edit edit) {
        REQUIRE(dense->commands().edit(std::span(&edit, 1)));
        REQUIRE(sparse->commands().edit(std::span(&edit, 1)));
    }
    std::unique_ptr<World> dense, sparse;
};

/// A pond and a dry pile far apart in a large dry basin: most of it never moves.
Scene pond_and_pile(int nx = 160, int ny = 128) {
    auto scene = flat_scene(nx, ny, 0.2, 0.015);
    auto& material = scene.settings.material;
    material.young_modulus = 5e5;
    material.exchange_rate = 3e4;
    scene.fill(scene.fields.water, [](double x, double y) { return std::hypot(x - 4, y - 5) < 1.5 ? 0.8 : 0.0; });
    // Gentler than its friction: of a pile as steep some faces keep a speed that moves no quantum, and its tiles stay awake.
    scene.fill(scene.fields.sand, [](double x, double y) { return std::max(0.0, 0.9 - 0.45 * std::hypot(x - 25, y - 18)); });
    scene.fill(scene.fields.terrain, [](double x, double y) { return std::max(0.0, 0.5 * std::hypot(x - 4, y - 5) - 1.2); });
    for (auto& h : scene.fields.terrain) h = std::min(h, 1.5F);
    return scene;
}

Edit pour(EditLayer layer, double x, double y, double amount) { return brush(layer, x, y, 0.7, amount, 0); }

} // namespace

TEST_CASE("active tiles: every level gives the bits of the dense run, step by step") {
    int turn = 0;
    for (const auto& name : shipped_levels()) {
        if (few_steps && turn++ % 3 != 0) continue;
        CAPTURE(name);
        Twins twins(shipped_level(name, 96, 80), 8);
        CHECK(twins.differ(few_steps ? 10 : 24, few_steps ? 5 : 1) == -1);
        if (!few_steps) CHECK(twins.differ(40, 20) == -1);
    }
}

TEST_CASE("active tiles: with fused stages, every level and every size of tiles, the same bits again") {
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        int turn = 0;
        for (const auto& name : shipped_levels()) {
            const int size = 8 << turn++ / 2 % 4;
            if ((few_steps && turn % 3 != 0) || (backend != "cpu" && turn % 2 != 0)) continue;
            CAPTURE(name);
            auto scene = shipped_level(name, 70, 50);
            scene.settings.fused_stages = FusedStages::always;
            CAPTURE(size);
            Twins twins(scene, size, {.backend = backend, .shared_device = true});
            const auto& device = twins.sparse->device().capabilities();
            if (!device.fused_stages || !device.exact_float) continue;
            CHECK(twins.differ(few_steps || backend != "cpu" ? 4 : 8, few_steps ? 2 : 4) == -1);
            CHECK(twins.sparse->device().counters().validation_messages == 0);
        }
    }
}

TEST_CASE("active tiles: water runs no stage of the sand, dry sand none of the water, and they meet in the same bits") {
    for (const bool fused : {false, true}) {
        for (const auto& backend : available_backends()) {
            if (!fused && (few_steps || backend != "cpu")) continue; // one by one on GPUs: with barriers, below
            CAPTURE(fused);
            CAPTURE(backend);
            const Target target = {.backend = backend, .shared_device = true};
            auto scene = pond_and_pile(100, 80);
            scene.settings.fused_stages = fused ? FusedStages::always : FusedStages::never;
            scene.settings.effects = {{"sand", Force::on}, {"water", Force::on}};
            auto pond = scene, pile = scene;
            pond.fields.sand.clear();
            pile.fields.water.clear();
            pile.fill(pile.fields.sand, [](double x, double y) { return std::max(0.0, 2 - 1.5 * std::hypot(x - 15, y - 11)); });
            scene.fields.sand = pile.fields.sand;
            Twins twins(scene, 8, target), wet(pond, 8, target), dry(pile, 8, target);
            if (!twins.sparse->device().capabilities().exact_float) continue;
            REQUIRE(twins.sparse->plan().tiles_by_material);
            for (Twins* t : {&twins, &wet, &dry}) CHECK(t->differ(backend == "cpu" ? 8 : 4, 2) == -1);
            const auto both = twins.sparse->reader().stats(), water = wet.sparse->reader().stats(),
                       sand = dry.sparse->reader().stats();
            REQUIRE((both && water && sand));
            CHECK(water->active_tiles > 8);
            CHECK(water->active_sand_tiles == 0);
            CHECK(sand->active_sand_tiles > 8);
            CHECK(sand->active_tiles == sand->active_sand_tiles);                           // the longer list
            CHECK(both->active_tiles == std::max(water->active_tiles, sand->active_tiles)); // each its own
            CHECK(both->active_sand_tiles == sand->active_sand_tiles);
            // Sand into the pond, water onto the pile, and both where neither was.
            twins.edit(pour(EditLayer::sand, 4, 5, 0.6));
            twins.edit(pour(EditLayer::water, 15, 11, 0.4));
            twins.edit(pour(EditLayer::water, 9, 12, 0.5));
            twins.edit(pour(EditLayer::sand, 10, 12, 0.5));
            CHECK(twins.differ(few_steps || backend != "cpu" ? 6 : 18, 3) == -1);
        }
    }
}

TEST_CASE("active tiles: every size, several T, and one thread as well as three") {
    for (const int size : {8, 16, 32, 64}) {
        for (const int substeps : {1, 2, 5}) {
            if (few_steps && (substeps != 2 || size == 32)) continue;
            CAPTURE(size);
            CAPTURE(substeps);
            auto scene = pond_and_pile();
            scene.settings.method.substeps = substeps;
            Target target;
            target.options.threads = size == 16 ? 1 : 3;
            Twins twins(scene, size, target);
            CHECK(twins.differ(few_steps ? 16 : 40, few_steps ? 8 : 4) == -1);
            if (size == 8) CHECK(awake(*twins.sparse) < 0.9);
        }
    }
}

TEST_CASE("active tiles: every backend, with barriers everywhere and recorded anew as well") {
    for (const auto& backend : available_backends()) {
        for (const int variant : {0, 1, 2}) {
            if (few_steps && variant == 1) continue; // barriers are for GPUs
            CAPTURE(backend);
            CAPTURE(variant);
            Target target{backend};
            target.options.full_barriers = variant == 1;
            target.options.no_replay = variant == 2;
            Twins twins(pond_and_pile(), variant == 0 ? 8 : 32, target);
            if (!twins.sparse->device().capabilities().exact_float) continue;
            CHECK(twins.differ(few_steps || backend != "cpu" ? 12 : 30, 3) == -1);
            twins.edit(pour(EditLayer::water, 20, 8, 0.4));
            for (int part = 0; part < twins.sparse->stepper().parts(); ++part) REQUIRE(twins.sparse->stepper().step_part());
            test::step(*twins.dense, 1);
            CHECK(twins.differ(few_steps || backend != "cpu" ? 8 : 20, 4) == -1);
            CHECK(twins.sparse->device().counters().validation_messages == 0);
            if (variant == 0) CHECK(awake(*twins.sparse) < 0.9);
        }
    }
}

TEST_CASE("active tiles: too few rings around what changes are found out") {
    auto scene = pond_and_pile();
    Twins twins(scene, 8);
    CHECK(twins.differ(few_steps ? 10 : 60) == -1);
    Twins weak(scene, 8);
    REQUIRE(weak.sparse->stepper().set_tile_rings(0));
    CHECK(weak.differ(60) > 0);
}

TEST_CASE("active tiles: a step carries a change no further than the plan's reach") {
    int widest = 0;
    for (const char* method : {"robust", "published", "second order"}) {
        for (const int substeps : {1, 4}) {
            if (few_steps && substeps == 4) continue;
            auto scene = mixed_scene(192, 160);
            if (std::string(method) == "published") choose_method(scene.settings, method);
            if (std::string(method) == "second order")
                scene.settings.method.water_transport_order = scene.settings.method.sand_transport_order = 2;
            scene.settings.method.substeps = substeps;
            scene.settings.material.bed_shear = 0.01;
            constexpr int at_x = 85, at_y = 78;
            auto one = make_world(scene), other = make_world(scene);
            for (World* world : {one.get(), other.get()}) step(*world, few_steps ? 8 : 20);
            for (const auto layer : {EditLayer::sand, EditLayer::water, EditLayer::terrain})
                REQUIRE(other->commands().write_region(layer, {at_x, at_y, 1, 1}, std::vector<float>{0.55F}));
            step(*one, 1);
            step(*other, 1);
            int furthest = 0;
            for (const auto& [name, values] : state_of(*one)) {
                const auto theirs = other->reader().read_raw(name);
                REQUIRE(theirs);
                const FieldLayout layout{192, 160};
                for (int j = 0; j <= 160; ++j)
                    for (int i = 0; i <= 192; ++i)
                        if (std::memcmp(&values[layout.index(i, j)], &(*theirs)[layout.index(i, j)], 4) != 0)
                            furthest = std::max({furthest, std::abs(i - at_x), std::abs(j - at_y)});
            }
            CAPTURE(method);
            CAPTURE(substeps);
            MESSAGE("reach " << one->plan().reach << ", changed " << furthest << " cells away");
            CHECK(furthest <= one->plan().reach);
            widest = std::max(widest, furthest);
        }
    }
    CHECK(widest > (few_steps ? 2 : 6)); // seen, not only bounded
}

TEST_CASE("active tiles: a world at rest sleeps for long, wakes where it is edited, and keeps every bit" *
          doctest::test_suite("long")) {
    Twins twins(pond_and_pile(), 8);
    twins.step(600);
    CHECK(twins.equal());
    const double resting = awake(*twins.sparse);
    MESSAGE("awake after 600 steps: " << resting);
    CHECK(resting < 0.3);
    twins.edit(pour(EditLayer::water, 20, 8, 0.4));
    CHECK(twins.differ(40, 4) == -1);
    CHECK(awake(*twins.sparse) > resting);
    twins.edit(pour(EditLayer::sand, 12, 20, 0.5));
    CHECK(twins.differ(40, 4) == -1);
    twins.edit(pour(EditLayer::terrain, 26, 18, -0.3)); // takes the ground from under the pile
    CHECK(twins.differ(120, 4) == -1);
    twins.step(400);
    CHECK(twins.equal());
}

TEST_CASE("active tiles: dry ground sleeps from the third step on, and an edit promotes it awake") {
    auto scene = flat_scene(150, 100, 0.2, 0.015);
    scene.settings.effects = {{"water", Force::on}};
    Twins twins(scene, 8);
    twins.step(1);
    CHECK(awake(*twins.sparse) == 1);
    twins.step(3);
    CHECK(awake(*twins.sparse) == 0);
    twins.step(few_steps ? 60 : 300);
    twins.edit(pour(EditLayer::sand, 4, 4, 0.8));
    twins.edit(pour(EditLayer::water, 5, 4, 0.5));
    CHECK(twins.differ(few_steps ? 20 : 80, 2) == -1);
    CHECK(awake(*twins.sparse) > 0);
    CHECK(awake(*twins.sparse) < 1);
}

TEST_CASE("active tiles: snapshots, roll-back, regions and other material wake what they change") {
    Twins twins(pond_and_pile(), 8);
    for (World* world : {twins.dense.get(), twins.sparse.get()}) REQUIRE(world->roll_back().set(4, few_steps ? 10 : 50));
    twins.step(few_steps ? 15 : 300);
    CHECK(twins.equal());
    const auto sleeping = save(*twins.dense);
    CHECK(sleeping == save(*twins.sparse)); // the same bytes: a snapshot does not know of tiles
    twins.edit(pour(EditLayer::water, 24, 16, 0.5));
    twins.step(few_steps ? 5 : 50);
    CHECK(twins.equal());
    for (World* world : {twins.dense.get(), twins.sparse.get()}) REQUIRE(world->snapshots().load(sleeping));
    CHECK(twins.differ(few_steps ? 5 : 20) == -1);
    const std::uint64_t back = few_steps ? 12 : 60;
    twins.step(few_steps ? 20 : 200);
    for (World* world : {twins.dense.get(), twins.sparse.get()}) REQUIRE(world->roll_back().go_back(world->steps() - back));
    CHECK(twins.differ(few_steps ? 5 : 20) == -1);
    const std::vector<float> heights(40, 0.6F);
    for (World* world : {twins.dense.get(), twins.sparse.get()})
        REQUIRE(world->commands().write_region(EditLayer::water, {100, 60, 8, 5}, heights));
    CHECK(twins.differ(few_steps ? 5 : 30) == -1);
    for (World* world : {twins.dense.get(), twins.sparse.get()}) {
        const auto keys = material_keys();
        const auto key = std::find_if(keys.begin(), keys.end(), [](const auto& k) { return std::string(k.name) == "friction"; });
        REQUIRE(world->commands().set_material(static_cast<int>(key - keys.begin()), 0.1));
    }
    CHECK(twins.differ(few_steps ? 10 : 60, 2) == -1);
}

TEST_CASE("active tiles: sources, rain and sides that change with time wake their tiles in time" *
          doctest::test_suite("long")) { // the fuzzer has such worlds for the sanitizers
    auto scene = pond_and_pile();
    scene.settings.sources = {
        {SourceShape::disc, SourceMaterial::water, {20, 6}, 0.7, {}, {{{0, 0}, {1, 0}, {1.1, 0.2}, {2, 0}}}, true, {0.3, 0.1}},
        {SourceShape::point, SourceMaterial::sand, {28, 4}, 0, {}, {{{0, 0}, {3, 0}, {3.1, 0.4}, {4, 0}}}, false, {}}};
    scene.settings.rain = {{{4.5, 0}, {4.6, 1e-3}, {5, 0}}};
    auto& west = scene.settings.sides[SIDE_WEST];
    west.kind = SideKind::level;
    west.value = {{{0, -1}, {6, -1}, {6.5, 1.4}, {7, -1}}};
    auto& east = scene.settings.sides[SIDE_EAST];
    east.kind = SideKind::discharge;
    east.value = {{{0, 0}, {7.5, 0}, {8, 2}, {8.5, 0}}};
    scene.settings.sides[SIDE_NORTH].kind = SideKind::outflow;
    Twins twins(scene, 8);
    double least = 1;
    for (int n = 0; n < 70; ++n) {
        REQUIRE(twins.differ(10, 5) == -1);
        least = std::min(least, awake(*twins.sparse));
    }
    CHECK(least < 0.5);
}

TEST_CASE("active tiles: a world asleep submits nothing until something wakes it, on every backend") {
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto scene = flat_scene(60, 50, 0.2, 0.015);
        scene.settings.sources = {
            {SourceShape::disc, SourceMaterial::water, {6, 5}, 1, {}, {{{0, 0}, {1.2, 0}, {1.21, 0.5}, {1.3, 0}}}, false, {}}};
        Twins twins(scene, 8, {backend});
        if (!twins.sparse->device().capabilities().exact_float) continue;
        const auto submits = [&](int steps, bool parts = false) {
            const auto before = twins.sparse->device().counters().submits;
            for (int n = 0; n < steps; ++n) {
                if (parts) {
                    for (int part = 0; part < twins.sparse->stepper().parts(); ++part)
                        REQUIRE(twins.sparse->stepper().step_part());
                } else {
                    test::step(*twins.sparse, 1);
                }
                // As a host's frame does between two updates.
                REQUIRE(twins.sparse->device().wait({twins.sparse->device().counters().submits}));
                test::step(*twins.dense, 1);
            }
            return twins.sparse->device().counters().submits - before;
        };
        CHECK(submits(4) == 4);
        CHECK(submits(60) == 0);
        CHECK(submits(7, true) == 0);
        CHECK(submits(20) > 5); // the source begins at step 80
        CHECK(twins.equal());
        twins.step(10);
        CHECK(twins.equal());
    }
}

TEST_CASE("active tiles: steps in parts and profiled steps are the same steps") {
    Twins twins(pond_and_pile(), 8);
    const int steps = few_steps ? 8 : 30;
    REQUIRE(twins.sparse->stepper().set_profiling(true));
    twins.step(steps);
    REQUIRE(twins.sparse->stepper().set_profiling(false));
    for (int n = 0; n < steps; ++n) {
        for (int part = 0; part < twins.sparse->stepper().parts(); ++part) REQUIRE(twins.sparse->stepper().step_part());
        test::step(*twins.dense, 1);
        REQUIRE(twins.equal());
    }
}
