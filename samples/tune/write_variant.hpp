// Settings as a variant in a level's file, of which all else keeps its text.
#pragma once
#include "level.hpp"

namespace tune {

/// The merge patch of a variant that has the settings, and what the level's chosen variant has, if any.
Json variant_of(const Level& level, const Settings& settings);

/// The level's text with one more variant; comments and layout stay. Throws BadInput where the level has one of that name or the
/// name is none.
std::string with_variant(const Level& level, const std::string& name, const Json& patch);

/// Whether a level names maps or series, which must lie beside its file.
bool names_files(const Json& json);

} // namespace tune
