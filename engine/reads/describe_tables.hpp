// The engine's tables as text: what pages and the schema of levels are compared with.
#pragma once
#include "engine/compute/status.hpp"
#include <string>

namespace wadi {

/// Markdown of "settings", "effects" or "fields", plain text of "stages", or JSON of the settings in "schema". Errors: not_found.
Result<std::string> describe_table(const std::string& name);

} // namespace wadi
