// The CUDA backend: NVIDIA GPUs.
#pragma once
#include "backends/common/backend.hpp"

namespace wadi::cuda {

const backends::Backend& cuda_backend();

} // namespace wadi::cuda
