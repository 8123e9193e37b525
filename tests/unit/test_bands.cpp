// engine/threads: work shared among threads, and levels that load to the same bits whatever the number.
#include "engine/level/level.hpp"
#include "engine/settings/data/quanta.hpp"
#include "engine/threads/bands.hpp"
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <dlfcn.h>
#include <doctest/doctest.h>
#include <filesystem>
#include <limits>
#include <pthread.h>
#include <random>
#include <set>
#include <stdexcept>
#include <thread>

using namespace wadi;

namespace {

std::atomic<int> threads_to_refuse{0};
std::atomic<int> threads_refused{0};

} // namespace

// Stands ahead of the C library's, so that the system refuses threads when a test says so.
extern "C" __attribute__((visibility("default"))) int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                                                                     void* (*run)(void*), void* argument) {
    if (threads_to_refuse > 0) {
        --threads_to_refuse;
        ++threads_refused;
        return EAGAIN;
    }
    static const auto create = reinterpret_cast<decltype(&pthread_create)>(dlsym(RTLD_NEXT, "pthread_create"));
    return create(thread, attributes, run, argument);
}

namespace {

const char* const SHIPPED[] = {"beach",   "canyon", "castle",  "dam_break", "flush",
                               "letters", "piles",  "seepage", "spring",    "wadi"};

Level shipped_level(const std::string& name, int threads) {
    const ThreadLimit limit(threads);
    LevelOverrides overrides;
    overrides.size = {350, 290}; // more than one band, and no multiple of one
    auto level = load_level(std::string(WADI_SOURCE_DIR "/samples/levels/") + name + "/level.json", overrides);
    REQUIRE_MESSAGE(level, level.status().message);
    return *level;
}

void check_same_level(const Level& a, const Level& b, const std::string& name) {
    const auto same = [](const std::vector<float>& x, const std::vector<float>& y) {
        return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0);
    };
    CHECK_MESSAGE(same(a.fields.terrain, b.fields.terrain), name);
    CHECK_MESSAGE(same(a.fields.sand, b.fields.sand), name);
    CHECK_MESSAGE(same(a.fields.water, b.fields.water), name);
    CHECK_MESSAGE(same(a.fields.velocity_x, b.fields.velocity_x), name);
    CHECK_MESSAGE(same(a.fields.sand_velocity_x, b.fields.sand_velocity_x), name);
    CHECK_MESSAGE(same(a.settings.roughness, b.settings.roughness), name);
    CHECK_MESSAGE(a.warnings == b.warnings, name);
}

/// Threads that work at the same time, out of `count` that wait for each other.
std::size_t threads_together(std::size_t count, int patience_ms) {
    std::atomic<std::size_t> arrived{0};
    in_bands(count, 1, [&](std::size_t, std::size_t, std::size_t) {
        ++arrived;
        const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(patience_ms);
        while (arrived < count && std::chrono::steady_clock::now() < end) std::this_thread::yield();
        if (arrived < count) throw std::runtime_error("alone");
    });
    return arrived;
}

} // namespace

TEST_CASE("bands: each item once, bands alike, whatever the limit") {
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{99}, std::size_t{100}, std::size_t{101}}) {
            std::vector<int> seen(count), number(bands_of(count, 10));
            in_bands(count, 10, [&](std::size_t n, std::size_t begin, std::size_t end) {
                CHECK(begin == n * 10);
                CHECK(end == std::min(count, begin + 10));
                ++number[n];
                for (std::size_t item = begin; item < end; ++item) ++seen[item];
            });
            CHECK(seen == std::vector<int>(count, 1));
            CHECK(number == std::vector<int>(number.size(), 1));
        }
    }
}

TEST_CASE("bands: as many threads as the limit says, one within a band") {
    const ThreadLimit three(3);
    CHECK(threads_together(3, 30000) == 3);
    {
        const ThreadLimit one(1);
        CHECK_THROWS_WITH(threads_together(2, 100), "alone");
    }
    CHECK(threads_together(3, 30000) == 3); // the limit before is back
    std::atomic<int> inner_alone{0};
    in_bands(3, 1, [&](std::size_t, std::size_t, std::size_t) {
        std::set<std::thread::id> inner; // one thread writes it, or the thread sanitizer tells
        in_bands(8, 1, [&](std::size_t, std::size_t, std::size_t) { inner.insert(std::this_thread::get_id()); });
        if (inner == std::set{std::this_thread::get_id()}) ++inner_alone;
    });
    CHECK(inner_alone >= 2); // of three bands the caller's may share its own
}

TEST_CASE("bands: an exception ends the work and comes through") {
    for (const int threads : {1, 4}) {
        const ThreadLimit limit(threads);
        std::atomic<std::size_t> done{0};
        CHECK_THROWS_AS(in_bands(100, 1,
                                 [&](std::size_t n, std::size_t, std::size_t) {
                                     if (n == 5) throw std::bad_alloc();
                                     ++done;
                                 }),
                        std::bad_alloc);
        if (threads == 1) CHECK(done == 5);
    }
}

TEST_CASE("bands: the first cell, whatever thread finds another first") {
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        CHECK(first_cell(10 * CELL_BAND, [](std::size_t cell) { return cell > 3 * CELL_BAND + 17; }) == 3 * CELL_BAND + 18);
        CHECK(first_cell(2 * CELL_BAND + 1, [](std::size_t) { return false; }) == 2 * CELL_BAND + 1);
        CHECK(first_cell(0, [](std::size_t) { return true; }) == 0);
    }
}

TEST_CASE("bands: levels load to the same bits on one thread and on several") {
    for (const char* name : SHIPPED) {
        const Level serial = shipped_level(name, 1);
        check_same_level(serial, shipped_level(name, 2), name);
        check_same_level(serial, shipped_level(name, 5), name);
    }
}

TEST_CASE("bands: threads that the system refuses are done without") {
    const Level serial = shipped_level("canyon", 1);
    for (const int refused : {1, 1000000}) { // all after a few, and all
        threads_refused = 0;
        threads_to_refuse = refused;
        const Level level = shipped_level("canyon", 4);
        threads_to_refuse = 0;
        CHECK(threads_refused > 0);
        check_same_level(serial, level, "canyon");
    }
    const ThreadLimit limit(4);
    threads_to_refuse = 1000000;
    std::size_t items = 0; // one thread writes it
    in_bands(100, 1, [&](std::size_t, std::size_t, std::size_t) { ++items; });
    threads_to_refuse = 0;
    CHECK(items == 100);
}

TEST_CASE("quanta: halves go away from zero as std::round says") {
    std::mt19937_64 random(11);
    std::vector<double> values = {0.0,
                                  -0.0,
                                  0.5,
                                  -0.5,
                                  0.49999999999999994,
                                  -0.49999999999999994,
                                  1.5,
                                  2.5,
                                  -2.5,
                                  4503599627370495.5,
                                  4503599627370496.0,
                                  -4503599627370495.5,
                                  9007199254740993.0,
                                  1e300,
                                  -1e300,
                                  5e-324,
                                  std::numeric_limits<double>::infinity(),
                                  -std::numeric_limits<double>::infinity()};
    for (int n = 0; n < 200000; ++n) {
        std::uint64_t bits = random();
        double value = 0;
        std::memcpy(&value, &bits, sizeof value);
        if (!std::isnan(value)) values.push_back(value);
        const double half = static_cast<double>(static_cast<std::int64_t>(bits >> (12 + n % 50))) / 2;
        values.insert(values.end(), {half, -half, std::nextafter(half, 0.0), std::nextafter(half, 1e300)});
    }
    for (const double value : values) {
        const double is = round_away(value), must = std::round(value);
        if (std::memcmp(&is, &must, sizeof is) == 0) continue;
        CHECK_MESSAGE(false, value << " becomes " << is);
        break;
    }
    CHECK(std::isnan(round_away(std::numeric_limits<double>::quiet_NaN())));
}
