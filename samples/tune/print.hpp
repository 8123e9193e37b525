// What was found, as text for people and as JSON for programs.
#pragma once
#include "tuner.hpp"

namespace tune {

/// One sentence: the settings, their cost and their error.
std::string conclusion(const std::string& level_name, const Level& level, const Request& request, const Outcome& outcome);
std::string report(const Level& level, const Request& request, const Outcome& outcome);
Json report_json(const std::string& level_name, const Level& level, const Request& request, const Outcome& outcome);

} // namespace tune
