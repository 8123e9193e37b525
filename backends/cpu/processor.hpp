// What the backend asks of the compiler about the processor, beyond the language.
#pragma once
#include <atomic>
#include <cstdint>
#include <string_view>
#if defined(_MSC_VER)
#include <intrin.h>
#endif

namespace wadi::cpu {

/// Tells the processor that this thread spins.
inline void pause() {
#if defined(_MSC_VER) && defined(_M_X64)
    _mm_pause();
#elif defined(__x86_64__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ volatile("yield");
#endif
}

/// Whether processor and system have the set of instructions, by the names in shaders/CMakeLists.txt.
inline bool has_instructions(std::string_view set) {
#if defined(__x86_64__)
    if (set == "avx2") return __builtin_cpu_supports("avx2") != 0;
    if (set == "avx512")
        return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
               __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512dq") != 0;
#endif
    return set == "base";
}

/// A number in plain memory that several threads write; std::atomic_ref, where the library has it.
class SharedNumber {
  public:
    explicit SharedNumber(std::uint32_t& number) : number_(number) {}
#if defined(__cpp_lib_atomic_ref)
    std::uint32_t load() const { return std::atomic_ref(number_).load(std::memory_order_relaxed); }
    void store(std::uint32_t value) const { std::atomic_ref(number_).store(value, std::memory_order_relaxed); }
#else
    std::uint32_t load() const { return __atomic_load_n(&number_, __ATOMIC_RELAXED); }
    void store(std::uint32_t value) const { __atomic_store_n(&number_, value, __ATOMIC_RELAXED); }
#endif

  private:
    std::uint32_t& number_;
};

} // namespace wadi::cpu
