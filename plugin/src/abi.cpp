#include "plugin/src/abi.hpp"
#include <string_view>

namespace wadi::plugin {

namespace {

// Fixed room without a destructor: hosts keep the pointer, and call from destructors that run after those of the thread's
// variables.
constexpr std::size_t most = 1024;
thread_local char newest[most] = "";

// Within a character of several bytes in UTF-8.
bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U; }

// A file may have a word of megabytes: of a long text its begin and its end.
void keep(std::string_view head, std::string_view message) {
    constexpr std::string_view between = " ... ";
    auto add = [used = std::size_t{0}](std::string_view part) mutable {
        std::memcpy(newest + used, part.data(), part.size());
        make_printable({newest + used, part.size()});
        newest[used += part.size()] = 0;
    };
    const std::size_t room = most - 1 - head.size();
    add(head);
    if (message.size() <= room) return add(message);
    const std::size_t half = (room - between.size()) / 2;
    add(message.substr(0, whole_characters(message, half)));
    add(between);
    std::string_view end = message.substr(message.size() - half);
    while (!end.empty() && continues(end.front())) end.remove_prefix(1);
    add(end);
}

} // namespace

std::size_t whole_characters(std::string_view text, std::size_t most_bytes) {
    if (text.size() <= most_bytes) return text.size();
    while (most_bytes > 0 && continues(text[most_bytes])) --most_bytes;
    return most_bytes;
}

void make_printable(std::span<char> text) {
    for (std::size_t n = 0; n < text.size(); ++n) {
        const auto c = static_cast<unsigned char>(text[n]);
        const auto next = n + 1 < text.size() ? static_cast<unsigned char>(text[n + 1]) : 0U;
        if (c < 0x20 || c == 0x7f) text[n] = ' ';
        if (c == 0xc2 && next >= 0x80 && next < 0xa0) text[n] = text[n + 1] = ' '; // U+0080 ... U+009F: control characters, too
    }
}

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
    case Code::cancelled:
        return WADI_CANCELLED;
    }
    return WADI_ERROR_INTERNAL;
}

} // namespace wadi::plugin
