// Threads of the library by name, in debuggers, profilers and top.
#pragma once

namespace wadi::compute {

/// Names the calling thread; of a longer name the first 15 characters. Does nothing where the system has no names.
void name_this_thread(const char* name);

} // namespace wadi::compute
