#include "engine/compute/host_sync.hpp"

namespace wadi::compute {

Status no_host_sync(const std::string& backend, const char* what) {
    return error(Code::not_supported, "a world of the backend " + backend + " knows no " + what + " of a host");
}

} // namespace wadi::compute
