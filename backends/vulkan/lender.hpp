// Buffers and semaphores of the host's device for CUDA (engine/compute/lender.hpp).
#pragma once
#include "engine/compute/device.hpp"

namespace wadi::vulkan {

/// Errors: not_supported (the host's device lacks VK_KHR_external_memory_fd, VK_KHR_external_semaphore_fd or timeline
/// semaphores), bad_argument (a null handle).
Result<std::shared_ptr<compute::Lender>> lend(const compute::DeviceOptions& options);

} // namespace wadi::vulkan
