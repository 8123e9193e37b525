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

// `precise` in glslang 12 does not reach through function calls, so the finished module is changed instead. Contraction is off
// where every float result is decorated. What else a driver calls fast math, which takes no zero for negative and no value for
// infinite, is off where the entry point says so: MoltenVK turns Metal's off for such modules alone.
void write_strict(const std::string& in, const std::string& out) {
    constexpr std::uint32_t no_contraction = 42, preserve_mode = 4461, preserve_capability = 4466;
    const auto words = read_words(in);
    std::vector<std::uint32_t> modes, decorations;
    std::size_t behind_capabilities = 0, behind_entries = 0, first_type = 0;
    for (std::size_t at = 5; at < words.size();) {
        const std::uint32_t op = words[at] & 0xffffu, length = words[at] >> 16;
        if (length == 0 || at + length > words.size()) fail(in + ": broken instruction");
        if (op == 17) behind_capabilities = at + length;
        if (op == 15) {
            behind_entries = at + length;
            modes.insert(modes.end(), {(4u << 16) | 16u, words[at + 2], preserve_mode, 32u}); // of floats of 32 bits
        }
        if (first_type == 0 && op >= 19 && op <= 39) first_type = at;
        const bool arithmetic = op == 127 || op == 129 || op == 131 || op == 133 || op == 136 || (op >= 140 && op <= 148);
        if (arithmetic) decorations.insert(decorations.end(), {(3u << 16) | 71u, words[at + 2], no_contraction});
        at += length;
    }
    if (behind_capabilities == 0 || behind_entries == 0 || first_type == 0) fail(in + ": no capability, entry point or type");
    // An extension in SPIR-V 1.3, which is Vulkan 1.1's. Its name fills words from the lowest byte on, up to a zero.
    std::vector<std::uint32_t> declared = {(2u << 16) | 17u, preserve_capability, (7u << 16) | 10u};
    std::string name = "SPV_KHR_float_controls";
    name.resize(24);
    for (std::size_t c = 0; c < name.size(); ++c) {
        if (c % 4 == 0) declared.push_back(0);
        declared.back() |= static_cast<std::uint32_t>(name[c]) << (8 * (c % 4));
    }
    std::vector<std::uint32_t> result;
    std::size_t copied = 0;
    const auto insert = [&](std::size_t at, const std::vector<std::uint32_t>& more) {
        result.insert(result.end(), words.begin() + static_cast<std::ptrdiff_t>(copied),
                      words.begin() + static_cast<std::ptrdiff_t>(at));
        result.insert(result.end(), more.begin(), more.end());
        copied = at;
    };
    insert(behind_capabilities, declared);
    insert(behind_entries, modes);
    insert(first_type, decorations);
    insert(words.size(), {});
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
