// The CUDA backend: NVIDIA GPUs.
#pragma once
#include "engine/compute/device.hpp"

namespace wadi::cuda {

const compute::Backend& cuda_backend();

} // namespace wadi::cuda
