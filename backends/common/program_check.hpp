// What a program must be for any backend to run it.
#pragma once
#include "engine/compute/device.hpp"
#include <map>

namespace wadi::backends {

/// What there is to know of the things that a device has made, by handle.
struct Objects {
    struct Buffer {
        std::uint64_t bytes = 0;
        std::string label;
        bool host = false; // the host reads or writes it in place
    };
    struct Pipeline {
        int stage = -1;
        std::uint32_t effects = 0; // those that the stage tests
        compute::GroupSize group;
        friend bool operator==(const Pipeline&, const Pipeline&) = default;
    };
    std::map<std::uint32_t, Buffer> buffers;
    std::map<std::uint32_t, Pipeline> pipelines;
};

/// Errors: bad_argument with the program's, the dispatch's and the binding's name, for whatever no device could run.
Status check_program(const compute::ProgramBuilder& program, const WorldParams& params, const Objects& objects);

/// Errors: bad_argument (no such buffer, or bytes outside it). `what` begins the message.
Status check_range(const Objects& objects, compute::Buffer buffer, std::uint64_t offset, std::uint64_t bytes,
                   const std::string& what);

/// Errors: bad_argument.
Status check_stage(int stage);

} // namespace wadi::backends
