// Which level a snapshot or a command log belongs to.
#pragma once
#include "engine/settings/data/settings.hpp"

namespace wadi {

/// 64 bits over everything in the settings that steps depend on, the effects left out.
std::uint64_t level_digest(const Settings& settings);

} // namespace wadi
