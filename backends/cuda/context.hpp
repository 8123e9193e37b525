// What every component of the backend shares: the device's primary context, one stream, and how results become Status.
#pragma once
#include "backends/cuda/driver.hpp"
#include "backends/cuda/errors.hpp"
#include "engine/compute/device.hpp"
#include <memory>
#include <string_view>

namespace wadi::cuda {

struct Context {
    /// Errors: not_found (no such device), not_supported, out_of_memory, device_lost.
    static Result<std::unique_ptr<Context>> open(int index, const compute::DeviceOptions& options);
    Context() = default;
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Turns a result into a Status: "what of 'label': cudaError... (text)". A lost device is remembered for ever.
    Status check(cudaError_t result, std::string_view what, std::string_view label = {});
    /// For results of the driver: its numbers and the runtime's are the same.
    Status check(CUresult result, std::string_view what) { return check(static_cast<cudaError_t>(result), what); }
    /// Where nobody can be told by a Status (destructors): logs a failure.
    void note(cudaError_t result, std::string_view what, std::string_view label = {});
    void lose(std::string reason);
    Status lost_status() const;
    /// Waits until the stream has nothing left to do; a lost device counts as done.
    void wait_idle();
    void log(int severity, const std::string& message) const;

    Driver driver;
    CUdevice device = 0;
    CUcontext context = nullptr; // the primary context, shared with all other CUDA code of this process
    cudaStream_t stream = nullptr;
    bool lost = false;
    std::string lost_reason;
    compute::DeviceOptions options;
    compute::Capabilities capabilities;
    compute::Tuning tuning;
    compute::DeviceCounters counters;
};

/// Makes the device's context the calling thread's own for a scope and then gives the thread back what it had: a host that
/// uses CUDA itself must find its context unchanged. May be nested.
class CurrentContext {
  public:
    explicit CurrentContext(Context& context);
    ~CurrentContext();
    CurrentContext(const CurrentContext&) = delete;
    CurrentContext& operator=(const CurrentContext&) = delete;

  private:
    Context& c_;
    const bool pushed_;
};

} // namespace wadi::cuda
