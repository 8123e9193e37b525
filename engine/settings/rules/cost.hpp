// What a level, a snapshot or a command log asks for, known before the work begins, and a host's limits of it.
#pragma once
#include "engine/compute/status.hpp"
#include <cstdint>

namespace wadi {

/// As in wadi_cost; what does not apply is 0.
struct Cost {
    std::uint64_t cells = 0;        // of the grid
    std::uint64_t file_bytes = 0;   // of what is read, the level's text among it
    std::uint64_t map_values = 0;   // that maps and series hold once they are decoded
    std::uint64_t work = 0;         // draw_work.hpp
    std::uint64_t host_bytes = 0;   // of the host's memory while it loads, at most
    std::uint64_t device_bytes = 0; // that the world holds on its device then, at most
    std::uint64_t steps = 0;        // that the level lasts, that a snapshot is of, up to a log's last command
    std::uint64_t edits_per_step = 0;
    std::uint64_t commands_per_step = 0; // of a log, beside edits
};

/// ok, or bad_file that names the first sum above the host's limit, and both; a limit of 0 is none. `what` begins the message.
Status check_cost(const char* what, const Cost& cost, const Cost& most);

} // namespace wadi
