// Snapshots in files. A file is written under a temporary name of its own, brought to the disk and renamed: whoever finds it
// finds it whole, after a power cut too.
#pragma once
#include "engine/compute/status.hpp"
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace wadi {

/// Replaces `path`. Errors: not_found (the folder cannot be written to), bad_file (the write failed, for instance a full disk, or
/// `path` is a folder, pipe or device); what was there is then unchanged.
Status write_snapshot_file(const std::string& path, std::span<const std::byte> bytes);
/// Errors: not_found, bad_file (no regular file, larger than `most` bytes, of which nothing is read then, or unreadable),
/// out_of_memory. Does not wait for what writes into a pipe.
Result<std::vector<std::byte>> read_snapshot_file(const std::string& path, std::uint64_t most);

} // namespace wadi
