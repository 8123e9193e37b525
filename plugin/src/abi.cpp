#include "plugin/src/abi.hpp"
#include <string_view>

namespace wadi::plugin {

namespace {

// Fixed room without a destructor: hosts keep the pointer, and call from destructors that run after those of the thread's
// variables.
constexpr std::size_t most = 1024;
thread_local char newest[most] = "";

// A file may have a word of megabytes: of a long text its begin and its end.
void keep(std::string_view head, std::string_view message) {
    constexpr std::string_view between = " ... ";
    auto add = [used = std::size_t{0}](std::string_view part) mutable {
        std::memcpy(newest + used, part.data(), part.size());
        newest[used += part.size()] = 0;
    };
    const std::size_t room = most - 1 - head.size();
    add(head);
    if (message.size() <= room) return add(message);
    const std::size_t half = (room - between.size()) / 2;
    add(message.substr(0, half));
    add(between);
    add(message.substr(message.size() - half));
}

} // namespace

const char* last_error() { return newest; }

wadi_result report_out_of_memory(const char* function) noexcept {
    keep(function, ": out of memory");
    return WADI_ERROR_OUT_OF_MEMORY;
}

wadi_result report(const Status& status) {
    if (!status) keep("", status.message);
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
