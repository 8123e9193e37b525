// Saving and loading a world's state, to the bit: at once, or copied by the device and put together beside the host's thread.
#pragma once
#include "engine/saves/roll_back.hpp"
#include "engine/saves/snapshot_format.hpp"
#include "engine/saves/worker.hpp"
#include "engine/settings/rules/cost.hpp"
#include "engine/step/run/state_program.hpp"
#include <optional>

namespace wadi {

class Snapshots {
  public:
    Snapshots(WorldState& state, Stepper& stepper, RollBack& roll_back)
        : state_(state), stepper_(stepper), roll_back_(roll_back) {}

    /// Bytes of a snapshot of the world as it is planned now.
    std::uint64_t bytes() const { return header().bytes(); }
    /// Bytes that no snapshot of the world passes, whatever effects it may come to have.
    std::uint64_t most_bytes() const;
    /// Writes bytes() bytes: everything that the next step depends on, to the bit (snapshot_format.hpp). Waits for the device.
    Status save(std::span<std::byte> to);
    /// Goes back (or on) to a snapshot of a world of the same level. The world is promoted to the snapshot's effects; what those
    /// lacked is zero, as it was there. Edits and commands that wait and states kept for roll-back are forgotten. Waits. Errors:
    /// bad_file (not a whole, unchanged snapshot of a known version, or contents that no world reaches), bad_argument (of another
    /// level, or with effects that this world's level forces off), out_of_memory; the world is then unchanged, as it is where
    /// std::bad_alloc is thrown between two steps. Where only the first state for roll-back could not be kept, none is and the
    /// log says so.
    Status load(std::span<const std::byte> from);
    /// What load() would cost; nothing is changed. Errors: those of load() that the header shows.
    Result<Cost> cost(std::span<const std::byte> from) const;

    /// Has the device copy the state as it is after the steps asked for so far; never waits but allocates at its first call.
    /// In the middle of a step: as it will be after that step. An earlier save that nobody fetched is forgotten.
    /// Errors: not_ready while the device or the worker is still at an earlier save.
    Result<std::uint64_t> begin_save();
    /// Bytes that end_save() wants. Errors: bad_argument (the ticket is not of the last begin_save, or was fetched).
    Result<std::uint64_t> saved_bytes(std::uint64_t ticket) const;
    /// not_ready until the snapshot lies in `to`, which a worker fills from some call on: it must stay the same until then,
    /// through errors too. A device that is lost after that takes nothing away. Where the system refuses the worker's thread the
    /// call fills it. Errors: bad_argument, device_lost.
    Status end_save(std::uint64_t ticket, std::span<std::byte> to);
    /// To be called when the state is that between two steps again.
    Status at_boundary();

  private:
    enum class Waits { none, step, device, worker }; // what the save in flight waits for

    SnapshotHeader header() const;
    /// What a world has that takes the snapshot.
    LiveSettings live_of(const SnapshotHeader& header) const;
    Status check(const SnapshotHeader& header) const;
    Status write_fields(const SnapshotHeader& header, std::span<const std::byte> from);
    Content content_for(const SnapshotHeader& header) const;
    void keep_for_roll_back(const std::string& trouble);
    Status make_buffers();
    Status submit_copies();
    void assemble();

    WorldState& state_;
    Stepper& stepper_;
    RollBack& roll_back_;

    Waits waits_for_ = Waits::none;
    std::uint64_t ticket_ = 0;
    SnapshotHeader saved_;
    compute::Ticket copied_;
    std::span<std::byte> to_;
    NamedBuffers readback_{state_.device()};
    std::map<std::string, std::span<const std::byte>> memory_; // of readback_, by field
    std::optional<StateProgram> copies_;
    std::uint64_t recording_ = 0;
    Worker worker_; // last: it ends before what it reads
};

} // namespace wadi
