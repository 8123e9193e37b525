#include "engine/compute/device.hpp"

namespace wadi::compute {

Status Device::no_host_sync() const {
    return error(Code::not_supported,
                 "the backend " + capabilities().backend + " has no semaphores or command buffers of a host");
}

} // namespace wadi::compute
