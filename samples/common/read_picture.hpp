// PNG and JPEG files as pixels.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

namespace common {

/// A picture's pixels, row 0 on top. The readers throw std::runtime_error: no such file, no picture, or more than `most` pixels
/// along a side.
struct Pixels {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};
Pixels read_pixels(const std::filesystem::path& file, int most);

struct Grey {
    int width = 0, height = 0;
    std::vector<std::uint16_t> values; // 0 black, 65535 white; those of 8 bits times 257
};
Grey read_grey(const std::filesystem::path& file, int most);

} // namespace common
