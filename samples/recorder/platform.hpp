// What differs between operating systems.
#pragma once
#include <filesystem>

namespace recorder {

/// Whether standard error is a terminal that understands carriage return.
bool error_stream_is_terminal();

/// The running program's file; empty where the system does not tell.
std::filesystem::path executable_path();

/// The first interrupt (Ctrl-C) only sets the flag, a second one ends the program.
void catch_interrupt();
bool interrupted();

} // namespace recorder
