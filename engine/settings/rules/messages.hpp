// Words and numbers of error messages: the nearest known name, numbers as people write them.
#pragma once
#include "engine/settings/data/settings.hpp"
#include <string>
#include <vector>

namespace wadi {

/// At most six significant digits: 0.045, 1e+06.
std::string number_text(double value);

/// Three significant digits of a positive value, rounded down: a limit that may be typed as it stands.
std::string at_most(double value);
/// The same rounded up.
std::string at_least(double value);

/// "dt <= x s", so that the water's substeps take `most` seconds at most each.
std::string longest_dt(const Settings& settings, double most);
/// ", or method.water_substeps N", which keep dt; empty where that takes more than there can be.
std::string or_water_substeps(const Settings& settings, double most);

/// "path: value is outside least ... most".
std::string outside_text(const std::string& path, double value, double least, double most);

/// Single-character insertions, deletions, replacements and swaps of neighbours that turn one word into the other.
int edit_distance(const std::string& a, const std::string& b);

/// ", did you mean "x"?" for the nearest of `known` if one is close, else "; known: a, b, c".
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

} // namespace wadi
