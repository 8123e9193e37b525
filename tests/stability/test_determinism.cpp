// Same input, same bits: runs, threads, instruction sets, replay, interleaved worlds, barriers everywhere, and backends.
#include "backends/registry.hpp"
#include "tests/support/worlds.hpp"
#include <cmath>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

std::uint64_t run(const Scene& scene, int steps, const Target& target = {}) {
    auto world = make_world(scene, target);
    step(*world, steps);
    return hash_of(*world);
}

Target cpu(int threads, const std::string& set = "") {
    Target target;
    target.options.threads = threads;
    target.options.instruction_set = set;
    return target;
}

} // namespace

TEST_CASE("runs, thread counts and instruction sets agree in every bit") {
    const auto scene = mixed_scene(160, 130);
    const int steps = few_steps ? 6 : 60;
    const auto expected = run(scene, steps, cpu(1));
    for (const int threads : {1, 2, 3, 8}) {
        CAPTURE(threads);
        CHECK(run(scene, steps, cpu(threads)) == expected);
    }
    int sets = 0;
    for (const std::string set : {"base", "avx2", "avx512"}) {
        auto device = backends::open_device("cpu", 0, cpu(2, set).options);
        if (device) {
            CAPTURE(set);
            CHECK(run(scene, steps, cpu(2, set)) == expected);
            ++sets;
        } else {
            CHECK(device.status().message.find("no instruction set '" + set) != std::string::npos);
            MESSAGE(device.status().message);
        }
    }
    CHECK(sets >= 1);
    CHECK(!backends::open_device("cpu", 0, cpu(2, "mmx").options));
    auto changed = scene;
    changed.fields.water[0] += 1e-4F;
    CHECK(run(changed, steps) != expected);
}

TEST_CASE("two worlds interleaved give what each gives alone") {
    const auto a = mixed_scene(64, 50), b = mixed_scene(50, 64);
    auto first = make_world(a), second = make_world(b);
    for (int n = 0; n < 30; ++n) {
        step(*first, 1);
        step(*second, 1);
    }
    CHECK(hash_of(*first) == run(a, 30));
    CHECK(hash_of(*second) == run(b, 30));
}

TEST_CASE("barriers everywhere, recording anew and profiling change no bit, on every backend") {
    const auto scene = mixed_scene(48, 40);
    const auto expected = run(scene, 20);
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        Target full{backend}, anew{backend};
        full.options.full_barriers = true;
        anew.options.no_replay = true;
        CHECK(run(scene, 20, {backend}) == expected);
        CHECK(run(scene, 20, full) == expected);
        CHECK(run(scene, 20, anew) == expected);
        auto profiled = make_world(scene, {backend});
        REQUIRE(profiled->stepper().set_profiling(true));
        step(*profiled, 20);
        CHECK(hash_of(*profiled) == expected);
        auto times = profiled->stepper().stage_times();
        REQUIRE(times);
        CHECK(times->size() == 16);
        for (const auto& time : *times) CHECK_MESSAGE(time.milliseconds > 0, time.stage);
    }
}

TEST_CASE("group sizes change no bit, on every backend") {
    const auto scene = mixed_scene(70, 37);
    const auto expected = run(scene, 20);
    for (const auto& backend : available_backends()) {
        for (const auto& group : {compute::GroupSize{64, 1}, {32, 8}, {8, 8}, {16, 4}, {128, 2}}) {
            CAPTURE(backend);
            CAPTURE(group.x);
            CHECK(run(scene, 20, {backend, {}, group}) == expected);
        }
    }
}

TEST_CASE("pipelines specialised for a scene's mask give the bits of pipelines with every effect compiled in") {
    auto water = flat_scene(60, 50, 0.2, 0.015);
    water.fill(water.fields.terrain, [](double x, double y) { return 0.2 * std::sin(x) * std::cos(y) + 0.3; });
    water.fill(water.fields.water, [](double x, double) { return x < 5 ? 1.0 : 0.0; });
    auto dry = flat_scene(60, 50, 0.2, 0.015);
    dry.fill(dry.fields.sand, [](double x, double y) { return std::hypot(x - 6, y - 5) < 2 ? 1.0 : 0.0; });
    for (auto scene : {water, dry}) {
        const auto lean = run(scene, 100);
        auto lean_world = make_world(scene);
        for (const char* name : {"water", "sand", "mixture", "diffusion", "drag", "elastoplastic", "cohesion"})
            scene.settings.effects.push_back({name, Force::on});
        // Cohesion reads the saturation; with no water anywhere it is 0, as without the effect.
        auto full_world = make_world(scene);
        CHECK(full_world->plan().water_passes.size() > lean_world->plan().water_passes.size());
        step(*lean_world, 100);
        step(*full_world, 100);
        CHECK(hash_of(*lean_world) == lean);
        for (const auto& field : state_of(*lean_world)) {
            const auto full = full_world->reader().read_raw(field.first);
            REQUIRE(full);
            CHECK_MESSAGE(*full == field.second, field.first);
        }
    }
}

TEST_CASE("saved, stepped on, restored and stepped again: the same bits, on every backend and across them") {
    auto scene = mixed_scene(48, 40);
    scene.settings.sources = {{SourceShape::disc, SourceMaterial::water, {4, 3}, 1, {}, {{{0, 0.333}}}, false, {}}};
    scene.settings.rain = {{{0, 1.7e-5}}};
    for (int n = 0; n < 48 * 40; ++n) scene.settings.rain_map.push_back(0.125F * static_cast<float>(n % 97));
    const auto expected = run(scene, 45);
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto world = make_world(scene, {backend});
        step(*world, 25);
        const auto saved = save(*world);
        step(*world, 20);
        CHECK(hash_of(*world) == expected);
        REQUIRE(world->snapshots().load(saved));
        CHECK(world->steps() == 25);
        step(*world, 20);
        CHECK(hash_of(*world) == expected);
        auto other = make_world(scene); // on the CPU
        step(*other, 3);
        REQUIRE(other->snapshots().load(saved));
        step(*other, 20);
        CHECK(hash_of(*other) == expected);
        auto stats = other->reader().stats();
        REQUIRE(stats);
        CHECK(stats->water_quanta == stats->water_initial + stats->ledger.water_in - stats->ledger.water_out);
        CHECK(make_world(mixed_scene(48, 41))->snapshots().load(saved).code == Code::bad_argument);
    }
}

TEST_CASE("nothing is allocated, written to descriptors or recorded per step, on every backend") {
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto world = make_world(mixed_scene(32, 32), {backend});
        step(*world, 2);
        const auto before = world->device().counters();
        for (int n = 0; n < 30; ++n) step(*world, 1);
        const auto after = world->device().counters();
        CHECK(after.submits == before.submits + 30);
        CHECK(after.allocations == before.allocations);
        CHECK(after.descriptor_writes == before.descriptor_writes);
        CHECK(after.recordings == before.recordings);
        step(*world, 16); // runs of steps are recorded when the first is taken
        const auto first_run = world->device().counters();
        step(*world, 32);
        const auto runs = world->device().counters();
        CHECK(runs.submits == first_run.submits + 4);
        CHECK(runs.allocations == first_run.allocations);
        CHECK(runs.descriptor_writes == first_run.descriptor_writes);
        CHECK(runs.recordings == first_run.recordings);
    }
}

TEST_CASE(
    "every backend equals the CPU in every bit after 40 coupled steps of the shipped levels, without a validation message") {
    for (const auto& backend : available_backends()) {
        if (backend == "cpu") continue;
        for (const auto& [name, nx, ny] : {std::tuple{"canyon", 80, 102}, {"piles", 96, 64}, {"dam_break", 64, 64}}) {
            const std::string scene_name = name;
            CAPTURE(backend);
            CAPTURE(scene_name);
            auto scene = shipped_level(name, nx, ny);
            Target checked{backend};
            checked.options.validate = backend == "vulkan";
            std::string messages;
            checked.options.log = [&](int severity, const std::string& message) {
                messages += severity < 2 ? message + "\n" : std::string();
            };
            // Validation layers are a development package: a machine with a real GPU may lack them.
            const auto device = backends::open_device(backend, -1, checked.options);
            if (device.status().code == Code::not_supported) {
                MESSAGE("no validation layers here: " << backend << " runs unchecked");
                checked.options.validate = false;
            }
            if (scene_name == "dam_break" && device && (*device)->capabilities().fused_stages) {
                scene.settings.fused_stages = FusedStages::always;
                scene.settings.active_tiles = 16;
            }
            auto world = make_world(scene, checked);
            if (!world->device().capabilities().exact_float) {
                MESSAGE("the device fails the exact-float self-test: bits are not compared");
                continue;
            }
            step(*world, 40);
            CHECK(hash_of(*world) == run(scene, 40));
            CHECK_MESSAGE(world->device().counters().validation_messages == 0, messages);
        }
    }
}

TEST_CASE("a lost device is reported by every call, and only by worlds on it") {
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto world = make_world(mixed_scene(16, 16), {backend}), other = make_world(mixed_scene(16, 16), {backend});
        step(*world, 3);
        const auto saved = save(*world);
        std::vector<std::string> errors;
        REQUIRE(world->set_log([&](int severity, const std::string& message) {
            if (severity == 0) errors.push_back(message);
        }));
        world->device().inject_device_lost();
        CHECK(world->step(1).code == Code::device_lost);
        CHECK(world->reader().stats().status().code == Code::device_lost);
        std::vector<float> cells(256);
        CHECK(world->reader().read("water_height", cells).code == Code::device_lost);
        REQUIRE(errors.size() == 1); // told once
        CHECK(errors[0].starts_with("step 3: "));
        // The last snapshot survives the device.
        REQUIRE(other->snapshots().load(saved));
        step(*other, 1);
        CHECK(hash_of(*other) == run(mixed_scene(16, 16), 4));
    }
}
