// What the processor can do, asked of it and of the compiler's library.
#include <doctest/doctest.h>

#include "backends/cpu/processor.hpp"

using wadi::cpu::has_instructions;

TEST_CASE("processor: instruction sets are those that the compiler's library finds") {
    CHECK(has_instructions("base"));
    CHECK(!has_instructions("avx3"));
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
    CHECK(has_instructions("avx2") == (__builtin_cpu_supports("avx2") != 0));
    CHECK(has_instructions("avx512") == (__builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
                                         __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512dq") != 0));
    CHECK(wadi::cpu::has_extension(0, 0)); // asks for nothing
    CHECK(!wadi::cpu::has_extension(0, 1u << 31)); // no system keeps these registers
#endif
}
