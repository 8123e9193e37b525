#include "plugin/abi.hpp"

namespace wadi::plugin {

namespace {

thread_local std::string last;

} // namespace

const std::string& last_error() { return last; }

wadi_result report_out_of_memory(const char* function) noexcept {
    try {
        last = std::string(function) + ": out of memory";
    } catch (const std::bad_alloc&) {
        last.clear();
    }
    return WADI_ERROR_OUT_OF_MEMORY;
}

wadi_result report(const Status& status) {
    last = status ? std::string() : status.message;
    switch (status.code) {
    case Code::ok:
        return WADI_OK;
    case Code::bad_argument:
        return WADI_ERROR_BAD_ARGUMENT;
    case Code::not_found:
        return WADI_ERROR_NOT_FOUND;
    case Code::bad_file:
        return WADI_ERROR_BAD_FILE;
    case Code::not_supported:
        return WADI_ERROR_NOT_SUPPORTED;
    case Code::out_of_memory:
        return WADI_ERROR_OUT_OF_MEMORY;
    case Code::device_lost:
        return WADI_ERROR_DEVICE_LOST;
    case Code::internal:
        return WADI_ERROR_INTERNAL;
    case Code::not_ready:
        return WADI_NOT_READY;
    case Code::busy:
        return WADI_ERROR_BUSY;
    }
    return WADI_ERROR_INTERNAL;
}

} // namespace wadi::plugin
