#include "engine/step/world_state.hpp"
#include "engine/settings/level_digest.hpp"
#include "engine/step/half.hpp"
#include "engine/step/world_params.hpp"
#include <algorithm>

namespace wadi {

namespace {

std::span<const std::byte> bytes_of(const auto& values) { return std::as_bytes(std::span(values)); }

} // namespace

WorldState::WorldState(const Settings& settings, std::unique_ptr<compute::Device> device, compute::GroupSize group)
    : settings_(settings), layout_{settings.grid.nx, settings.grid.ny}, params_(derive_params(settings)),
      level_(level_digest(settings)), device_(std::move(device)), group_(group) {}

PlanChoice WorldState::plan_choice() const {
    const auto& device = device_->capabilities();
    const std::int64_t cells = std::int64_t{settings_.grid.nx} * settings_.grid.ny;
    const bool gains = device.fused_gain_cells > 0 && cells >= device.fused_gain_cells;
    const bool asked =
        settings_.fused_stages == FusedStages::always || (settings_.fused_stages == FusedStages::automatic && gains);
    return {settings_.active_tiles > 0, asked && device.fused_stages};
}

Status WorldState::open(const EffectChoice& effects) {
    effects_ = effects;
    if (settings_.fused_stages == FusedStages::always && !device_->capabilities().fused_stages) {
        return error(Code::not_supported, "fused_stages: '" + device_->capabilities().name + "' has no groups of " +
                                              std::to_string(compute::fused_group_x * compute::fused_group_y) +
                                              " threads that share " + std::to_string(compute::fused_shared_bytes) + " bytes");
    }
    if ((effects.mask & EFFECT_HALF_STORAGE) != 0 && !device_->capabilities().half_storage) {
        return error(Code::not_supported, "method.half_storage: '" + device_->capabilities().name +
                                              "' has no buffers of 16-bit floats, or no leave to use them");
    }
    plan_ = make_step_plan(effects.mask, settings_.method.substeps, plan_choice());
    derive();
    const std::uint64_t bytes = layout_.size() * 4, limit = device_->capabilities().largest_buffer_bytes;
    if (limit != 0 && bytes > limit) {
        return error(Code::not_supported, "grid " + std::to_string(layout_.nx) + " x " + std::to_string(layout_.ny) +
                                              " needs fields of " + std::to_string(bytes >> 20) + " MiB; '" +
                                              device_->capabilities().name + "' binds at most " + std::to_string(limit >> 20) +
                                              " MiB");
    }
    return allocate(plan_, buffers_, scratch_);
}

void WorldState::set_material(const Material& material) {
    settings_.material = material;
    derive();
}

void WorldState::derive() {
    params_ = derive_params(settings_);
    if (plan_.active_tiles) params_.tile_rings = (plan_.reach + params_.tile_size - 1) / params_.tile_size;
    wake_all();
}

void WorldState::wake(int i0, int j0, int i1, int j1) {
    const int size = params_.tile_size;
    if (size == 0 || i1 <= i0 || j1 <= j0) return;
    const auto tile = [&](int at, int count) { return std::clamp(at / size, 0, count - 1); };
    const std::array<int, 4> tiles = {tile(i0, params_.tile_columns), tile(j0, params_.tile_rows),
                                      tile(i1 - 1, params_.tile_columns), tile(j1 - 1, params_.tile_rows)};
    if (std::find(wakes_.begin(), wakes_.end(), tiles) != wakes_.end()) return;
    if (wakes_.size() < MAX_WAKES) {
        wakes_.push_back(tiles);
        return;
    }
    for (std::size_t n = 0; n < 4; ++n)
        wakes_[0][n] = n < 2 ? std::min(wakes_[0][n], tiles[n]) : std::max(wakes_[0][n], tiles[n]);
}

void WorldState::put_wakes(StepInput& input) const {
    for (const auto& tiles : wakes_) {
        const auto at = [&](std::size_t n) { return static_cast<float>(tiles[n]); };
        input.wake[input.wake_count++] = {at(0), at(1), at(2), at(3)};
    }
}

Result<compute::Buffer> WorldState::make_buffer(const compute::BufferDesc& desc) {
    auto made = device_->create_buffer(desc);
    if (made) {
        device_bytes_ += desc.bytes;
        memory_.push_back({*made, desc.label, desc.bytes});
    }
    return made;
}

void WorldState::free_buffer(compute::Buffer buffer, std::uint64_t bytes) {
    if (buffer.id == 0) return;
    device_->destroy_buffer(buffer);
    device_bytes_ -= bytes;
    std::erase_if(memory_, [&](const MemoryItem& item) { return item.buffer == buffer; });
}

std::vector<KeptField> WorldState::kept_fields(const StepPlan& plan) const {
    std::vector<KeptField> kept;
    for (const auto& field : plan.fields) {
        if (field.role == FieldRole::state || field.role == FieldRole::ledger) kept.push_back({field.name, field_bytes(field)});
    }
    return kept;
}

std::uint64_t WorldState::field_bytes(const PlanField& field) const {
    if (field.role == FieldRole::shapes) return 2 * MAX_SOURCES * sizeof(vec4);
    if (field.role == FieldRole::tiles) {
        const auto columns = static_cast<std::uint64_t>(params_.tile_columns),
                   rows = static_cast<std::uint64_t>(params_.tile_rows);
        return 4 * (field.name.starts_with("active_dispatch") ? 8
                    : field.name.starts_with("active_counts") ? rows
                                                              : columns * rows);
    }
    if (field.role != FieldRole::ledger) return layout_.size() * static_cast<std::uint64_t>(field.element_bytes());
    if (field.name != "source_ledger") return static_cast<std::uint64_t>(layout_.rim()) * 4 * 4;
    return std::uint64_t{2 * LEDGER_ENTRIES} * static_cast<std::uint64_t>(layout_.strips()) *
           static_cast<std::uint64_t>(layout_.pitch()) * 4;
}

Status WorldState::allocate(const StepPlan& plan, FieldBuffers& buffers, std::vector<compute::Buffer>& scratch) {
    for (const auto& field : plan.fields) {
        if (field.role == FieldRole::scratch) continue;
        for (std::size_t n = 0; n < (field.ping_pong ? 2u : 1u); ++n) {
            auto& buffer = buffers[field.name][n];
            if (buffer.id != 0) continue;
            auto made = make_buffer({field_bytes(field), field.name + (n == 1 ? "_next" : "")});
            if (!made) return made.status();
            buffer = *made;
        }
    }
    while (scratch.size() < static_cast<std::size_t>(plan.scratch_blocks)) {
        auto made = make_buffer({layout_.size() * 4, "scratch " + std::to_string(scratch.size())});
        if (!made) return made.status();
        scratch.push_back(*made);
    }
    return ok_status();
}

void WorldState::free_others(const FieldBuffers& buffers, const std::vector<compute::Buffer>& scratch,
                             const std::vector<compute::Buffer>& kept) {
    std::vector<compute::Buffer> all = scratch;
    for (const auto& [name, pair] : buffers) all.insert(all.end(), pair.begin(), pair.end());
    for (const auto buffer : all) {
        if (std::find(kept.begin(), kept.end(), buffer) != kept.end()) continue;
        const auto item = std::find_if(memory_.begin(), memory_.end(), [&](const auto& m) { return m.buffer == buffer; });
        if (item != memory_.end()) free_buffer(buffer, item->bytes);
    }
}

Status WorldState::adopt(const EffectChoice& effects) {
    StepPlan plan = make_step_plan(effects.mask, settings_.method.substeps, plan_choice());
    const auto listed = [](const FieldBuffers& buffers, std::vector<compute::Buffer> all) {
        for (const auto& [name, pair] : buffers) all.insert(all.end(), pair.begin(), pair.end());
        return all;
    };
    // The next step is turn 0, whose current buffers are the first of each pair.
    auto buffers = buffers_;
    for (const auto& name : parity()) std::swap(buffers[name][0], buffers[name][1]);
    auto scratch = scratch_;
    if (auto status = allocate(plan, buffers, scratch); !status) {
        free_others(buffers, scratch, listed(buffers_, scratch_));
        return status;
    }
    FieldBuffers wanted;
    for (const auto& field : plan.fields) {
        if (field.role == FieldRole::scratch) continue;
        wanted[field.name] = buffers[field.name];
        if (!field.ping_pong) wanted[field.name][1] = {};
    }
    std::vector<compute::Buffer> wanted_scratch(scratch.begin(), scratch.begin() + plan.scratch_blocks);
    free_others(buffers, scratch, listed(wanted, wanted_scratch));
    buffers_ = std::move(wanted);
    scratch_ = std::move(wanted_scratch);
    effects_ = effects;
    plan_ = std::move(plan);
    start_parity_ = {};
    turn_ = 0;
    ++recording_;
    derive();
    return ok_status();
}

Status WorldState::prepare(std::uint32_t effects) const {
    const StepPlan plan = make_step_plan(effects, settings_.method.substeps, plan_choice());
    std::set<int> stages = {compute::find_stage("apply_edits")};
    for (const auto* passes : {&plan.water_passes, &plan.substep_passes})
        for (const auto& pass : *passes) stages.insert(pass.stage);
    for (const int stage : stages) {
        if (auto made = device_->create_pipeline(stage, effects, group_of(stage)); !made) return made.status();
    }
    return ok_status();
}

Status WorldState::read_field(const std::string& name, std::size_t first, std::span<float> values) {
    const auto* field = plan_.find(name);
    if (field == nullptr) {
        std::fill(values.begin(), values.end(), 0.0F);
        return ok_status();
    }
    const auto from = buffer(name, parity());
    if (!field->half) return note(device_->read(from, first * 4, std::as_writable_bytes(values)));
    std::vector<std::uint16_t> halves(values.size());
    auto status = note(device_->read(from, first * 2, std::as_writable_bytes(std::span(halves))));
    if (status) std::transform(halves.begin(), halves.end(), values.begin(), from_half);
    return status;
}

Status WorldState::write_field(const std::string& name, std::size_t first, std::span<const float> values) {
    const auto* field = plan_.find(name);
    if (field == nullptr) return ok_status();
    const auto to = buffer(name, parity());
    if (!field->half) return note(device_->write(to, first * 4, std::as_bytes(values)));
    std::vector<std::uint16_t> halves(values.size());
    std::transform(values.begin(), values.end(), halves.begin(), to_half);
    return note(device_->write(to, first * 2, bytes_of(halves)));
}

compute::Buffer WorldState::buffer(const std::string& name, const Parity& parity) const {
    constexpr std::string_view suffix = "_next";
    const bool next = name.ends_with(suffix);
    const std::string base = next ? name.substr(0, name.size() - suffix.size()) : name;
    const auto* field = plan_.find(base);
    if (field == nullptr) return {};
    if (field->role == FieldRole::scratch) return scratch_[static_cast<std::size_t>(field->memory)];
    const std::size_t current = parity.contains(base) ? 1 : 0;
    return buffers_.at(base)[next ? 1 - current : current];
}

std::vector<compute::Buffer> WorldState::active_counts() const {
    std::vector<compute::Buffer> counts;
    for (const bool of_substeps : {false, true})
        if (!of_substeps || plan_.tiles_by_material) counts.push_back(buffer(plan_.tile_list(of_substeps)[4], {}));
    return counts;
}

compute::GroupSize WorldState::group_of(int stage) const {
    auto group = group_;
    if (compute::stage_table()[static_cast<std::size_t>(stage)].marks) group.tile = settings_.active_tiles;
    return group;
}

Status WorldState::append(compute::ProgramBuilder& builder, const PlanPass& pass, Parity& parity) const {
    const auto& stage = compute::stage_table()[static_cast<std::size_t>(pass.stage)];
    auto pipeline = device_->create_pipeline(pass.stage, plan_.effects, group_of(pass.stage));
    if (!pipeline) return pipeline.status();
    compute::Dispatch dispatch{
        *pipeline, pass.stage, plan_.effects, {}, compute::extent_range(stage.extent, params_), std::string(stage.name)};
    if (plan_.active_tiles && stage.marks) {
        const auto names = plan_.tile_list(pass.in_substep);
        const auto list = [&](std::size_t n) { return buffer(names[n], parity); };
        dispatch.tiles = {list(0), list(1), list(2), list(3), list(4)};
    }
    for (const auto& name : pass.fields) dispatch.slots.push_back(name.empty() ? compute::Buffer{} : buffer(name, parity));
    builder.dispatch(std::move(dispatch));
    for (const auto& name : pass.flips) {
        if (!parity.erase(name)) parity.insert(name);
    }
    return ok_status();
}

Status WorldState::append_stage(compute::ProgramBuilder& builder, const char* stage_name, const Parity& parity,
                                const Slots& slots, int most_points) const {
    const int index = compute::find_stage(stage_name);
    const auto& stage = compute::stage_table()[static_cast<std::size_t>(index)];
    auto pipeline = device_->create_pipeline(index, plan_.effects, group_);
    if (!pipeline) return pipeline.status();
    compute::Dispatch dispatch{*pipeline, index, plan_.effects, {}, compute::extent_range(stage.extent, params_, most_points),
                               stage_name};
    for (const auto& binding : stage.bindings) {
        const std::string name(binding.name);
        const bool exists = (plan_.effects & binding.condition) == binding.condition;
        const auto given = slots.find(name);
        dispatch.slots.push_back(!exists ? compute::Buffer{} : given != slots.end() ? given->second : buffer(name, parity));
    }
    builder.dispatch(std::move(dispatch));
    return ok_status();
}

Status WorldState::note(Status status) {
    if (status.code == Code::device_lost) {
        if (lost_ && log) log(0, "step " + std::to_string(steps) + ": " + status.message);
        lost_ = status;
    }
    return status;
}

} // namespace wadi
