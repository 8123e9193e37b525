#include "engine/step/run/world_state.hpp"
#include "engine/settings/data/rain_map.hpp"
#include "engine/settings/rules/level_digest.hpp"
#include "engine/step/plan/source_shapes.hpp"
#include "engine/step/plan/world_params.hpp"
#include <new>
#include <utility>

namespace wadi {

WorldState::WorldState(const Settings& settings, std::unique_ptr<compute::Device> device, compute::GroupSize group)
    : settings_(settings), layout_{settings.grid.nx, settings.grid.ny}, params_(derive_params(settings, 0)),
      level_(level_digest(settings)), level_sources_(settings.sources), group_(group),
      device_(std::move(device), [this](const Status& lost) { tell(0, lost.message); }) {}

void WorldState::tell(int severity, const std::string& text) const {
    if (!log) return;
    try {
        log(severity, "step " + std::to_string(steps) + ": " + text);
    } catch (const std::bad_alloc&) { // a message is no reason to stop in the middle of a change
    }
}

bool WorldState::fuses() const {
    const std::int64_t cells = std::int64_t{settings_.grid.nx} * settings_.grid.ny;
    const std::int64_t least = (*device_).tuning().fused_gain_cells;
    const bool gains = least > 0 && cells >= least;
    const bool asked =
        settings_.fused_stages == FusedStages::always || (settings_.fused_stages == FusedStages::automatic && gains);
    return asked && (*device_).capabilities().fused_stages;
}

bool WorldState::fuses_slopes() const {
    return settings_.fused_stages == FusedStages::always || (*device_).tuning().fused_slopes;
}

// Where a GPU does not fuse, its grid is so small that a step is short passes that wait for each other, whatever they run over;
// and scratch fields of their own would take memory.
bool WorldState::may_choose_tiles() const {
    const auto& tuning = (*device_).tuning();
    const std::int64_t cells = std::int64_t{settings_.grid.nx} * settings_.grid.ny;
    if (settings_.active_tiles == tiles_where_cheap) return fuses() && cells >= tuning.tiles_gain_cells;
    return settings_.active_tiles == tiles_where_they_gain && (tuning.fused_gain_cells == 0 || fuses());
}

StepPlan WorldState::plan_for(std::uint32_t effects, bool tiles) const {
    return make_step_plan(effects, {settings_.method.substeps, settings_.method.water_substeps},
                          {tiles, fuses(), fuses_slopes()});
}

Status WorldState::check_device() const {
    const auto& device = (*device_).capabilities();
    if (settings_.fused_stages == FusedStages::always && !device.fused_stages) {
        return error(Code::not_supported, "fused_stages: '" + device.name + "' has no groups of " +
                                              std::to_string(compute::fused_group_x * compute::fused_group_y) +
                                              " threads that share " + std::to_string(compute::fused_shared_bytes) +
                                              " bytes, or its build leaves them out");
    }
    const std::uint64_t bytes = layout_.size() * 4, limit = device.largest_buffer_bytes;
    if (limit != 0 && bytes > limit) {
        return error(Code::not_supported, "grid " + std::to_string(layout_.nx) + " x " + std::to_string(layout_.ny) +
                                              " needs fields of " + std::to_string(bytes >> 20) + " MiB; '" + device.name +
                                              "' binds at most " + std::to_string(limit >> 20) + " MiB");
    }
    return ok_status();
}

Status WorldState::set_effects(const EffectChoice& effects) {
    if (auto status = check_device(); !status) return status;
    StepPlan plan = plan_for(effects.mask, settings_.active_tiles > tiles_where_cheap);
    std::optional<StepPlan> other;
    if (may_choose_tiles()) {
        const int without = plan.field_buffers();
        StepPlan tiled = plan_for(effects.mask, true);
        share_fields(tiled, plan);
        if (settings_.active_tiles == tiles_where_they_gain || tiles_are_cheap(tiled, without)) {
            other = std::exchange(plan, std::move(tiled));
        } else {
            plan = plan_for(effects.mask, false);
        }
    }
    if (auto status = fields_.set_plan(plan); !status) return status;
    if (plan.find("roughness") != nullptr) {
        if (auto status = fields_.write("roughness", 0, with_ghosts(layout_, settings_.roughness, true)); !status) return status;
    }
    if (plan.find("rain_share") != nullptr) {
        if (auto status = fields_.write("rain_share", 0, with_ghosts(layout_, rain_shares(settings_), true)); !status)
            return status;
    }
    // Water that was there already is in the pores, as far as they hold it; sand that was is dry.
    if (plan.find("water_in_pores") != nullptr && plan_.find("water_in_pores") == nullptr &&
        plan_.find("water_height") != nullptr) {
        const auto fill = [](int, std::span<float> row) { std::fill(row.begin(), row.end(), FULL_PORES); };
        if (auto status = fields_.write_rows("water_in_pores", fill); !status) return status;
    }
    plan_ = std::move(plan);
    other_plan_ = std::move(other);
    effects_ = effects;
    derive();
    return ok_status();
}

void WorldState::go_back(Replaced&& before) noexcept {
    settings_.material = before.live.material;
    settings_.sources = std::move(before.live.sources);
    params_ = before.params;
    effects_ = std::move(before.effects);
    plan_ = std::move(before.plan);
    other_plan_ = std::move(before.other_plan);
    fields_.go_back(std::move(before.fields));
}

void WorldState::set_live(LiveSettings&& live) noexcept {
    settings_.material = live.material;
    settings_.sources = std::move(live.sources);
}

Status WorldState::write_source_shapes() {
    const auto shapes = fields_.buffer("source_shapes");
    if (shapes.id == 0) return ok_status();
    return device_.write(shapes, 0, std::as_bytes(std::span<const vec4>(source_shapes(settings_))));
}

void WorldState::derive() {
    params_ = derive_params(settings_, plan_.effects);
    const StepPlan& tiled = plan_.active_tiles || !other_plan_ ? plan_ : *other_plan_;
    if (tiled.active_tiles) params_.tile_rings = (tiled.reach + params_.tile_size - 1) / params_.tile_size;
    tiles_.wake_all();
}

void WorldState::use_tiles(bool on) {
    if (plan_.active_tiles == on) return;
    std::swap(plan_, *other_plan_);
    fields_.set_way(on);
    tiles_.wake_all();
}

Status WorldState::prepare(std::uint32_t effects) {
    for (const bool tiles : {false, true}) {
        if (!chooses_tiles() && tiles != plan_.active_tiles) continue;
        const StepPlan plan = plan_for(effects, tiles);
        std::set<int> stages = {compute::find_stage("apply_edits")};
        for (const auto* passes : {&plan.start_passes, &plan.water_passes, &plan.substep_passes})
            for (const auto& pass : *passes) stages.insert(pass.stage);
        if (log)
            for (const char* stage : looking_stages) stages.insert(compute::find_stage(stage));
        for (const int stage : stages) {
            if (auto made = device_.create_pipeline(stage, effects, group_of(stage, tiles)); !made) return made.status();
        }
    }
    return ok_status();
}

compute::GroupSize WorldState::group_of(int stage, bool tiles) const {
    auto group = group_;
    if (tiles && compute::stage_table()[static_cast<std::size_t>(stage)].marks) group.tile = settings_.tile_side();
    return group;
}

Status WorldState::append(compute::ProgramBuilder& builder, const PlanPass& pass, Parity& parity) {
    const auto& stage = compute::stage_table()[static_cast<std::size_t>(pass.stage)];
    auto pipeline = device_.create_pipeline(pass.stage, plan_.effects, group_of(pass.stage, plan_.active_tiles));
    if (!pipeline) return pipeline.status();
    compute::Dispatch dispatch{
        *pipeline, pass.stage, plan_.effects, {}, compute::extent_range(stage.extent, params_), std::string(stage.name)};
    if (plan_.active_tiles && stage.marks) {
        const auto names = tile_list(pass.tiles);
        const auto list = [&](std::size_t n) { return fields_.buffer(names[n], parity); };
        dispatch.tiles = {list(0), list(1), list(2), list(3), list(4)};
    }
    for (const auto& name : pass.fields)
        dispatch.slots.push_back(name.empty() ? compute::Buffer{} : fields_.buffer(name, parity));
    builder.dispatch(std::move(dispatch));
    for (const auto& name : pass.flips) {
        if (!parity.erase(name)) parity.insert(name);
    }
    return ok_status();
}

Status WorldState::append_stage(compute::ProgramBuilder& builder, const char* stage_name, const Parity& parity,
                                const Slots& slots, int most_points) {
    const int index = compute::find_stage(stage_name);
    const auto& stage = compute::stage_table()[static_cast<std::size_t>(index)];
    auto pipeline = device_.create_pipeline(index, plan_.effects, group_);
    if (!pipeline) return pipeline.status();
    compute::Dispatch dispatch{*pipeline, index, plan_.effects, {}, compute::extent_range(stage.extent, params_, most_points),
                               stage_name};
    for (const auto& binding : stage.bindings) {
        const std::string name(binding.name);
        const bool exists = (plan_.effects & binding.condition) == binding.condition;
        const auto given = slots.find(name);
        dispatch.slots.push_back(!exists                ? compute::Buffer{}
                                 : given != slots.end() ? given->second
                                                        : fields_.buffer(name, parity));
    }
    builder.dispatch(std::move(dispatch));
    return ok_status();
}

} // namespace wadi
