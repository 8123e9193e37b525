#include "backends/cuda/backend.hpp"
#include "backends/cuda/device.hpp"
#include "backends/cuda/device_list.hpp"

namespace wadi::cuda {
namespace {

std::vector<backends::DeviceInfo> enumerate(std::string& why_none) {
    std::vector<backends::DeviceInfo> list;
    for (ListedDevice& device : list_devices(why_none)) list.push_back(std::move(device.info));
    return list;
}

} // namespace

const backends::Backend& cuda_backend() {
    static const backends::Backend backend{"cuda", enumerate, open_device, nullptr, true};
    return backend;
}

} // namespace wadi::cuda
