// JPEG files of 8-bit RGB pixels, for pictures that pages show.
#pragma once
#include <cstdint>
#include <string>

namespace common {

/// width * height pixels of three bytes, row 0 on top, as the bytes of a JPEG file.
std::string encode_jpeg(const std::uint8_t* rgb, int width, int height);

} // namespace common
