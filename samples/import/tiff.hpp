// GeoTIFF and TIFF of heights.
#pragma once
#include "heights.hpp"

namespace import_map {

/// By the tags of GeoTIFF and GDAL; degrees become metres. Ends the program where the file is no map.
Heights read_tiff(const std::string& name);

} // namespace import_map
