#include "engine/settings/data/quanta.hpp"
#include <doctest/doctest.h>
#include <limits>

using namespace wadi;

TEST_CASE("heights round to the nearest quantum, halves as asked, and stay as they are without one") {
    const double quantum = 0x1p-13;
    for (const auto halves : {Halves::even, Halves::away}) {
        CHECK(nearest_quantum(1.4 * quantum, quantum, halves) == quantum);
        CHECK(nearest_quantum(-1.6 * quantum, quantum, halves) == -2 * quantum);
        CHECK(nearest_quantum(1.4 * quantum, 0, halves) == 1.4 * quantum);
    }
    CHECK(nearest_quantum(2.5 * quantum, quantum, Halves::even) == 2 * quantum);
    CHECK(nearest_quantum(2.5 * quantum, quantum, Halves::away) == 3 * quantum);
    CHECK(nearest_quantum(-2.5 * quantum, quantum, Halves::away) == -3 * quantum);
}

TEST_CASE("counts of quanta round to the nearest and stop at their largest instead of overflowing") {
    const double quantum = 0x1p-13;
    CHECK(to_quanta(1.0, quantum) == 8192);
    CHECK(to_quanta(1.4 * quantum, quantum) == 1);
    CHECK(to_quanta(-1.6 * quantum, quantum) == -2);
    CHECK(to_quanta(3e38, quantum) == MOST_QUANTA);
    CHECK(to_quanta(-3e38, quantum) == -MOST_QUANTA);
    CHECK(to_quanta(std::numeric_limits<double>::quiet_NaN(), quantum) == 0);
    CHECK(add_quanta(5, -7) == -2);
    CHECK(add_quanta(MOST_QUANTA, 1) == MOST_QUANTA);
    CHECK(add_quanta(-MOST_QUANTA, -MOST_QUANTA) == -MOST_QUANTA);
    CHECK(add_quanta(std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()) == 0);
}
