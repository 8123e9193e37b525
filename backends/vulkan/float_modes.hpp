// Takes out of a module what not every device lets it ask for.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace wadi::vulkan {

/// The module without SignedZeroInfNanPreserve, which "stagec strict" declares: capability, extension SPV_KHR_float_controls and
/// the mode of each entry point. All else is kept, word by word.
std::vector<std::uint32_t> without_float_modes(std::span<const std::uint32_t> spirv);

} // namespace wadi::vulkan
