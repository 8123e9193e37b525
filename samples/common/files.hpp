// Files that are either whole or absent.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace common {

/// Writes to a temporary name beside `path` and renames. Returns an empty string, or what went wrong.
std::string write_file(const std::filesystem::path& path, std::string_view bytes);

/// A field as the bytes of an NPY file (version 1.0): little-endian float32, shape (ny, nx), row 0 = south.
std::string encode_npy(const std::vector<float>& values, int nx, int ny);

} // namespace common
