// Pictures as files.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace viewer {

/// RGBA pixels, first row on top, as a JPEG where the file ends in .jpg, else as an RGB PNG; written under a temporary name and
/// renamed. Throws std::runtime_error.
void write_picture(const std::filesystem::path& file, const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height);

/// "frame_00012.png"
std::string numbered(const char* prefix, uint64_t number, const char* ending = "png");

} // namespace viewer
