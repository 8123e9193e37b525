// What the state is at points of the world: asked in batches, answered some time later, never waiting for the device.
#pragma once
#include "engine/step/run/state_program.hpp"
#include "engine/step/run/stepper.hpp"
#include <span>

namespace wadi {

class Queries {
  public:
    static constexpr std::uint64_t most_batches = 8; // batches whose answers are kept or under way
    static constexpr std::uint32_t most_points = 65536;

    /// SAMPLE_FLOATS per point, in the order of sample_points.stage.
    struct Answer {
        std::span<const float> samples;
        std::uint32_t count = 0;
        std::uint64_t step = 0; // that the answer is of
    };

    Queries(WorldState& state, Stepper& stepper) : state_(state), stepper_(stepper) {}

    /// Asks for the state after the steps submitted so far; in the middle of a step, after that step. x, y of each point in
    /// metres. Returns a ticket; the answer of the oldest batch is given up. Allocates where a batch is larger than the
    /// earlier ones in its place.
    /// Errors: bad_argument (no points, too many, a coordinate that is not finite), not_ready (all batches are under way).
    Result<std::uint64_t> ask(std::span<const float> xy);
    /// Valid until `most_batches` - 1 further batches were asked for. Errors: not_ready, bad_argument (unknown ticket, or given
    /// up).
    Result<Answer> answer(std::uint64_t ticket);
    /// To be called when the state is that between two steps again.
    Status at_boundary();

  private:
    struct Batch {
        std::uint64_t ticket = 0;
        std::uint32_t count = 0, capacity = 0;
        bool submitted = false;
        std::uint64_t step = 0;
        compute::Ticket sampled;
        std::array<compute::Buffer, 4> buffers; // upload, points, samples, readback
        std::unique_ptr<StateProgram> program;
    };

    Status reserve(Batch& batch, std::size_t place, std::uint32_t count);
    Status submit(Batch& batch);
    /// The programs of all batches that have room, ahead of their use.
    void record();

    WorldState& state_;
    Stepper& stepper_;
    std::array<Batch, most_batches> batches_;
    std::uint64_t last_ticket_ = 0;
};

} // namespace wadi
