// Snapshots in files. A file is written under a temporary name and renamed: whoever finds it finds it whole.
#pragma once
#include "engine/compute/status.hpp"
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace wadi {

/// Replaces `path`. Errors: not_found (the folder cannot be written to), bad_file (the write failed, for instance a full disk);
/// an earlier file of that name is then unchanged.
Status write_snapshot_file(const std::string& path, std::span<const std::byte> bytes);
/// Errors: not_found, bad_file (it cannot be read).
Result<std::vector<std::byte>> read_snapshot_file(const std::string& path);

} // namespace wadi
