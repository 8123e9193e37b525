// From settings in SI units to the scalars that stages read: every derived constant is computed once, here, in double.
#pragma once
#include "engine/compute/params.hpp"
#include "engine/include/wadi/settings.hpp"

namespace wadi {

/// What the ledger counts in: Q, or the quantum that would have been chosen where Q is 0.
double ledger_quantum(const Method& method);

WorldParams derive_params(const Settings& settings);

} // namespace wadi
