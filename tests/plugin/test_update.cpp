// wadi_world_update: host time cut into fixed steps, the same bits however frames fall, and what a frame costs the host.
#include "tests/plugin/plugin_world.hpp"
#include <algorithm>
#include <chrono>
#include <cstdio>

using namespace plugin_test;

namespace {

constexpr uint64_t second = 1000000000;

double microseconds(const std::chrono::steady_clock::duration& d) { return std::chrono::duration<double, std::micro>(d).count(); }

template <class Call> double best_microseconds(int repeats, Call call) {
    double best = 1e9;
    for (int n = 0; n < repeats; ++n) {
        const auto start = std::chrono::steady_clock::now();
        call();
        best = std::min(best, microseconds(std::chrono::steady_clock::now() - start));
    }
    return best;
}

void set(const World& world, uint32_t per_update, uint32_t in_flight, bool spread = false) {
    auto settings = wadi_default_update_settings();
    settings.max_steps_per_update = per_update;
    settings.max_steps_in_flight = in_flight;
    settings.spread = spread ? 1 : 0;
    REQUIRE_MESSAGE(wadi_world_set_update_settings(world.id, &settings) == WADI_OK, std::string(wadi_get_last_error()));
}

// Frames that add up to `total`: hz a second, or hz = 0 for frames of no order.
std::vector<uint64_t> frames(uint64_t total, uint64_t hz) {
    std::vector<uint64_t> all;
    uint64_t sum = 0, random = 12345;
    while (sum < total) {
        random = random * 6364136223846793005u + 1442695040888963407u;
        const uint64_t next = hz > 0 ? (all.size() + 1) * second / hz : sum + (random >> 33) % 40000000;
        all.push_back(std::min(next, total) - sum);
        sum += all.back();
    }
    return all;
}

} // namespace

TEST_CASE("the same total time gives the same bits at any frame rate, steps spread or not") {
    for (const auto& backend : backends()) {
        CAPTURE(backend);
        uint64_t plain;
        {
            const World world(backend);
            REQUIRE(wadi_world_step(world.id, 50) == WADI_OK);
            plain = world.stats().hash;
        }
        for (const bool spread : {false, true}) {
            for (const uint64_t hz : {15, 60, 144, 240, 0}) {
                if (backend != "cpu" && hz != 144 && hz != 0) continue; // pipelines anew for each world
                CAPTURE(spread);
                CAPTURE(hz);
                const World world(backend);
                set(world, 1024, 0, spread);
                uint64_t steps = 0;
                for (const uint64_t frame : frames(second / 2, hz)) {
                    const auto done = world.update(frame);
                    steps += done.steps;
                    CHECK(done.total_steps == steps);
                    CHECK(done.dropped_nanoseconds_total == 0);
                    CHECK(done.interpolation >= 0);
                    CHECK(done.interpolation < 1);
                }
                CHECK(steps == 50);
                CHECK(world.stats().hash == plain);
            }
        }
    }
}

TEST_CASE("after any frames the steps are floor(total / dt), and the interpolation is what is left") {
    const World world("cpu", 8, 8, 0.003);
    set(world, 1024, 0);
    uint64_t total = 0;
    wadi_frame done{};
    for (const uint64_t frame : frames(3 * second + 1234567, 0)) {
        total += frame;
        done = world.update(frame);
        CHECK(done.total_steps == total / 3000000);
    }
    CHECK(done.interpolation == doctest::Approx(static_cast<double>(total % 3000000) / 3e6));
    CHECK(done.time == doctest::Approx(0.003 * static_cast<double>(done.total_steps)));
    // One nanosecond before a boundary, and on it.
    const World edge("cpu", 8, 8, 0.01);
    CHECK(edge.update(9999999).total_steps == 0);
    CHECK(edge.update(0).steps == 0);
    CHECK(edge.update(1).total_steps == 1);
}

TEST_CASE("time beyond the steps of an update is dropped and reported to the nanosecond") {
    const World world("cpu", 8, 8, 0.01);
    set(world, 4, 0);
    auto frame = world.update(100000000); // ten steps: four are done, and time stops short of the fifth
    CHECK(frame.steps == 4);
    CHECK(frame.dropped_nanoseconds == 50000001);
    CHECK(frame.interpolation < 1);
    frame = world.update(1);
    CHECK(frame.steps == 1);
    CHECK(frame.dropped_nanoseconds == 0);
    CHECK(frame.dropped_nanoseconds_total == 50000001);
    uint64_t given = 100000001;
    for (const uint64_t each : frames(2 * second, 20)) {
        given += each;
        frame = world.update(each);
        CHECK(frame.total_steps == (given - frame.dropped_nanoseconds_total) / 10000000);
    }
    frame = world.update(UINT64_MAX);
    CHECK(frame.steps == 4);
    CHECK(frame.dropped_nanoseconds > UINT64_MAX - second);
    CHECK(world.update(UINT64_MAX).dropped_nanoseconds_total == UINT64_MAX);
    CHECK(world.update(0).steps == 0);
}

TEST_CASE("a read between the parts of a step finishes it, and the clock does not repeat it") {
    const World world("cpu"), plain("cpu");
    set(world, 8, 0, true);
    CHECK(world.update(7500000).total_steps == 0); // three of four parts
    const auto hash = world.stats().hash;          // of the step finished early
    CHECK(world.stats().steps == 1);
    auto frame = world.update(2500000);
    CHECK(frame.steps == 0);
    CHECK(frame.total_steps == 1);
    REQUIRE(wadi_world_step(plain.id, 1) == WADI_OK);
    CHECK(hash == plain.stats().hash);
    CHECK(world.update(6000000).total_steps == 1);
    REQUIRE(wadi_world_step(world.id, 2) == WADI_OK); // finishes the second step, then two beside the clock
    CHECK(world.stats().steps == 4);
    CHECK(world.update(4000000).total_steps == 4);
    CHECK(world.update(10000000).total_steps == 5);
    REQUIRE(wadi_world_step(plain.id, 4) == WADI_OK);
    CHECK(world.stats().hash == plain.stats().hash);
    // Spread switched off in the middle of a step.
    CHECK(world.update(7000000).total_steps == 5);
    set(world, 8, 0, false);
    CHECK(world.update(3000000).total_steps == 6);
    REQUIRE(wadi_world_step(plain.id, 1) == WADI_OK);
    CHECK(world.stats().hash == plain.stats().hash);
}

TEST_CASE("a device that is too slow costs dropped time, not waiting") {
    for (const auto& backend : backends()) {
        CAPTURE(backend);
        const World world(backend, 512, 512, 0.01);
        set(world, 8, 2);
        world.update(20000000); // the first steps, and whatever they make
        world.wait();
        uint64_t steps = world.stats().steps;
        double longest = 0;
        wadi_frame frame{};
        for (int n = 0; n < 20; ++n) {
            const auto start = std::chrono::steady_clock::now();
            frame = world.update(20000000);
            longest = std::max(longest, microseconds(std::chrono::steady_clock::now() - start));
            steps += frame.steps;
        }
        CHECK(frame.dropped_nanoseconds_total > 0);
        CHECK(frame.total_steps == steps);
        CHECK(frame.total_steps == (uint64_t{21} * 20000000 - frame.dropped_nanoseconds_total) / 10000000);
        const auto start = std::chrono::steady_clock::now();
        world.wait();
        const double wait = microseconds(std::chrono::steady_clock::now() - start);
        std::printf("%s 512^2: longest update with steps due %.0f us, the device then works %.0f us more\n", backend.c_str(),
                    longest, wait);
    }
}

TEST_CASE("update on the CPU backend returns at once: the steps run beside the host") {
    const World world("cpu", 512, 512, 0.01);
    world.update(10000000);
    world.wait();
    const double call = best_microseconds(5, [&] { world.update(10000000); });
    const double call_and_wait = best_microseconds(3, [&] {
        world.update(10000000);
        world.wait();
    });
    std::printf("cpu 512^2: update with one step %.1f us, step finished after %.0f us\n", call, call_and_wait);
    CHECK(call < call_and_wait / 5);
}

TEST_CASE("an update with no step due costs less than 5 us") {
    for (const auto& backend : backends()) {
        const World world(backend, 64, 64, 100.0);
        auto frame = wadi_default_frame();
        const double best = best_microseconds(20, [&] {
            for (int n = 0; n < 100; ++n) wadi_world_update(world.id, 1000, &frame);
        });
        std::printf("%s: update with no step due %.3f us\n", backend.c_str(), best / 100);
        CHECK(frame.total_steps == 0);
        CHECK(best / 100 < 5.0);
    }
}

TEST_CASE("update refuses bad worlds, sizes and settings, and stays as it was") {
    const World world("cpu");
    auto frame = wadi_default_frame();
    CHECK(wadi_world_update({0, 0}, 1, &frame) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_update(world.id, 1, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    frame.struct_size = 4;
    CHECK(wadi_world_update(world.id, second, &frame) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("struct_size"));
    CHECK(world.stats().steps == 0);
    const auto refused = [&](wadi_update_settings settings, const char* text) {
        CHECK(wadi_world_set_update_settings(world.id, &settings) == WADI_ERROR_BAD_ARGUMENT);
        CHECK_MESSAGE(error_mentions(text), std::string(wadi_get_last_error()));
    };
    auto settings = wadi_default_update_settings();
    settings.max_steps_per_update = 0;
    refused(settings, "1 ... 1024");
    settings = wadi_default_update_settings();
    settings.max_steps_in_flight = 65;
    refused(settings, "0 ... 64");
    settings = wadi_default_update_settings();
    settings.spread = 2;
    refused(settings, "spread");
    settings.struct_size = 0;
    refused(settings, "struct_size");
    CHECK(wadi_world_set_update_settings(world.id, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_set_update_settings({7, 7}, &settings) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(world.update(second).steps == 8); // the defaults still hold
}
