// OpenEXR pictures of heights, as terrain tools write them.
#pragma once
#include "heights.hpp"

namespace import_map {

/// Metres, as they are, of the channel Y, else R, else the first. Ends the program where the file is none of one part in rows.
Heights read_exr(const std::string& name);

} // namespace import_map
