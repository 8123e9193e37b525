#include "engine/compute/status.hpp"

namespace wadi {

const char* code_name(Code code) {
    switch (code) {
    case Code::ok:
        return "ok";
    case Code::bad_argument:
        return "bad_argument";
    case Code::not_found:
        return "not_found";
    case Code::bad_file:
        return "bad_file";
    case Code::not_supported:
        return "not_supported";
    case Code::out_of_memory:
        return "out_of_memory";
    case Code::device_lost:
        return "device_lost";
    case Code::internal:
        return "internal";
    case Code::not_ready:
        return "not_ready";
    case Code::busy:
        return "busy";
    case Code::cancelled:
        return "cancelled";
    }
    return "unknown";
}

} // namespace wadi
