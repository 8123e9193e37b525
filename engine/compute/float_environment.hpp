// The floating-point environment that the library's own arithmetic runs in, whatever its host left behind.
#pragma once
#include <cfenv>

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

} // namespace wadi::compute
