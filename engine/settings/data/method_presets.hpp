// Wadi's own method, which is the default, and the paper's, by name.
#pragma once
#include "engine/settings/data/settings.hpp"
#include <string>
#include <vector>

namespace wadi {

/// "robust", the default, and "published": as level files, --method and the plugin's override write them.
const std::vector<std::string>& method_names();

/// Sets method.name and everything that tells the methods apart, of the material the laws that the paper has not: its slopes,
/// inner friction and retention. What a scene needs of either (substeps, largest_height, dry_threshold) stays. An unknown name
/// sets the name alone, for validate() to refuse.
void choose_method(Settings& settings, const std::string& name);

} // namespace wadi
