// What every part of a world shares: settings, plan, device, buffers, and which buffer of each pair is the current one.
// The parts (stepper, outputs, edits, queries, ...) record their programs against it and know nothing of each other.
#pragma once
#include "engine/compute/device.hpp"
#include "engine/settings/effects.hpp"
#include "engine/settings/settings.hpp"
#include "engine/step/step_plan.hpp"
#include <array>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace wadi {

/// Ping-pong fields whose second buffer is the current one.
using Parity = std::set<std::string>;

/// Buffers by the name of a stage's binding.
using Slots = std::map<std::string, compute::Buffer>;

/// One buffer on the device.
struct MemoryItem {
    compute::Buffer buffer;
    std::string label;
    std::uint64_t bytes = 0;
};

/// A field that the next step depends on, or a ledger: what snapshots and roll-back frames hold.
struct KeptField {
    std::string name;
    std::uint64_t bytes = 0;
};

class WorldState {
  public:
    WorldState(const Settings& settings, std::unique_ptr<compute::Device> device, compute::GroupSize group);

    /// Plans for a mask and makes every buffer it needs. Errors: not_supported (a field larger than the device binds),
    /// out_of_memory.
    Status open(const EffectChoice& effects);
    /// Changes to the plan of another mask at a boundary between two steps. Fields of both plans keep their values to the bit,
    /// new ones are zero, others are freed; the next step is turn 0 and every program must be recorded anew. Waits for the
    /// device. Errors: out_of_memory, with the old plan still in force.
    Status adopt(const EffectChoice& effects);
    /// Creates the pipelines that a plan of another mask would need, so that adopting it later records but compiles nothing.
    Status prepare(std::uint32_t effects) const;

    const Settings& settings() const { return settings_; }
    const FieldLayout& layout() const { return layout_; }
    const WorldParams& params() const { return params_; }
    /// Of the settings that the world was made with: its level.
    std::uint64_t level() const { return level_; }
    /// Other numbers for sand and water. The step programs must be recorded anew; no other program reads what depends on them.
    void set_material(const Material& material);
    /// Other reasons for the same mask.
    void set_reasons(const EffectChoice& effects) { effects_.reasons = effects.reasons; }
    const EffectChoice& effects() const { return effects_; }
    const StepPlan& plan() const { return plan_; }
    compute::Device& device() const { return *device_; }
    std::uint64_t device_bytes() const { return device_bytes_; }
    /// Every buffer that counts into device_bytes().
    const std::vector<MemoryItem>& memory() const { return memory_; }

    /// Which of the two step programs comes next (0 or 1), and the buffers that are current before each.
    int turn() const { return turn_; }
    void set_turn(int turn) { turn_ = turn; }
    const Parity& parity() const { return start_parity_[static_cast<std::size_t>(turn_)]; }
    const Parity& parity_of(int turn) const { return start_parity_[static_cast<std::size_t>(turn)]; }
    void set_start_parity(int turn, const Parity& parity) { start_parity_[static_cast<std::size_t>(turn)] = parity; }
    /// Counts up whenever buffers or pipelines changed so that every program must be recorded anew.
    std::uint64_t recording() const { return recording_; }

    /// Tells the host what happens to the world: other effects, a lost device. May be empty.
    compute::Log log;
    /// Active tiles: cells [i0, i1) x [j0, j1) may be another than the last steps left them, so that the next step must run
    /// there.
    void wake(int i0, int j0, int i1, int j1);
    void wake_all() { wake(0, 0, layout_.nx + 1, layout_.ny + 1); }
    /// Puts what is to be woken into a step's input; forgotten once the step is submitted.
    void put_wakes(StepInput& input) const;
    void forget_wakes() { wakes_.clear(); }
    /// Whose first word is how many tiles the newest step ran over: one per list of tiles.
    std::vector<compute::Buffer> active_counts() const;
    /// Stepper::set_tile_rings().
    void set_tile_rings(int rings) { params_.tile_rings = rings; }

    /// Whole water steps done.
    std::uint64_t steps = 0;
    /// Quanta of sand and water at creation.
    std::int64_t sand_initial = 0, water_initial = 0;
    /// What the effects were chosen for.
    Content content;

    /// The buffer of a field under a parity; with the suffix "_next" its partner. Null where the plan has no such field.
    compute::Buffer buffer(const std::string& name, const Parity& parity) const;
    std::uint64_t field_bytes(const PlanField& field) const;
    std::vector<KeptField> kept_fields(const StepPlan& plan) const;
    std::vector<KeptField> kept_fields() const { return kept_fields(plan_); }
    /// Numbers of a field at its current parity, from element `first` on: its 16-bit floats as floats where it has such. Zeros,
    /// and nothing written, where the plan lacks the field.
    Status read_field(const std::string& name, std::size_t first, std::span<float> values);
    Status write_field(const std::string& name, std::size_t first, std::span<const float> values);
    /// A buffer that counts into device_bytes().
    Result<compute::Buffer> make_buffer(const compute::BufferDesc& desc);
    void free_buffer(compute::Buffer buffer, std::uint64_t bytes);

    /// Appends a pass of the plan and flips what it flips.
    Status append(compute::ProgramBuilder& builder, const PlanPass& pass, Parity& parity) const;
    /// Appends a stage outside the plan. `slots` names the buffers that are not state fields; the rest are found by name.
    /// `most_points`: for a stage over POINTS.
    Status append_stage(compute::ProgramBuilder& builder, const char* stage, const Parity& parity, const Slots& slots,
                        int most_points = 0) const;

    /// ok until the device is lost, then device_lost for ever.
    const Status& lost() const { return lost_; }
    /// Remembers a lost device; returns what it was given.
    Status note(Status status);

  private:
    using FieldBuffers = std::map<std::string, std::array<compute::Buffer, 2>>;
    /// Makes what `plan` needs beyond `buffers` and `scratch`, and adds it to them.
    PlanChoice plan_choice() const;
    Status allocate(const StepPlan& plan, FieldBuffers& buffers, std::vector<compute::Buffer>& scratch);
    /// Frees the buffers of the first two that are not among the kept.
    void free_others(const FieldBuffers& buffers, const std::vector<compute::Buffer>& scratch,
                     const std::vector<compute::Buffer>& kept);

    /// Of a pass of the plan.
    compute::GroupSize group_of(int stage) const;
    /// Numbers that follow from the plan.
    void derive();

    Settings settings_;
    const FieldLayout layout_;
    WorldParams params_;
    const std::uint64_t level_;
    EffectChoice effects_;
    StepPlan plan_;
    std::unique_ptr<compute::Device> device_;
    compute::GroupSize group_;
    FieldBuffers buffers_; // state, ledger, shapes
    std::vector<compute::Buffer> scratch_;
    std::array<Parity, 2> start_parity_{};
    int turn_ = 0;
    std::uint64_t recording_ = 0, device_bytes_ = 0;
    std::vector<MemoryItem> memory_;
    std::vector<std::array<int, 4>> wakes_; // first column, row, last column, row of tiles
    Status lost_;
};

} // namespace wadi
