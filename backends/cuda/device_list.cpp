#include "backends/cuda/device_list.hpp"
#include "backends/cuda/errors.hpp"
#include <algorithm>
#include <cstring>

namespace wadi::cuda {
namespace {

// Compute capabilities, from WADI_CUDA_ARCHITECTURES in CMake.
const std::vector<int> machine_code = {WADI_CUDA_SASS};
const std::vector<int> portable_code = {WADI_CUDA_PTX};

// Machine code runs on its own generation from its own minor version on; PTX on everything not older.
bool has_code(int capability) {
    const auto runs = [capability](int built) { return built / 10 == capability / 10 && built <= capability; };
    const auto compiles = [capability](int built) { return built <= capability; };
    return std::any_of(machine_code.begin(), machine_code.end(), runs) ||
           std::any_of(portable_code.begin(), portable_code.end(), compiles);
}

std::string built_for() {
    std::string list;
    for (const int c : machine_code) list += (list.empty() ? "" : ", ") + capability_text(c);
    for (const int c : portable_code) list += (list.empty() ? "" : ", ") + capability_text(c) + " and newer";
    return list;
}

std::string no_driver_reason(cudaError_t result) {
    int driver = 0;
    const cudaError_t asked = cudaDriverGetVersion(&driver);
    if (asked == cudaSuccess && driver == 0) return "no NVIDIA driver with CUDA on this machine";
    if (result == cudaErrorInsufficientDriver) {
        return "the NVIDIA driver is for CUDA " + version_text(driver) + ", this build needs one for CUDA " +
               version_text(CUDART_VERSION) + " or newer";
    }
    return error_text(result);
}

} // namespace

std::vector<ListedDevice> list_devices(std::string& why_none) {
    int count = 0;
    if (const cudaError_t r = cudaGetDeviceCount(&count); r != cudaSuccess) {
        static_cast<void>(cudaGetLastError()); // the runtime would report it again later
        why_none = no_driver_reason(r);
        return {};
    }
    why_none = "no NVIDIA GPU";
    std::vector<ListedDevice> list;
    for (int ordinal = 0; ordinal < count; ++ordinal) {
        cudaDeviceProp properties{};
        if (const cudaError_t r = cudaGetDeviceProperties(&properties, ordinal); r != cudaSuccess) {
            static_cast<void>(cudaGetLastError());
            why_none = "GPU " + std::to_string(ordinal) + ": " + error_text(r);
            continue;
        }
        const int capability = 10 * properties.major + properties.minor;
        if (!has_code(capability)) {
            why_none = std::string(properties.name) + " has compute capability " + capability_text(capability) +
                       "; this build has code for " + built_for();
            continue;
        }
        const auto kind = properties.integrated != 0 ? compute::DeviceKind::integrated_gpu : compute::DeviceKind::discrete_gpu;
        compute::DeviceUuid uuid{};
        std::memcpy(uuid.data(), properties.uuid.bytes, uuid.size());
        list.push_back({ordinal,
                        capability,
                        uuid,
                        {"cuda", static_cast<int>(list.size()), properties.name, kind, properties.totalGlobalMem}});
    }
    return list;
}

} // namespace wadi::cuda
