// StepClock against exact division, for periods that are no whole number of nanoseconds.
#include "engine/frames/step_clock.hpp"
#include <cmath>
#include <doctest/doctest.h>
#include <initializer_list>

using wadi::StepClock;

TEST_CASE("steps are floor(total / dt) for any dt and any frames") {
    for (const double dt : {1e-7, 1.0 / 60, 1.0 / 3, 0.001, 0.0123456789, 1.7e-6, 100.0}) {
        CAPTURE(dt);
        StepClock clock(dt);
        const long double period = static_cast<long double>(dt * 1e9);
        std::uint64_t total = 0, steps = 0, random = 99;
        for (int n = 0; n < 20000; ++n) {
            random = random * 6364136223846793005u + 1442695040888963407u;
            const auto frame = static_cast<std::uint64_t>(static_cast<double>(random >> 40) / 1e7 * dt * 1e9);
            total += frame;
            CHECK(clock.add(frame) == 0);
            for (; clock.due(); ++steps) clock.take();
            const auto wanted = static_cast<std::uint64_t>(static_cast<long double>(total) / period);
            REQUIRE(steps == wanted);
            const auto share = static_cast<double>(static_cast<long double>(total) / period - static_cast<long double>(wanted));
            REQUIRE(std::abs(clock.share_of_step() - share) < 1e-6);
        }
    }
}

TEST_CASE("time taken back is as if it had not come, whatever steps it had brought") {
    StepClock clock(0.01), other(0.01);
    CHECK(clock.add(14'000'000) + other.add(14'000'000) == 0);
    clock.take();
    other.take();
    clock.take_back(3'000'000); // less than is held
    CHECK(clock.add(3'000'000) == 0);
    CHECK(clock.share_of_step() == other.share_of_step());
    CHECK(clock.add(27'000'000) == 0); // 31 ms: three steps, of which one was taken when the update failed
    clock.take();
    clock.take_back(27'000'000);
    CHECK_FALSE(clock.due());
    CHECK(clock.add(27'000'000) == 0);
    CHECK(other.add(27'000'000) == 0);
    other.take();
    int left = 0;
    for (; clock.due(); ++left) {
        clock.take();
        other.take();
    }
    CHECK(left == 2);
    CHECK(clock.share_of_step() == other.share_of_step());
}

TEST_CASE("dropped time leaves the clock a nanosecond before the next step") {
    StepClock clock(1.0 / 60);
    CHECK(clock.add(100000000) == 0);
    CHECK(clock.drop() == 100000000 - 16666666);
    CHECK_FALSE(clock.due());
    CHECK(clock.share_of_step() < 1);
    CHECK(clock.drop() == 0);
    CHECK(clock.add(1) == 0);
    CHECK(clock.due());
    clock.take();
    CHECK(clock.share_of_step() < 1e-6);
    CHECK(clock.add(~std::uint64_t{0}) > 0);
    CHECK(clock.due());
    CHECK(clock.drop() > (std::uint64_t{1} << 61));
    CHECK_FALSE(clock.due());
}
