// Numbers of text files.
#pragma once
#include <charconv>
#include <string>
#include <string_view>
#if !defined(__cpp_lib_to_chars)
#include <locale>
#include <sstream>
#endif

namespace wadi {

/// The whole of `text` as a number, in whatever locale; false where it is none or out of a double's range.
inline bool parse_number(std::string_view text, double& number) {
#if defined(__cpp_lib_to_chars)
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
    return parsed.ec == std::errc{} && parsed.ptr == text.data() + text.size();
#else // LLVM's library before version 20
    if (text.empty() || text.front() == '+' || text.front() == ' ') return false;
    std::istringstream words{std::string(text)};
    words.imbue(std::locale::classic());
    return (words >> number) && words.peek() == std::istringstream::traits_type::eof();
#endif
}

} // namespace wadi
