#include "backends/cuda/driver.hpp"
#include "backends/cuda/errors.hpp"

namespace wadi::cuda {
namespace {

// The version whose form of the calls the declarations above have: cuda.h maps them to it by macros.
constexpr unsigned declared_version = 12000;

template <class Call> Status find(const char* name, Call& call) {
    void* entry = nullptr;
    cudaDriverEntryPointQueryResult found = cudaDriverEntryPointSymbolNotFound;
    const cudaError_t r = cudaGetDriverEntryPointByVersion(name, &entry, declared_version, cudaEnableDefault, &found);
    if (r != cudaSuccess) return error(Code::not_supported, std::string("the NVIDIA driver's ") + name + ": " + error_text(r));
    if (found != cudaDriverEntryPointSuccess || entry == nullptr) {
        return error(Code::not_supported, std::string("the NVIDIA driver has no ") + name);
    }
    call = reinterpret_cast<Call>(entry);
    return ok_status();
}

} // namespace

Result<Driver> load_driver() {
    Driver driver;
    if (Status s = find("cuDeviceGet", driver.device_get); !s) return s;
    if (Status s = find("cuDevicePrimaryCtxRetain", driver.retain_primary_context); !s) return s;
    if (Status s = find("cuDevicePrimaryCtxRelease", driver.release_primary_context); !s) return s;
    if (Status s = find("cuCtxPushCurrent", driver.push_context); !s) return s;
    if (Status s = find("cuCtxPopCurrent", driver.pop_context); !s) return s;
    if (Status s = find("cuMemsetD32Async", driver.fill_words); !s) return s;
    return driver;
}

} // namespace wadi::cuda
