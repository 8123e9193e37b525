// The recording itself: steps, frames, dumps, contact sheet, table.
#pragma once
#include "options.hpp"

namespace recorder {

/// Runs the whole recording and returns the program's exit code. Messages go to standard error, results to standard output.
int run(const Options& options);

} // namespace recorder
