#include "engine/world.hpp"
#include "engine/world_params.hpp"
#include <algorithm>
#include <cmath>
#include <cstring>

namespace wadi {

namespace {

std::vector<float> with_ghosts(const FieldLayout& layout, const std::vector<float>& cells, bool repeat_edges) {
    std::vector<float> field(layout.size(), 0.0F);
    if (cells.empty()) return field;
    for (int j = -GHOST; j < layout.ny + 1 + GHOST; ++j) {
        for (int i = -GHOST; i < layout.nx + 1 + GHOST; ++i) {
            const int x = std::clamp(i, 0, layout.nx - 1), y = std::clamp(j, 0, layout.ny - 1);
            if (repeat_edges || (x == i && y == j))
                field[layout.index(i, j)] =
                    cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(layout.nx) + static_cast<std::size_t>(x)];
        }
    }
    return field;
}

// Face velocities from cell-centred ones: the mean of the two cells; outer faces are walls until a side opens them.
std::vector<float> to_faces(const FieldLayout& layout, const std::vector<float>& cells, bool along_x) {
    std::vector<float> field(layout.size(), 0.0F);
    if (cells.empty()) return field;
    const auto at = [&](int i, int j) {
        return cells[static_cast<std::size_t>(j) * static_cast<std::size_t>(layout.nx) + static_cast<std::size_t>(i)];
    };
    for (int j = along_x ? 0 : 1; j < layout.ny; ++j) {
        for (int i = along_x ? 1 : 0; i < layout.nx; ++i) {
            field[layout.index(i, j)] = 0.5F * (at(i, j) + (along_x ? at(i - 1, j) : at(i, j - 1)));
        }
    }
    return field;
}

// Nearest whole quantum, as every height is.
void round_heights(std::vector<float>& heights, double quantum) {
    if (quantum <= 0) return;
    for (auto& h : heights) h = static_cast<float>(std::nearbyint(static_cast<double>(h) / quantum) * quantum);
}

std::int64_t count_quanta(const std::vector<float>& heights, double quantum) {
    std::int64_t sum = 0;
    for (const float h : heights) sum += std::llrint(static_cast<double>(h) / quantum);
    return sum;
}

std::span<const std::byte> bytes_of(const auto& values) { return std::as_bytes(std::span(values)); }

} // namespace

World::World(const Settings& settings, std::unique_ptr<compute::Device> device, compute::GroupSize group)
    : settings_(settings), layout_{settings.grid.nx, settings.grid.ny}, params_(derive_params(settings)),
      device_(std::move(device)), group_(group), inputs_(settings) {}

World::~World() = default;

Result<std::unique_ptr<World>> World::create(const Settings& settings, const InitialFields& fields,
                                             std::unique_ptr<compute::Device> device, compute::GroupSize group) {
    if (auto status = validate(settings); !status) return status;
    if (auto status = validate(fields, settings); !status) return status;
    auto effects = effects_required(settings, fields);
    if (!effects) return effects.status();
    std::unique_ptr<World> world(new World(settings, std::move(device), group));
    world->effects_ = *effects;
    world->plan_ = make_step_plan(effects->mask, settings.method.substeps);
    const std::uint64_t field_bytes = world->layout_.size() * 4, limit = world->device_->capabilities().largest_buffer_bytes;
    if (limit != 0 && field_bytes > limit) {
        return error(Code::not_supported, "grid " + std::to_string(settings.grid.nx) + " x " + std::to_string(settings.grid.ny) +
                                              " needs fields of " + std::to_string(field_bytes >> 20) + " MiB; '" +
                                              world->device_->capabilities().name + "' binds at most " +
                                              std::to_string(limit >> 20) + " MiB");
    }
    if (auto status = world->allocate(); !status) return status;
    if (auto status = world->upload(fields); !status) return status;
    if (auto status = world->record_steps(); !status) return status;
    return world;
}

Result<compute::Buffer> World::make_buffer(const std::string& label, std::uint64_t bytes) {
    auto made = device_->create_buffer({bytes, label});
    if (made) device_bytes_ += bytes;
    return made;
}

std::uint64_t World::field_bytes(const PlanField& field) const {
    if (field.role == FieldRole::shapes) return 2 * MAX_SOURCES * sizeof(vec4);
    if (field.role != FieldRole::ledger) return layout_.size() * 4;
    if (field.name != "source_ledger") return static_cast<std::uint64_t>(layout_.rim()) * 4 * 4;
    return std::uint64_t{2 * LEDGER_ENTRIES} * static_cast<std::uint64_t>(layout_.strips()) *
           static_cast<std::uint64_t>(layout_.pitch()) * 4;
}

Status World::allocate() {
    for (const auto& field : plan_.fields) {
        if (field.role == FieldRole::scratch) continue;
        for (std::size_t n = 0; n < (field.ping_pong ? 2u : 1u); ++n) {
            auto made = make_buffer(field.name + (n == 1 ? "_next" : ""), field_bytes(field));
            if (!made) return made.status();
            buffers_[field.name][n] = *made;
        }
    }
    for (int n = 0; n < plan_.scratch_blocks; ++n) {
        auto made = make_buffer("scratch " + std::to_string(n), layout_.size() * 4);
        if (!made) return made.status();
        scratch_.push_back(*made);
    }
    return ok_status();
}

Status World::upload(const InitialFields& fields) {
    const double quantum = height_quantum(settings_.method);
    const auto put = [&](const char* name, const std::vector<float>& values) {
        return plan_.find(name) == nullptr ? ok_status() : device_->write(buffers_[name][0], 0, bytes_of(values));
    };
    const auto heights = [&](const std::vector<float>& cells, bool repeat_edges) {
        auto rounded = cells;
        round_heights(rounded, quantum);
        return with_ghosts(layout_, rounded, repeat_edges);
    };
    const auto sand = heights(fields.sand, false), water = heights(fields.water, false);
    sand_initial_ = plan_.find("sand_height") == nullptr ? 0 : count_quanta(sand, ledger_quantum(settings_.method));
    water_initial_ = plan_.find("water_height") == nullptr ? 0 : count_quanta(water, ledger_quantum(settings_.method));
    const auto u = to_faces(layout_, fields.velocity_x, true), v = to_faces(layout_, fields.velocity_y, false);
    const std::pair<const char*, std::vector<float>> all[] = {
        {"terrain", heights(fields.terrain, true)},
        {"sand_height", sand},
        {"water_height", water},
        {"water_velocity_x", u},
        {"water_velocity_y", v},
        {"mixed_velocity_x", u},
        {"mixed_velocity_y", v},
        {"sand_velocity_x", to_faces(layout_, fields.sand_velocity_x, true)},
        {"sand_velocity_y", to_faces(layout_, fields.sand_velocity_y, false)}};
    for (const auto& [name, values] : all) {
        if (auto status = put(name, values); !status) return status;
    }
    if (plan_.find("source_shapes") == nullptr) return ok_status();
    return device_->write(buffers_["source_shapes"][0], 0, bytes_of(source_shapes(settings_)));
}

compute::Buffer World::buffer(const std::string& name, const Parity& parity) const {
    constexpr std::string_view suffix = "_next";
    const bool next = name.ends_with(suffix);
    const std::string base = next ? name.substr(0, name.size() - suffix.size()) : name;
    const auto* field = plan_.find(base);
    if (field == nullptr) return {};
    if (field->role == FieldRole::scratch) return scratch_[static_cast<std::size_t>(field->memory)];
    const std::size_t current = parity.contains(base) ? 1 : 0;
    return buffers_.at(base)[next ? 1 - current : current];
}

Status World::append(compute::ProgramBuilder& builder, const PlanPass& pass, Parity& parity) {
    const auto& stage = compute::stage_table()[static_cast<std::size_t>(pass.stage)];
    auto pipeline = device_->create_pipeline(pass.stage, plan_.effects, group_);
    if (!pipeline) return pipeline.status();
    compute::Dispatch dispatch{
        *pipeline, pass.stage, plan_.effects, {}, compute::extent_range(stage.extent, params_), std::string(stage.name)};
    for (const auto& name : pass.fields) dispatch.slots.push_back(name.empty() ? compute::Buffer{} : buffer(name, parity));
    builder.dispatch(std::move(dispatch));
    for (const auto& name : pass.flips) {
        if (!parity.erase(name)) parity.insert(name);
    }
    return ok_status();
}

Result<compute::Program> World::record_step(Parity& parity, bool timestamps) {
    compute::ProgramBuilder builder(timestamps ? "timed step" : "step");
    if (timestamps) builder.timestamp("start");
    const auto add = [&](const PlanPass& pass) {
        auto status = append(builder, pass, parity);
        if (status && timestamps)
            builder.timestamp(std::string(compute::stage_table()[static_cast<std::size_t>(pass.stage)].name));
        return status;
    };
    for (const auto& pass : plan_.water_passes) {
        if (auto status = add(pass); !status) return status;
    }
    for (int t = 0; t < plan_.substeps; ++t) {
        for (const auto& pass : plan_.substep_passes) {
            if (auto status = add(pass); !status) return status;
        }
    }
    return device_->compile(builder, params_);
}

// A step flips each ping-pong field a fixed number of times, so two steps bring every field back: two programs suffice.
Status World::record_steps() {
    Parity parity;
    for (std::size_t n = 0; n < 2; ++n) {
        start_parity_[n] = parity;
        auto program = record_step(parity, false);
        if (!program) return program.status();
        step_programs_[n] = *program;
    }
    return ok_status();
}

Status World::note(Status status) {
    if (status.code == Code::device_lost) lost_ = status;
    return status;
}

Status World::step(std::uint32_t count) {
    if (!lost_) return lost_;
    for (std::uint32_t n = 0; n < count; ++n) {
        const auto which = static_cast<std::size_t>(parity_);
        const auto input = inputs_.next(static_cast<int>(steps_));
        auto ticket = device_->submit(profiling_ ? timed_programs_[which] : step_programs_[which], input);
        if (!ticket) return note(ticket.status());
        if (profiling_) {
            pending_timings_.push_back(*ticket);
            if (auto status = collect_timings(false); !status) return note(status);
        }
        parity_ = 1 - parity_;
        ++steps_;
    }
    return ok_status();
}

Status World::set_profiling(bool on) {
    if (auto status = collect_timings(true); !status) return note(status);
    if (on && timed_programs_[0].id == 0) {
        for (std::size_t n = 0; n < 2; ++n) {
            Parity parity = start_parity_[n];
            auto program = record_step(parity, true);
            if (!program) return note(program.status());
            timed_programs_[n] = *program;
        }
    }
    if (on && !profiling_) {
        stage_milliseconds_.clear();
        timed_steps_ = 0;
    }
    profiling_ = on;
    return ok_status();
}

// The device keeps the timings of a few submissions only: fetch them as they finish.
Status World::collect_timings(bool all) {
    constexpr std::size_t most_pending = 4;
    while (!pending_timings_.empty() && (all || pending_timings_.size() > most_pending)) {
        const auto ticket = pending_timings_.front();
        pending_timings_.erase(pending_timings_.begin());
        if (auto status = device_->wait(ticket); !status) return status;
        auto timings = device_->timings(ticket);
        if (!timings) return timings.status();
        for (const auto& timing : *timings) stage_milliseconds_[timing.label] += timing.milliseconds;
        ++timed_steps_;
    }
    return ok_status();
}

Result<std::vector<StageTime>> World::stage_times() {
    if (auto status = collect_timings(true); !status) return note(status);
    std::vector<StageTime> times;
    const auto add = [&](const PlanPass& pass, int repeats) {
        const std::string name(compute::stage_table()[static_cast<std::size_t>(pass.stage)].name);
        auto found = std::find_if(times.begin(), times.end(), [&](const StageTime& t) { return t.stage == name; });
        if (found == times.end()) {
            const double total = stage_milliseconds_.contains(name) ? stage_milliseconds_[name] : 0;
            found = times.insert(times.end(), {name, timed_steps_ > 0 ? total / static_cast<double>(timed_steps_) : 0, 0});
        }
        found->passes += repeats;
    };
    for (const auto& pass : plan_.water_passes) add(pass, 1);
    for (const auto& pass : plan_.substep_passes) add(pass, plan_.substeps);
    return times;
}

} // namespace wadi
