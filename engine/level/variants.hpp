// A level's variants: named changes to the file itself, so that one level compares materials, methods or effects.
#pragma once
#include "engine/compute/status.hpp"
#include "engine/level/json_reader.hpp"
#include <optional>

namespace wadi {

/// Takes "variants" out of a level's JSON and merges the wanted one in (JSON Merge Patch, RFC 7396: objects are merged, null
/// removes a key, everything else replaces). The names in the order of the alphabet. Errors: bad_file (a variant that is no
/// object, or changes format_version, name or variants), bad_argument (no such variant, naming those there are).
Result<std::vector<std::string>> take_variant(Json& level, const std::optional<std::string>& wanted);

} // namespace wadi
