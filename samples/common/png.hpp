// PNG files of 8-bit RGB pixels.
#pragma once
#include <cstdint>
#include <string>

namespace common {

/// width * height pixels of three bytes, row 0 on top, as the bytes of a PNG file; empty when memory runs out.
std::string encode_png(const std::uint8_t* rgb, int width, int height);

} // namespace common
