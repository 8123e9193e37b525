// Advice on streams that will run faster than the time step lets them.
#pragma once
#include "engine/level/level.hpp"

namespace wadi {

/// Warns of sources and discharges whose water, once it has come to the speed at which its bed holds it on the way down, meets
/// the velocity clamp.
void warn_streams(const Settings& settings, const InitialFields& fields, std::vector<std::string>& warnings);

} // namespace wadi
