// What the backend asks of the compiler about the processor, beyond the language.
#pragma once
#include <atomic>
#include <cstdint>
#include <string_view>
#if defined(_MSC_VER)
#include <intrin.h>
#elif defined(__x86_64__)
#include <cpuid.h>
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

#if defined(__x86_64__)
/// Whether the processor has all of the bits of `features` (CPUID leaf 7, EBX) and the system keeps the registers of `kept` (XCR0). The
/// compilers' own __builtin_cpu_supports asks a library that not every toolchain brings: zig's says no to all of it.
inline bool has_extension(std::uint32_t features, std::uint32_t kept) {
    std::uint32_t a = 0, b = 0, c = 0, d = 0;
    constexpr std::uint32_t OSXSAVE = 1u << 27;
    if (__get_cpuid(1, &a, &b, &c, &d) == 0 || (c & OSXSAVE) == 0) return false;
    std::uint32_t low = 0, high = 0;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    if ((low & kept) != kept) return false;
    return __get_cpuid_count(7, 0, &a, &b, &c, &d) != 0 && (b & features) == features;
}
#endif

/// Whether processor and system have the set of instructions, by the names in shaders/CMakeLists.txt.
inline bool has_instructions(std::string_view set) {
#if defined(__x86_64__)
    constexpr std::uint32_t AVX2 = 1u << 5, AVX512F = 1u << 16, AVX512DQ = 1u << 17, AVX512BW = 1u << 30, AVX512VL = 1u << 31;
    constexpr std::uint32_t XMM_YMM = 6u, ZMM = 0xe0u;
    if (set == "avx2") return has_extension(AVX2, XMM_YMM);
    if (set == "avx512") return has_extension(AVX512F | AVX512DQ | AVX512BW | AVX512VL, XMM_YMM | ZMM);
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
