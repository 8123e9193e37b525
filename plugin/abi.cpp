#include "plugin/abi.hpp"

namespace wadi::plugin {

namespace {

// A host may call from destructors that run after those of its thread's variables: then errors have no text.
thread_local bool text_gone = false;
struct LastError {
    std::string text;
    ~LastError() { text_gone = true; }
};
thread_local LastError last;

// A file may have a word of megabytes: of a long text its begin and its end.
std::string shown(const std::string& message) {
    constexpr std::size_t most = 1000;
    return message.size() <= most ? message : message.substr(0, most / 2) + " ... " + message.substr(message.size() - most / 2);
}

} // namespace

const char* last_error() { return text_gone ? "" : last.text.c_str(); }

wadi_result report_out_of_memory(const char* function) noexcept {
    if (text_gone) return WADI_ERROR_OUT_OF_MEMORY;
    try {
        last.text = std::string(function) + ": out of memory";
    } catch (const std::bad_alloc&) {
        last.text.clear();
    }
    return WADI_ERROR_OUT_OF_MEMORY;
}

wadi_result report(const Status& status) {
    if (!text_gone) last.text = status ? std::string() : shown(status.message);
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
