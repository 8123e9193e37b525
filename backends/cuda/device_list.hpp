// The NVIDIA GPUs that this build has code for.
#pragma once
#include "backends/common/backend.hpp"

namespace wadi::cuda {

struct ListedDevice {
    int ordinal = 0;    // as CUDA counts, which also counts devices that are left out here
    int capability = 0; // 10 x major + minor
    compute::DeviceUuid uuid{};
    backends::DeviceInfo info;
};

/// In CUDA's order, the fastest first. Empty with a reason in `why_none`.
std::vector<ListedDevice> list_devices(std::string& why_none);

} // namespace wadi::cuda
