#include "backends/vulkan/float_modes.hpp"
#include <algorithm>
#include <string_view>

namespace wadi::vulkan {
namespace {

// Numbers of the SPIR-V specification.
constexpr std::uint32_t op_extension = 10, op_execution_mode = 16, op_capability = 17, op_function = 54;
constexpr std::uint32_t preserve_mode = 4461, preserve_capability = 4466;
constexpr std::size_t header_words = 5;

// Characters lie in words from the lowest byte on, whatever the machine's order.
bool names_float_controls(std::span<const std::uint32_t> text) {
    constexpr std::string_view name("SPV_KHR_float_controls\0", 23);
    for (std::size_t n = 0; n < name.size(); ++n) {
        if (n / 4 >= text.size() || static_cast<char>(text[n / 4] >> (8 * (n % 4)) & 0xffu) != name[n]) return false;
    }
    return true;
}

bool asks(std::span<const std::uint32_t> instruction) {
    switch (instruction[0] & 0xffffu) {
    case op_capability:
        return instruction.size() > 1 && instruction[1] == preserve_capability;
    case op_extension:
        return names_float_controls(instruction.subspan(1));
    case op_execution_mode:
        return instruction.size() > 2 && instruction[2] == preserve_mode;
    default:
        return false;
    }
}

} // namespace

std::vector<std::uint32_t> without_float_modes(std::span<const std::uint32_t> spirv) {
    std::vector<std::uint32_t> kept(spirv.begin(),
                                    spirv.begin() + static_cast<std::ptrdiff_t>(std::min(header_words, spirv.size())));
    kept.reserve(spirv.size());
    for (std::size_t at = header_words; at < spirv.size();) {
        const std::size_t length = std::min<std::size_t>(spirv[at] >> 16, spirv.size() - at);
        // All of that stands ahead of the first function; a length of 0 is no SPIR-V, which the driver is to see as it is.
        if (length == 0 || (spirv[at] & 0xffffu) == op_function) {
            kept.insert(kept.end(), spirv.begin() + static_cast<std::ptrdiff_t>(at), spirv.end());
            break;
        }
        const auto instruction = spirv.subspan(at, length);
        if (!asks(instruction)) kept.insert(kept.end(), instruction.begin(), instruction.end());
        at += length;
    }
    return kept;
}

} // namespace wadi::vulkan
