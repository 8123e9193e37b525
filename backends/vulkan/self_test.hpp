// The start-up self-test: does this device compute + - * / and sqrt as the CPU does, and by which division?
#pragma once
#include "backends/vulkan/memory.hpp"

namespace wadi::vulkan {

/// Runs self_test.comp with native and, if that differs, with corrected division and root. Sets corrected_division and
/// capabilities.exact_float; when neither is exact the device runs with native ones, and a warning says so.
Status run_self_test(Context& context, OneTimeCommands& once, Transfers& transfers);

} // namespace wadi::vulkan
