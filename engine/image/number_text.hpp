// Numbers in text files.
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

/// The shortest text that parse_number gives the same number for, in whatever locale.
inline std::string number_text(double number) {
#if defined(__cpp_lib_to_chars)
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, number).ptr};
#else
    std::string text;
    double again = 0;
    for (int digits = 1; digits <= 17; ++digits) {
        std::ostringstream words;
        words.imbue(std::locale::classic());
        words.precision(digits);
        words << number;
        text = words.str();
        if (parse_number(text, again) && again == number) break;
    }
    return text;
#endif
}

} // namespace wadi
