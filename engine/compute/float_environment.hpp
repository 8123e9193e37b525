// The floating-point environment that the library's own arithmetic runs in, whatever its host left behind.
#pragma once
#include <cfenv>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace wadi::compute {

/// While it lives, this thread rounds to nearest, keeps denormal numbers and traps nothing; then it is again as it was, flags
/// included. At the top of every call from a host, around every call of one, and in every thread, so that neither bits nor the
/// process depend on the host's settings (C11, 7.6).
class DefaultFloats {
  public:
    DefaultFloats() noexcept {
        std::fegetenv(&before_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~DefaultFloats() { std::fesetenv(&before_); }
    DefaultFloats(const DefaultFloats&) = delete;
    DefaultFloats& operator=(const DefaultFloats&) = delete;

  private:
    std::fenv_t before_;
};

/// While it lives, and where it is on, this thread takes denormal numbers for 0 and makes none, as some GPUs' float units do
/// (NVIDIA's under Vulkan), on processors that can. So tests find without a GPU what hangs on a number below 1.2e-38.
class FlushedDenormals {
  public:
    explicit FlushedDenormals(bool on) noexcept : on_(on) {
        if (!on_) return;
        before_ = control();
        set_control(before_ | flush_bits);
    }
    ~FlushedDenormals() {
        if (on_) set_control(before_);
    }
    FlushedDenormals(const FlushedDenormals&) = delete;
    FlushedDenormals& operator=(const FlushedDenormals&) = delete;

  private:
#if defined(__SSE__)
    using Control = unsigned;
    static constexpr Control flush_bits = 0x8040; // of results and of operands
    static Control control() { return _mm_getcsr(); }
    static void set_control(Control value) { _mm_setcsr(value); }
#elif defined(__aarch64__) && defined(__GNUC__)
    using Control = unsigned long long;
    static constexpr Control flush_bits = 1ull << 24;
    static Control control() {
        Control value = 0;
        asm volatile("mrs %0, fpcr" : "=r"(value));
        return value;
    }
    static void set_control(Control value) { asm volatile("msr fpcr, %0" : : "r"(value)); }
#else
    using Control = unsigned;
    static constexpr Control flush_bits = 0;
    static Control control() { return 0; }
    static void set_control(Control) {}
#endif
    bool on_;
    Control before_ = 0;
};

} // namespace wadi::compute
