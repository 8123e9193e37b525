#include "engine/world.hpp"
#include "engine/step/initial_fields.hpp"

namespace wadi {

Result<std::unique_ptr<World>> World::create(const Settings& settings, const InitialFields& fields,
                                             std::unique_ptr<compute::Device> device, compute::GroupSize group) {
    if (auto status = validate(settings); !status) return status;
    if (auto status = validate(fields, settings); !status) return status;
    auto effects = effects_required(settings, content_of(fields));
    if (!effects) return effects.status();
    std::unique_ptr<World> world(new World(settings, std::move(device), group));
    world->state_.content = content_of(fields);
    if (auto status = world->state_.adopt(*effects); !status) return status;
    if (auto status = upload(world->state_, fields); !status) return status;
    if (auto status = world->stepper_.record(); !status) return status;
    return world;
}

Status World::step(std::uint32_t count) {
    if (auto status = finish_step(); !status) return status;
    for (std::uint32_t n = 0; n < count; ++n) {
        if (auto status = stepper_.step(); !status) return status;
    }
    return state_.lost();
}

Status World::update(std::uint64_t nanoseconds, Frame& frame) {
    outputs_.begin_update();
    if (auto status = frames_.take_steps(nanoseconds, frame); !status) return status;
    if (auto status = outputs_.publish(stepper_.parts_done() == 0, frame.interpolation); !status) return status;
    return frames_.begin_parts();
}

Status World::set_update_settings(const UpdateSettings& settings) {
    const UpdateSettings before = frames_.settings();
    if (auto status = frames_.set(settings); !status) return status;
    auto status = outputs_.set_interpolation(settings.interpolate_outputs);
    if (!status) static_cast<void>(frames_.set(before));
    return status;
}

Status World::finish_step() {
    if (stepper_.parts_done() == 0) return state_.lost();
    auto status = stepper_.step();
    if (status) frames_.finished_early();
    return status;
}

Status World::read(const std::string& name, std::span<float> values) {
    return read(name, {0, 0, settings().grid.nx, settings().grid.ny}, values);
}

Status World::read(const std::string& name, const Region& region, std::span<float> values) {
    if (auto status = check_region("read", region, settings().grid, values.size()); !status) return status;
    auto status = finish_step();
    return status ? reader_.read(name, region, values) : status;
}

Result<WorldStats> World::stats() {
    auto status = finish_step();
    return status ? reader_.stats() : Result<WorldStats>(status);
}

Result<std::uint64_t> World::hash() {
    auto status = finish_step();
    return status ? reader_.hash() : Result<std::uint64_t>(status);
}

Status World::at_boundary() {
    auto status = snapshots_.at_boundary();
    if (status) status = queries_.at_boundary();
    return status ? commands_.at_boundary() : status;
}

Status World::save(std::span<std::byte> to) {
    auto status = finish_step();
    return status ? snapshots_.save(to) : status;
}

Status World::write_region(EditLayer layer, const Region& region, std::span<const float> values) {
    auto status = finish_step();
    return status ? commands_.write_region(layer, region, values) : status;
}

Status World::trim() {
    auto status = finish_step();
    return status ? commands_.trim() : status;
}

Status World::set_material(int key, double value) {
    auto status = finish_step();
    return status ? commands_.set_material(key, value) : status;
}

Status World::load(std::span<const std::byte> from) {
    auto status = finish_step();
    if (status) status = snapshots_.load(from);
    if (!status) return status;
    edits_.forget();
    frames_.went_back();
    commands_.went_to(state_.steps);
    return roll_back_.restart();
}

Status World::set_rollback(std::uint32_t frames, std::uint32_t interval) {
    auto status = finish_step();
    return status ? roll_back_.set(frames, interval) : status;
}

Result<std::uint64_t> World::roll_back_to(std::uint64_t step) {
    auto reached = roll_back_.go_back(step);
    if (!reached) return reached;
    edits_.forget();
    frames_.went_back();
    commands_.went_to(state_.steps);
    auto status = at_boundary();
    return status ? reached : status;
}

Result<std::vector<float>> World::read_raw(const std::string& field) {
    auto status = finish_step();
    return status ? reader_.read_raw(field) : Result<std::vector<float>>(status);
}

} // namespace wadi
