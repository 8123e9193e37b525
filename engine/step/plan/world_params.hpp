// From settings in SI units to the scalars that stages read: every derived constant is computed once, here, in double.
#pragma once
#include "engine/settings/data/settings.hpp"
#include "shaders/params.hpp"

namespace wadi {

/// What the ledger counts in: Q, or the quantum that would have been chosen where Q is 0.
double ledger_quantum(const Method& method);

/// The velocity clamp [m/s] for k = dt/dx [s/m].
float velocity_limit(const Method& method, double k);

/// effects: the mask of those that are on. Balance (NUMERICS 2.20) counts on no others: without drag water takes nothing along,
/// without retention pores hold nothing back.
WorldParams derive_params(const Settings& settings, std::uint32_t effects);

} // namespace wadi
