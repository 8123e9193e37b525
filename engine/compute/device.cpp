#include "engine/compute/device.hpp"

namespace wadi::compute {

Status Device::no_host_sync(std::size_t points) const {
    if (points == 0) return ok_status();
    return error(Code::not_supported,
                 "the backend " + capabilities().backend + " has no semaphores or command buffers of a host");
}

} // namespace wadi::compute
