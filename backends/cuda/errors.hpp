// What CUDA's results mean to the engine.
#pragma once
#include "engine/compute/status.hpp"
#include <cuda_runtime_api.h>
#include <string>

namespace wadi::cuda {

/// device_lost for everything after which CUDA refuses all further work in this process.
Code code_of(cudaError_t result);

/// "cudaErrorMemoryAllocation (out of memory)"
std::string error_text(cudaError_t result);

/// "12.5" for 12050
std::string version_text(int version);

/// "9.0" for 90
std::string capability_text(int capability);

} // namespace wadi::cuda
