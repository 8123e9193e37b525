// Advice on sources that bring more than a cell takes.
#pragma once
#include "engine/settings/data/settings.hpp"
#include <string>
#include <vector>

namespace wadi {

/// Warns of sources whose discharge, shared by the cells that they cover, is beyond RATE_MOST.
void warn_discharges(const Settings& settings, std::vector<std::string>& warnings);

} // namespace wadi
