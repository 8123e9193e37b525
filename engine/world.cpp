#include "engine/world.hpp"
#include "engine/settings/rules/checks.hpp"
#include "engine/step/run/initial_fields.hpp"
#include "engine/step/run/prestress.hpp"

namespace wadi {

World::World(const Settings& settings, std::unique_ptr<compute::Device> device, compute::GroupSize group)
    : state_(settings, std::move(device), group) {
    stepper_.set_hooks({.before_step = [this] { return before_step(); },
                        .after_step = [this] { return after_step(); },
                        .undisturbed = [this](std::uint64_t most) { return undisturbed(most); },
                        .finished_early = [this] { frames_.finished_early(); },
                        .jumped = [this] { return jumped(); }});
}

Result<std::unique_ptr<World>> World::create(const Settings& settings, const InitialFields& fields,
                                             std::unique_ptr<compute::Device> device, compute::GroupSize group) {
    if (auto status = validate(settings); !status) return status;
    if (auto status = validate(fields, settings); !status) return status;
    auto effects = effects_required(settings, content_of(fields));
    if (!effects) return effects.status();
    std::unique_ptr<World> world(new World(settings, std::move(device), group));
    world->state_.content = content_of(fields);
    if (auto status = world->state_.set_effects(*effects); !status) return status;
    if (auto status = upload(world->state_, fields); !status) return status;
    if (auto status = put_in_balance(world->state_); !status) return status;
    if (auto status = world->stepper_.record(); !status) return status;
    return world;
}

Status World::set_log(compute::Log log) {
    state_.log = std::move(log);
    return state_.log ? limits_.watch() : ok_status();
}

Status World::step(std::uint32_t count) {
    if (auto status = stepper_.finish_step(); !status) return status;
    return stepper_.steps(count);
}

Status World::update(std::uint64_t nanoseconds, Frame& frame) {
    outputs_.begin_update();
    if (auto status = frames_.take_steps(nanoseconds, frame); !status) return status;
    auto status = outputs_.publish(stepper_.parts_done() == 0, frame.interpolation);
    if (status) status = frames_.begin_parts();
    if (!status) frames_.take_back(nanoseconds);
    return status;
}

Status World::set_update_settings(const UpdateSettings& settings) {
    const UpdateSettings before = frames_.settings();
    if (auto status = frames_.set(settings); !status) return status;
    auto status = outputs_.set_interpolation(settings.interpolate_outputs);
    if (!status) static_cast<void>(frames_.set(before));
    return status;
}

Status World::before_step() {
    auto status = sources_.before_step();
    return status ? edits_.before_step() : status;
}

Status World::after_step() {
    auto status = roll_back_.after_step();
    limits_.after_step();
    if (status) status = at_boundary();
    return status ? checking_.after_step() : status;
}

std::uint64_t World::undisturbed(std::uint64_t most) const {
    most = sources_.undisturbed(edits_.undisturbed(most));
    return checking_.undisturbed(commands_.undisturbed(roll_back_.undisturbed(limits_.undisturbed(most))));
}

Status World::jumped() {
    frames_.went_back();
    outputs_.jumped();
    limits_.jumped();
    commands_.went_to(state_.steps);
    return at_boundary();
}

Status World::at_boundary() {
    auto status = snapshots_.at_boundary();
    if (status) status = queries_.at_boundary();
    return status ? commands_.at_boundary() : status;
}

} // namespace wadi
