// Whether settings and fields are what a world can be made of.
#pragma once
#include "engine/compute/status.hpp"
#include "engine/settings/data/settings.hpp"

namespace wadi {

/// Checks every number; the message names the field as the level file writes it, its value and its range.
Status validate(const Settings& settings);
Status validate(const Material& material);
/// A source in a world of these settings; `path` begins the message.
Status check_source(const Settings& settings, const Source& source, const std::string& path);
/// Checks sizes and finiteness (the message gives the first bad cell), non-negative depths, the declared largest height; of the
/// settings their roughness.
Status validate(const InitialFields& fields, const Settings& settings);

} // namespace wadi
