// A Program as plain data: an ordered list of dispatches, copies, fills and timestamps, before any device sees it.
#pragma once
#include "shaders/params.hpp"
#include "shaders/stage_table.hpp"
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace wadi::compute {

/// Typed handles; id 0 is null.
struct Buffer {
    std::uint32_t id = 0;
    friend bool operator==(Buffer, Buffer) = default;
};
struct Pipeline {
    std::uint32_t id = 0;
};
struct Program {
    std::uint32_t id = 0;
};
/// Names a submission; tickets of one device finish in order.
struct Ticket {
    std::uint64_t value = 0;
};

/// The active tiles of a step, as mark_, count_ and list_active_tiles write them. A dispatch that has them runs over those tiles
/// instead of its range, a rim stage over all of its range; both put the step's number into `activity` of every tile in which
/// they change a bit. What a dispatch writes must then be what the stage's marks say: StageInfo::marks.
struct ActiveTiles {
    Buffer activity, flags, counts, list, dispatch;
    bool on() const { return activity.id != 0; }
};

struct Dispatch {
    Pipeline pipeline;
    int stage = -1;            // index into stage_table()
    std::uint32_t effects = 0; // the world's mask: decides which conditional bindings exist
    std::vector<Buffer> slots; // one per binding of the stage, in slot order; null where the condition is off
    Range2 range{};            // what the kernel covers
    std::string label;         // for errors and profiles
    ActiveTiles tiles{};
    int input = 0; // which of the submission's inputs it reads
};
struct Copy {
    Buffer from, to;
    std::uint64_t from_offset = 0, to_offset = 0, bytes = 0;
};
struct Fill {
    Buffer buffer;
    std::uint32_t word = 0; // written to every 4 bytes
};
struct Timestamp {
    std::string label; // names what ran since the previous timestamp
};
using Op = std::variant<Dispatch, Copy, Fill, Timestamp>;

/// Inputs of one submission at most: steps that one program takes.
inline constexpr int most_inputs = 8;

/// Collects operations in order. Nothing is checked against a device until Device::compile.
class ProgramBuilder {
  public:
    explicit ProgramBuilder(std::string label) : label_(std::move(label)) {}
    void dispatch(Dispatch d) {
        d.input = inputs_ - 1;
        ops_.emplace_back(std::move(d));
    }
    /// What follows reads the next of the submission's inputs.
    void next_input() { ++inputs_; }
    int inputs() const { return inputs_; }
    void copy(Copy c) { ops_.emplace_back(c); }
    void fill(Fill f) { ops_.emplace_back(f); }
    void timestamp(std::string label) { ops_.emplace_back(Timestamp{std::move(label)}); }
    const std::vector<Op>& ops() const { return ops_; }
    const std::string& label() const { return label_; }

  private:
    std::string label_;
    std::vector<Op> ops_;
    int inputs_ = 1;
};

} // namespace wadi::compute
