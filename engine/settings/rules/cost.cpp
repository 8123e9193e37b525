#include "engine/settings/rules/cost.hpp"
#include <string>

namespace wadi {

namespace {

constexpr struct {
    std::uint64_t Cost::*sum;
    const char* name;
    const char* unit;
} cost_rows[] = {{&Cost::cells, "cells", "cells"},
                 {&Cost::file_bytes, "file_bytes", "bytes of files"},
                 {&Cost::map_values, "map_values", "values of maps and series"},
                 {&Cost::work, "work", "looks at shapes"},
                 {&Cost::host_bytes, "host_bytes", "bytes of the host's memory"},
                 {&Cost::device_bytes, "device_bytes", "bytes on the device"},
                 {&Cost::steps, "steps", "steps"},
                 {&Cost::edits_per_step, "edits_per_step", "edits in one step"},
                 {&Cost::commands_per_step, "commands_per_step", "commands in one step"}};

} // namespace

Status check_cost(const char* what, const Cost& cost, const Cost& most) {
    for (const auto& row : cost_rows) {
        const std::uint64_t sum = cost.*row.sum, limit = most.*row.sum;
        if (limit != 0 && sum > limit)
            return error(Code::bad_file, std::string(what) + ": " + row.name + ": it asks for " + std::to_string(sum) + " " +
                                             row.unit + "; its host allows " + std::to_string(limit));
    }
    return ok_status();
}

} // namespace wadi
