// The step plan: effects -> the ordered passes of one step, N water substeps and T sand substeps, and the buffers they need.
// The only place that knows the order (NUMERICS 3, paper Algorithm 1).
#pragma once
#include "engine/step/plan/field_table.hpp"
#include "shaders/stage_table.hpp"
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace wadi {

/// A name that ends in "_next" is the other buffer of a ping-pong field.
inline std::string next_name(const std::string& field) { return field + "_next"; }
inline bool is_next(const std::string& name) { return name.ends_with("_next"); }
/// The field that either name is of.
inline std::string base_name(const std::string& name) { return is_next(name) ? name.substr(0, name.size() - 5) : name; }

/// One pass. `fields` names, slot by slot, the field bound there; empty where the binding does not exist under the mask.
struct PlanPass {
    int stage = -1;
    std::vector<std::string> fields;
    std::vector<std::string> flips; // ping-pong fields whose new buffer becomes the current one after this pass
    std::string tiles;              // what the names of its list of active tiles end in
    bool in_substep = false;
};

/// The fields of a list of active tiles, by what their names end in: activity, flags, counts, list, dispatch.
std::vector<std::string> tile_list(const std::string& ending);

struct PlanField {
    std::string name;
    FieldRole role = FieldRole::state;
    bool ping_pong = false;
    int memory = -1; // scratch: number of the memory block it shares with other scratch fields; -1: of its own

    static constexpr int element_bytes = 4;
};

struct StepPlan {
    std::uint32_t effects = 0;
    int substeps = 1, water_substeps = 1;
    std::vector<PlanPass> water_passes; // in order; before the sand's substeps
    /// Those of [again_from, again_to) run in each of the water's substeps, those ahead and behind once a step.
    std::size_t again_from = 0, again_to = 0;
    std::vector<PlanPass> start_passes;   // step 0 has them as well, ahead of water_passes[start_at]; none of them flips a field
    std::size_t start_at = 0;             // within those of every substep
    std::vector<PlanPass> substep_passes; // run T times
    std::vector<PlanField> fields;
    int scratch_blocks = 0;
    bool active_tiles = false, fused = false; // as asked for
    bool fused_slopes = true;                 // what accelerates sand on slopes, too (Tuning)
    /// A list of active tiles for the passes ahead of the substeps, "_water", one for those in them, "_sand", and one for passes
    /// that change nothing but where both run, "_mixture".
    bool tiles_by_material = false;
    /// Cells that one step carries a change along at most: the sum of what its passes read around them.
    int reach = 0;

    /// Memories of scratch fields: blocks, and those of fields that share none.
    int scratch_buffers() const;
    /// Buffers of nx * ny numbers: state, ping-pong partners and shared scratch.
    int field_buffers() const;
    /// Bytes per cell of those.
    double bytes_per_cell() const;
    /// Bytes per cell that the passes of a step read and write, each field of a pass once; those of the rim and of sources are
    /// left out.
    double traffic_per_cell() const;
    /// Bytes per cell that any step must move: the fields of the state once in, those that change once out.
    double least_traffic_per_cell() const;
    /// The passes of water substep n, from 0 on; `start`: of a world's first.
    std::vector<PlanPass> water_part(int n, bool start = false) const;
    /// How often water_passes[n] runs in a step.
    int times(std::size_t n) const { return n >= again_from && n < again_to ? water_substeps : 1; }
    /// Dispatches of a step: of the water's passes, and of all.
    std::size_t water_dispatches() const {
        return water_passes.size() + (again_to - again_from) * static_cast<std::size_t>(water_substeps - 1);
    }
    std::size_t dispatches() const { return water_dispatches() + substep_passes.size() * static_cast<std::size_t>(substeps); }
    const PlanField* find(const std::string& name) const&;
    const PlanField* find(const std::string& name) const&& = delete; // would point into a plan that is gone
    /// What the names of the lists of active tiles end in.
    std::vector<std::string> tile_lists() const;
};

/// What else a plan depends on, besides what it computes: none of it changes a bit of the result.
struct PlanChoice {
    /// Every scratch field has memory of its own then: what a tile that is left out computed last must stay readable.
    bool active_tiles = false;
    /// Fused stages where the mask allows them.
    bool fused = false;
    /// Where fused: also what accelerates sand where the effect slope_normal is on, whose kernels want many registers.
    bool fused_slopes = true;
};

/// Substeps of a step.
struct Substeps {
    Substeps(int sand_ones, int water_ones = 1) : sand(sand_ones), water(water_ones) {}
    int sand, water;
};

/// Throws std::logic_error where a stage binds a field that field_table() lacks.
StepPlan make_step_plan(std::uint32_t effects, Substeps substeps, PlanChoice choice = {});

/// Gives two plans of the same mask, with and without active tiles, the same fields in the same memory, so that a world can go
/// from one to the other.
void share_fields(StepPlan& tiled, StepPlan& whole);

} // namespace wadi
