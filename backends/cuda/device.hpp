// compute::Device over the components of this backend.
#pragma once
#include "engine/compute/device.hpp"

namespace wadi::cuda {

/// Opens device `index` of the backend's list (-1 = the first) and runs the self-test.
Result<std::unique_ptr<compute::Device>> open_device(int index, const compute::DeviceOptions& options);

} // namespace wadi::cuda
