// Rain by a map: how it is told to the stages (NUMERICS 2.9).
#pragma once
#include "engine/settings/data/settings.hpp"
#include <vector>

namespace wadi {

/// Whether the world has a map of rain, its effect on.
bool rain_is_mapped(const Settings& settings);
/// How many times `rain` falls where it rains most; 1 without a map.
double rain_peak(const Settings& settings);
/// Of that, the share of each cell in 1/65536, in the order of the map; all of it without one.
std::vector<float> rain_shares(const Settings& settings);

} // namespace wadi
