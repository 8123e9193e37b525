// A program outside the step plan (publishing, edits, copies ...) that reads or writes the state between two steps.
#pragma once
#include "engine/step/run/world_state.hpp"
#include <functional>

namespace wadi {

/// Recorded once for each of the parities of the buffers, when first needed, and anew after the world was re-recorded.
class StateProgram {
  public:
    /// Appends the operations for a parity.
    using Build = std::function<Status(compute::ProgramBuilder& builder, const Parity& parity)>;

    StateProgram(WorldState& state, std::string label, Build build)
        : state_(state), label_(std::move(label)), build_(std::move(build)) {}
    ~StateProgram();
    StateProgram(const StateProgram&) = delete;
    StateProgram& operator=(const StateProgram&) = delete;

    /// Records it for the current parity, where that has not been done.
    Status record();
    /// Submits it for the current parity.
    Result<compute::Ticket> submit(const StepInput& input = {});
    /// Drops what was recorded: its buffers changed.
    void forget();

  private:
    WorldState& state_;
    const std::string label_;
    const Build build_;
    std::array<compute::Program, FieldStore::places> programs_{};
    std::uint64_t recording_ = 0;
};

} // namespace wadi
