// Costs between the C interface and the engine.
#pragma once
#include "engine/settings/rules/cost.hpp"
#include "plugin/src/abi.hpp"

namespace wadi::plugin {

/// Writes to a host's struct; a null or odd one is bad_argument.
wadi_result give_cost(const char* function, const Result<Cost>& cost, wadi_cost* to);
/// A host's limits, copied.
Result<Cost> to_cost(const std::string& what, const wadi_cost* from);

} // namespace wadi::plugin
