// The fields of a world on its device, by name, and which buffer of each pair is the current one.
#pragma once
#include "engine/settings/data/settings.hpp"
#include "engine/step/plan/step_plan.hpp"
#include "engine/step/run/named_buffers.hpp"
#include "shaders/params.hpp"
#include <algorithm>
#include <array>
#include <functional>
#include <set>
#include <span>
#include <vector>

namespace wadi {

/// Ping-pong fields whose second buffer is the current one.
using Parity = std::set<std::string>;

/// A field that the next step depends on, or a ledger: what snapshots and roll-back keep.
struct KeptField {
    std::string name;
    std::uint64_t bytes = 0;
};

/// Numbers of cells, row 0 in the south, in a field's layout: ghosts hold 0 or repeat the edge's. All 0 for none.
std::vector<float> with_ghosts(const FieldLayout& layout, const std::vector<float>& cells, bool repeat_edges);

/// One row of them, -GHOST ... ny + GHOST, into `row`, a pitch long and all 0.
void fill_row(const FieldLayout& layout, const std::vector<float>& cells, bool repeat_edges, int j, std::span<float> row);

/// Rows of a field that the host copies to or from a device at a time: 16 MiB, so that a large field needs no memory of its size.
inline std::size_t rows_at_once(const FieldLayout& layout) {
    return std::max<std::size_t>((std::size_t{4} << 20) / static_cast<std::size_t>(layout.pitch()), 1);
}

/// Whether fields of `tiled`, a plan with active tiles, are few more than so many without: what tiles_where_cheap asks.
inline bool tiles_are_cheap(const StepPlan& tiled, int without) { return 8 * tiled.field_buffers() <= 9 * without; }

/// Bytes of a field of a world with these settings.
std::uint64_t bytes_of(const PlanField& field, const Settings& settings);

/// Bytes of the buffers by which a world looks for limits at work (engine/reads/limits.hpp): marks of cells, counts of columns,
/// counts of tiles, which are read back into as many.
struct LimitBytes {
    std::uint64_t marks, columns, tiles;
    std::uint64_t all() const { return marks + columns + 2 * tiles; }
};
LimitBytes limit_bytes(const FieldLayout& layout);

/// Bytes of all buffers that a world with this mask of effects has on its device before it is given anything to do, whichever way
/// of running its device gains from; at most, and with those that look for limits.
std::uint64_t most_device_bytes(const Settings& settings, std::uint32_t effects);

class FieldStore {
  public:
    FieldStore(WorldDevice& device, const Settings& settings);

    /// Changes to the fields of a plan at a boundary between two steps. Those there already keep their values to the bit, new
    /// ones are zero, others stay until settle(); the next step is turn 0 and every program must be recorded anew. Errors:
    /// out_of_memory, nothing changed.
    Status set_plan(const StepPlan& plan);
    /// Frees what the plan has no use for. Waits for the device where its backend waits.
    void settle() noexcept { buffers_.keep_only(wanted_); }

    /// What set_plan() and set_parity() replace.
    struct Replaced {
        std::vector<PlanField> fields;
        std::vector<compute::BufferDesc> wanted;
        NamedBuffers::Made buffers;
        std::array<std::array<Parity, 2>, 2> parities;
        std::size_t way = 0;
        int turn = 0;
    };
    Replaced now() const { return {fields_, wanted_, buffers_.made(), parities_, way_, turn_}; }
    /// Only before settle(). Programs recorded since must not run.
    void go_back(Replaced&& before) noexcept;
    /// Counts up with every set_plan() and go_back().
    std::uint64_t recording() const { return recording_; }

    /// The buffer of a field under a parity; with the suffix "_next" its partner. Null where there is no such field.
    compute::Buffer buffer(const std::string& name, const Parity& parity) const;
    /// The current one.
    compute::Buffer buffer(const std::string& name) const { return buffer(name, parity()); }
    /// Numbers of a field, from element `first` on: its 16-bit floats as floats where it has such. Zeros, and nothing written,
    /// where there is no such field. Both wait for the device.
    Status read(const std::string& name, std::size_t first, std::span<float> values);
    Status write(const std::string& name, std::size_t first, std::span<const float> values);
    /// Writes a whole field, some rows at a time: fill(j, row) gets each row -GHOST ... ny + GHOST, all 0, on several threads.
    Status write_rows(const std::string& name, const std::function<void(int j, std::span<float> row)>& fill);
    /// The fields that are kept, and what a plan would keep.
    std::vector<KeptField> kept() const { return kept(fields_); }
    std::vector<KeptField> kept(const std::vector<PlanField>& fields) const;

    /// Which of the two step programs comes next (0 or 1), and the fields whose second buffer is current before each.
    int turn() const { return turn_; }
    void end_turn() { turn_ = 1 - turn_; }
    const Parity& parity() const { return parity(turn_); }
    const Parity& parity(int turn) const { return parities_[way_][static_cast<std::size_t>(turn)]; }
    void set_parity(int turn, const Parity& parity) { parities_[way_][static_cast<std::size_t>(turn)] = parity; }
    /// Which plan's programs run, without active tiles or with them. Before turn 0 both have the same current buffers: only there
    /// may the way change.
    void set_way(bool tiles) { way_ = tiles ? 1 : 0; }
    /// Numbers the parities that a program outside the step is recorded for.
    static constexpr std::size_t places = 3;
    std::size_t place() const { return turn_ == 0 ? 0 : 1 + way_; }

  private:
    const PlanField* find(const std::string& name) const;

    WorldDevice& device_;
    const Settings& settings_;
    std::vector<PlanField> fields_;
    std::vector<compute::BufferDesc> wanted_;
    NamedBuffers buffers_;
    std::array<std::array<Parity, 2>, 2> parities_{}; // of both ways, before each turn
    std::size_t way_ = 0;
    int turn_ = 0;
    std::uint64_t recording_ = 0;
};

} // namespace wadi
