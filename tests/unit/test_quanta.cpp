#include "engine/step/quanta.hpp"
#include <doctest/doctest.h>
#include <limits>

using namespace wadi;

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
