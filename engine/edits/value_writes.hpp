// Rectangles of cells written from values on the device or in the host's memory, without waiting: the stage write_values rounds,
// checks and counts what write_region() does on the host.
#pragma once
#include "engine/step/run/region.hpp"
#include "engine/step/run/state_program.hpp"
#include "engine/step/run/stepper.hpp"
#include <array>

namespace wadi {

/// Rows of floats: of the host's memory, which is read at once, or of the device's own API.
struct ValueSource {
    compute::NativeBuffer::Kind kind = compute::NativeBuffer::Kind::host_pointer;
    std::uint64_t handle = 0, offset = 0, row_pitch = 0; // offset, row_pitch [bytes]
};

class ValueWrites {
  public:
    ValueWrites(WorldState& state, Stepper& stepper);
    ~ValueWrites() { free_all(); }
    ValueWrites(const ValueWrites&) = delete;
    ValueWrites& operator=(const ValueWrites&) = delete;

    /// Overwrites heights of a layer between two steps, in a region within the grid. A layer of sand or water promotes the world,
    /// since nobody knows yet what the values are. Allocates for a larger region than before; waits only for the oldest of four
    /// writes of the host's memory. Errors: bad_argument (a layer that the level forces off, another API's memory), not_supported
    /// (a device that takes none of the host's), out_of_memory.
    Status write(EditLayer layer, const Region& region, const ValueSource& from);

  private:
    struct Upload {
        compute::Buffer memory;
        compute::Program program; // copies all of it to values_
        compute::Ticket ticket;   // of the newest copy
    };
    Status check_kind(compute::NativeBuffer::Kind kind) const;
    Status make_room(std::uint64_t numbers);
    void free_all();
    Status upload(const Region& region, const ValueSource& from);
    Status make_upload(Upload& upload);
    Status bring(const Region& region, const ValueSource& from);

    WorldState& state_;
    Stepper& stepper_;
    std::uint64_t room_ = 0; // numbers that values_ holds
    compute::Buffer values_;
    std::array<Upload, 4> uploads_{};
    std::size_t next_ = 0;
    StateProgram program_;
    Material recorded_with_; // what program_ knows of sand in balance
};

} // namespace wadi
