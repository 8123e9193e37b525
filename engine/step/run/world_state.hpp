// What every component of a world shares: settings, plan, device, fields and active tiles, and how passes are recorded on them.
// The components (stepper, outputs, edits, queries, ...) record their programs against it and know nothing of each other.
#pragma once
#include "engine/settings/rules/effects.hpp"
#include "engine/step/run/active_tiles.hpp"
#include "engine/step/run/field_store.hpp"
#include <array>
#include <optional>

namespace wadi {

/// Buffers by the name of a stage's binding.
using Slots = std::map<std::string, compute::Buffer>;

/// By these, one after the other, a world looks for limits at work (engine/reads/limits.hpp).
inline constexpr std::array looking_stages = {"mark_limits", "count_limits", "fold_limits"};

class WorldState {
  public:
    WorldState(const Settings& settings, std::unique_ptr<compute::Device> device, compute::GroupSize group);
    WorldState(const WorldState&) = delete;
    WorldState& operator=(const WorldState&) = delete;

    /// Plans for a mask and changes to its fields (FieldStore::set_plan), at a boundary between two steps. Errors: out_of_memory,
    /// not_supported (fused stages or fields larger than the device can have); the caller goes back then.
    Status set_effects(const EffectChoice& effects);
    /// Creates the pipelines that a plan of another mask would need, so that taking it later records but compiles nothing.
    Status prepare(std::uint32_t effects);

    const Settings& settings() const { return settings_; }
    const FieldLayout& layout() const { return layout_; }
    const WorldParams& params() const { return params_; }
    /// Of the settings that the world was made with: its level.
    std::uint64_t level() const { return level_; }
    /// Other numbers for sand, water and sources. The step programs must be recorded anew where those of sand, water or the
    /// places of sources are others, and these written (write_source_shapes); no other program reads what depends on them.
    void set_live(LiveSettings&& live) noexcept;
    /// What follows from them under the plan in force.
    void derive();
    /// The places of the sources, for their stage. Waits for the device.
    Status write_source_shapes();
    /// The sources of the level, whatever they are now.
    const std::vector<Source>& level_sources() const { return level_sources_; }
    /// Other reasons for the same mask.
    void set_reasons(EffectChoice&& effects) noexcept { effects_.reasons = std::move(effects.reasons); }

    /// What set_effects() and set_live() replace.
    struct Replaced {
        LiveSettings live;
        WorldParams params;
        EffectChoice effects;
        StepPlan plan;
        std::optional<StepPlan> other_plan;
        FieldStore::Replaced fields;
    };
    Replaced now() const { return {settings_.live(), params_, effects_, plan_, other_plan_, fields_.now()}; }
    void go_back(Replaced&& before) noexcept;
    const EffectChoice& effects() const { return effects_; }
    const StepPlan& plan() const { return plan_; }
    /// Whether steps may run with active tiles or without: Settings::active_tiles where that may gain on this device.
    bool chooses_tiles() const { return other_plan_.has_value(); }
    /// The plan that is not in force in such a world.
    const std::optional<StepPlan>& other_plan() const { return other_plan_; }
    /// Goes to the plan with active tiles or to the one without; before turn 0 only.
    void use_tiles(bool on);
    /// Stepper::set_tile_rings().
    void set_tile_rings(int rings) { params_.tile_rings = rings; }

    WorldDevice& device() { return device_; }
    const WorldDevice& device() const { return device_; }
    /// ok until the device is lost, then device_lost for ever.
    const Status& lost() const { return device_.lost(); }
    FieldStore& fields() { return fields_; }
    ActiveTiles& tiles() { return tiles_; }

    /// Whole water steps done.
    std::uint64_t steps = 0;
    /// Quanta of sand and water at creation.
    std::int64_t sand_initial = 0, water_initial = 0;
    /// What the effects were chosen for.
    Content content;

    /// Tells the host what happens to the world: other effects, a lost device. May be empty.
    compute::Log log;
    /// The same with the step ahead of the text.
    void tell(int severity, const std::string& text) const;

    /// Appends a pass of the plan and flips what it flips.
    Status append(compute::ProgramBuilder& builder, const PlanPass& pass, Parity& parity);
    /// Appends a stage outside the plan. `slots` names the buffers that are not state fields; the rest are found by name.
    /// `most_points`: for a stage over POINTS.
    Status append_stage(compute::ProgramBuilder& builder, const char* stage, const Parity& parity, const Slots& slots,
                        int most_points = 0);

  private:
    /// ok, or not_supported.
    Status check_device() const;
    StepPlan plan_for(std::uint32_t effects, bool tiles) const;
    /// Whether the plan has fused stages.
    bool fuses() const;
    /// Also for what accelerates sand on slopes.
    bool fuses_slopes() const;
    bool may_choose_tiles() const;
    /// Of a pass of the plan.
    compute::GroupSize group_of(int stage, bool tiles) const;

    Settings settings_;
    const FieldLayout layout_;
    WorldParams params_;
    const std::uint64_t level_;
    const std::vector<Source> level_sources_;
    EffectChoice effects_;
    StepPlan plan_;
    std::optional<StepPlan> other_plan_; // with the other choice of active tiles
    const compute::GroupSize group_;
    WorldDevice device_;
    FieldStore fields_{device_, settings_};
    ActiveTiles tiles_{settings_};
};

} // namespace wadi
