// What a backend tells the registry: its name, its devices, and how to open one.
#pragma once
#include "engine/compute/device.hpp"

namespace wadi::backends {

/// One device that a backend can open.
struct DeviceInfo {
    std::string backend;
    int index = 0; // within its backend
    std::string name;
    compute::DeviceKind kind = compute::DeviceKind::cpu;
    std::uint64_t memory_bytes = 0;
};

struct Backend {
    const char* name;
    /// No loader, driver or device is an empty list and a reason. Like all three calls here it may throw std::bad_alloc.
    std::vector<DeviceInfo> (*enumerate)(std::string& why_none);
    Result<std::unique_ptr<compute::Device>> (*open)(int index, const compute::DeviceOptions& options);
    /// Lends from the host's device (DeviceOptions::host), on which this backend can run. Null: it cannot. Errors: not_supported.
    Result<std::shared_ptr<compute::Lender>> (*lend)(const compute::DeviceOptions& options) = nullptr;
    /// Runs beside a host's device, with what another backend lends from it (DeviceOptions::lender).
    bool borrows = false;
};

} // namespace wadi::backends
