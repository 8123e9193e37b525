#include "engine/compute/host_sync.hpp"

namespace wadi::compute {

Status no_host_sync(const std::string& backend) {
    return error(Code::not_supported, "the backend " + backend + " has no semaphores or command buffers of a host");
}

} // namespace wadi::compute
