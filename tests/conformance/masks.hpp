// Which masks each stage can tell apart, and effect masks as text.
#pragma once
#include "engine/compute/status.hpp"
#include <cstdint>
#include <string>
#include <vector>

namespace wadi::conformance {

/// "water+sand+mixture", or "none".
std::string effects_text(std::uint32_t mask);
/// The inverse; the mask must be legal. Errors: bad_argument.
Result<std::uint32_t> parse_effects(const std::string& text);

/// For a stage of the table: one whole mask per set of tested effects that some legal mask gives it, the smallest such mask,
/// in increasing order. A stage that no step plan holds (publish_*, mark_limits) sees every legal mask.
std::vector<std::uint32_t> stage_masks(int stage);

} // namespace wadi::conformance
