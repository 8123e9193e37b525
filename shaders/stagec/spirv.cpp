#include "writers.hpp"
#include <cstdint>
#include <sstream>

namespace stagec {

static std::vector<std::uint32_t> read_words(const std::string& path) {
    const std::string bytes = read_text(path);
    if (bytes.size() < 20 || bytes.size() % 4 != 0) fail(path + ": not a SPIR-V module");
    std::vector<std::uint32_t> words(bytes.size() / 4);
    for (std::size_t i = 0; i < words.size(); ++i) {
        std::uint32_t w = 0;
        for (std::size_t b = 4; b-- > 0;) w = w << 8 | static_cast<unsigned char>(bytes[4 * i + b]);
        words[i] = w;
    }
    if (words[0] != 0x07230203u) fail(path + ": wrong SPIR-V magic number");
    return words;
}

// `precise` in glslang 12 does not reach through function calls, so the finished module is decorated instead:
// every float arithmetic result id gets NoContraction, ahead of the first type declaration.
void write_nocontract(const std::string& in, const std::string& out) {
    const auto words = read_words(in);
    std::vector<std::uint32_t> decorations;
    std::size_t first_type = 0;
    for (std::size_t at = 5; at < words.size();) {
        const std::uint32_t op = words[at] & 0xffffu, length = words[at] >> 16;
        if (length == 0 || at + length > words.size()) fail(in + ": broken instruction");
        if (first_type == 0 && op >= 19 && op <= 39) first_type = at;
        const bool arithmetic = op == 127 || op == 129 || op == 131 || op == 133 || op == 136 || (op >= 140 && op <= 148);
        if (arithmetic) decorations.insert(decorations.end(), {(3u << 16) | 71u, words[at + 2], 42u});
        at += length;
    }
    if (first_type == 0) fail(in + ": no types");
    std::vector<std::uint32_t> result(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(first_type));
    result.insert(result.end(), decorations.begin(), decorations.end());
    result.insert(result.end(), words.begin() + static_cast<std::ptrdiff_t>(first_type), words.end());
    std::string bytes;
    for (const std::uint32_t w : result) {
        for (int b = 0; b < 4; ++b) bytes += static_cast<char>(w >> (8 * b) & 0xffu);
    }
    write_bytes(out, bytes);
}

std::string word_list(const std::string& module) {
    std::ostringstream o;
    int column = 0;
    for (const std::uint32_t w : read_words(module)) o << (column++ % 12 == 0 ? "\n    " : " ") << w << "u,";
    return o.str();
}

} // namespace stagec
