// The few calls of the driver that the runtime has no equal for, found at run time so that nothing links the driver.
#pragma once
#include "engine/compute/status.hpp"
#include <cuda.h>

namespace wadi::cuda {

struct Driver {
    decltype(&cuDeviceGet) device_get = nullptr;
    decltype(&cuDevicePrimaryCtxRetain) retain_primary_context = nullptr;
    decltype(&cuDevicePrimaryCtxRelease) release_primary_context = nullptr;
    decltype(&cuCtxPushCurrent) push_context = nullptr;
    decltype(&cuCtxPopCurrent) pop_context = nullptr;
    decltype(&cuMemsetD32Async) fill_words = nullptr;
};

/// Errors: not_supported.
Result<Driver> load_driver();

} // namespace wadi::cuda
