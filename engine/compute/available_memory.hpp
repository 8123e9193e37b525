// How much memory this process could still take.
#pragma once
#include <cstdint>
#include <string>

namespace wadi {

/// Bytes that the system would give without swapping or ending a process, now: MemAvailable of Linux, or less where a control
/// group (version 1 or 2) that the process is in has a limit; file pages that the group could drop count as free. 0 = unknown.
/// `root`: the folder that holds proc/ and sys/.
std::uint64_t available_memory(const std::string& root = "/");

} // namespace wadi
