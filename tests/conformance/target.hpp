// The devices under test: which there are, opened once and shared by the cases.
#pragma once
#include "backends/registry.hpp"
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace wadi::conformance {

/// One device of one backend.
struct Target {
    const backends::Backend* backend = nullptr;
    backends::DeviceInfo info;
    std::string label() const { return info.backend + std::to_string(info.index); } // "vulkan0"
};

/// Every device of every backend of this build.
std::vector<Target> all_targets();

/// A target opened for testing, with what it logged.
class Session {
  public:
    Session(Target target, const compute::DeviceOptions& options);

    const Target& target() const { return target_; }
    const compute::DeviceOptions& options() const { return options_; }

    /// The shared device, opened at the first call. Errors: those of Backend::open.
    Result<compute::Device*> device();
    /// A device that forwards to the shared one, for a World to own.
    Result<std::unique_ptr<compute::Device>> borrow();
    /// A device of its own: for tests that lose or count, and for other options.
    Result<std::unique_ptr<compute::Device>> fresh(compute::DeviceOptions options);
    /// Drops the shared device; the next use opens it again.
    void close() { device_.reset(); }

    /// Warnings and errors that devices of this session logged since the last call.
    std::vector<std::string> take_messages();

  private:
    Target target_;
    compute::DeviceOptions options_;
    std::shared_ptr<std::vector<std::string>> messages_;
    std::unique_ptr<compute::Device> device_;
};

/// The CPU backend's plainest form, against which all others are compared in bits: base instruction set, one thread.
Result<std::unique_ptr<compute::Device>> open_plain_cpu();

} // namespace wadi::conformance
