// The clock of Godot's node, without Godot.
#include "plugin/godot/source/scene/due.h"
#include <doctest/doctest.h>
#include <initializer_list>
#include <limits>

TEST_CASE("a time scale that overshoots for some ticks does not spoil the clock of Godot's node") {
    constexpr double tick = 1.0 / 60, infinite = std::numeric_limits<double>::infinity();
    for (const double odd : {-1.0, infinite, -infinite, std::numeric_limits<double>::quiet_NaN(), 1e30, -1e30}) {
        CAPTURE(odd);
        double left = 0.25;
        const auto take = [&](double scale) {
            const double due = due_nanoseconds(tick, scale, left);
            REQUIRE(due >= 0);
            REQUIRE(due < 0x1p63); // or the cast does not fit
            const auto nanoseconds = static_cast<std::uint64_t>(due);
            left = due - static_cast<double>(nanoseconds);
            return nanoseconds;
        };
        for (int n = 0; n < 5; ++n) take(odd);
        std::uint64_t second = 0;
        for (int n = 0; n < 60; ++n) second += take(1);
        CHECK(second >= 999999999);
        CHECK(second <= 1000000001);
    }
}
