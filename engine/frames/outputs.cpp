#include "engine/frames/outputs.hpp"
#include "engine/step/run/step_number.hpp"
#include <algorithm>

namespace wadi {

namespace {

struct Kind {
    const char* name;
    const char* stage;   // null: the field is copied as it is
    const char* binding; // the stage's output, or the field
    const char* layer;   // of publish_flow: whose velocity
    OutputFormat format;
};

constexpr Kind kinds[] = {
    {"terrain", nullptr, "terrain", nullptr, {1}},
    {"sand_surface", "publish_sand_surface", "sand_surface", nullptr, {1}},
    {"free_surface", "publish_free_surface", "free_surface", nullptr, {1}},
    {"sand_depth", nullptr, "sand_height", nullptr, {1}},
    {"water_depth", "publish_water_depth", "water_depth", nullptr, {1}},
    {"saturation", "publish_saturation", "surface_saturation", nullptr, {1}},
    {"flow", "publish_flow", "flow", "water_velocity_", {2}},
    {"sand_flow", "publish_flow", "flow", "sand_velocity_", {2}},
    {"foam", "publish_foam", "foam", nullptr, {1}},
    {"normal", "publish_normal", "normal", nullptr, {4}},
    {"smooth_surface", "publish_smooth_surface", "smooth_surface", nullptr, {1}},
    {"packed", "publish_packed", "packed_surface", nullptr, {4}},
    {"packed_half", "publish_packed_half", "packed_surface", nullptr, {4, 2}},
    {"wetness", nullptr, "wetness", nullptr, {1}},
    {"silt", nullptr, "silt", nullptr, {1}},
};
static_assert(std::size(kinds) == static_cast<std::size_t>(Output::count));

const Kind& kind_of(Output output) { return kinds[static_cast<std::size_t>(output)]; }

template <class Call> void for_outputs(std::uint32_t mask, Call call) {
    for (std::uint32_t n = 0; n < static_cast<std::uint32_t>(Output::count); ++n) {
        if ((mask >> n & 1u) != 0) call(static_cast<Output>(n));
    }
}

std::string label(Output output, std::size_t set) {
    return std::string("output ") + kind_of(output).name + " " + std::to_string(set);
}
std::string interpolated_label(Output output) { return std::string("interpolated ") + kind_of(output).name; }

Status not_asked(const std::string& what) {
    return error(Code::bad_argument, what + " was not asked for; ask with wadi_world_set_outputs or wadi_world_set_host_outputs");
}

} // namespace

// Tiles are measured on two published fields.
std::uint32_t Outputs::fields_of(const Asked& asked) {
    const std::uint32_t tiles = (asked.mask & tiles_bit) != 0 ? bit(Output::sand_surface) | bit(Output::free_surface) : 0;
    return ((asked.mask | asked.host) & all_outputs) | tiles;
}

std::uint32_t Outputs::interpolated() const {
    std::uint32_t mask = 0;
    for_outputs(asked_.interpolate ? asked_.mask : 0, [&](Output o) { mask |= kind_of(o).format.components == 1 ? bit(o) : 0; });
    return mask;
}

compute::Buffer Outputs::buffer(Output output, std::size_t set) const { return buffers_[label(output, set)]; }

std::uint64_t Outputs::first_byte(Output output) const { return state_.layout().index(0, 0) * kind_of(output).format.bytes(); }

std::vector<compute::BufferDesc> Outputs::wanted_buffers(const Asked& asked) const {
    const auto& layout = state_.layout();
    std::vector<compute::BufferDesc> wanted;
    for_outputs(fields_of(asked), [&](Output o) {
        for (std::size_t set = 0; set < sets; ++set)
            wanted.push_back({.bytes = layout.size() * kind_of(o).format.bytes(), .label = label(o, set), .shared = true});
        if (asked.interpolate && (asked.mask & bit(o)) != 0 && kind_of(o).format.components == 1)
            wanted.push_back({.bytes = layout.size() * 4, .label = interpolated_label(o), .shared = true});
    });
    if ((asked.mask & tiles_bit) != 0) {
        const auto strips = static_cast<std::uint64_t>(layout.strips());
        const std::uint64_t columns = strips * static_cast<std::uint64_t>(layout.pitch());
        const std::uint64_t tiles = strips * static_cast<std::uint64_t>(layout.tile_columns());
        for (const auto& [name, bytes] : {std::pair("strip_range", columns * 16), std::pair("strip_changed", columns * 4),
                                          std::pair("tile_range", tiles * 16), std::pair("tile_changed", tiles * 4)})
            wanted.push_back({bytes, name});
    }
    return wanted;
}

std::vector<HostCopies::Item> Outputs::wanted_copies(const Asked& asked) const {
    const auto& layout = state_.layout();
    const auto cells = static_cast<std::uint64_t>(layout.ny - 1) * static_cast<std::uint64_t>(layout.pitch()) +
                       static_cast<std::uint64_t>(layout.nx);
    std::vector<HostCopies::Item> items;
    for_outputs(asked.host, [&](Output o) {
        HostCopies::Item item{kind_of(o).name, {}, first_byte(o), cells * kind_of(o).format.bytes()};
        for (std::size_t set = 0; set < sets; ++set) item.from[set] = buffer(o, set);
        items.push_back(item);
    });
    if ((asked.mask & tiles_bit) != 0) {
        const auto tiles = static_cast<std::uint64_t>(layout.strips()) * static_cast<std::uint64_t>(layout.tile_columns());
        const auto range = buffers_["tile_range"], changed = buffers_["tile_changed"];
        items.push_back({"tile_range", {range, range, range}, 0, tiles * 16});
        items.push_back({"tile_changed", {changed, changed, changed}, 0, tiles * 4});
    }
    return items;
}

Status Outputs::change(const Asked& asked) {
    if (asked == asked_) return ok_status();
    if (!state_.lost()) return state_.lost();
    if (auto status = buffers_.keep_also(wanted_buffers(asked)); !status) return status;
    auto status = copies_.set(wanted_copies(asked));
    if (status) {
        asked_ = asked;
        for (std::size_t set = 0; set < sets; ++set) {
            publish_[set].reset();
            interpolate_[set].reset();
        }
    }
    buffers_.keep_only(wanted_buffers(asked_));
    return status ? restart() : status;
}

// As if nothing had ever been published: every tile counts as changed.
Status Outputs::restart() {
    published_ = 0;
    const auto changed = buffers_["tile_changed"];
    if (changed.id == 0) return ok_status();
    const std::vector<std::int32_t> never(
        static_cast<std::size_t>(state_.layout().strips()) * static_cast<std::size_t>(state_.layout().tile_columns()), -1);
    return state_.device().write(changed, 0, std::as_bytes(std::span(never)));
}

Status Outputs::build_publish(compute::ProgramBuilder& builder, const Parity& parity, std::size_t set) const {
    Status status;
    for_outputs(fields_of(asked_), [&](Output o) {
        const auto& kind = kind_of(o);
        const auto to = buffer(o, set);
        const std::string layer = kind.layer != nullptr ? kind.layer : "";
        const std::string needs = kind.layer != nullptr ? layer + "x" : kind.stage == nullptr ? kind.binding : "terrain";
        if (!status) return;
        if (state_.plan().find(needs) == nullptr) { // a layer that the world lacks
            builder.fill({to, 0});
            return;
        }
        if (kind.stage == nullptr) {
            builder.copy({state_.fields().buffer(kind.binding, parity), to, 0, 0, state_.layout().size() * 4});
            return;
        }
        Slots slots = {{kind.binding, to}};
        if (kind.layer != nullptr) {
            slots["velocity_x"] = state_.fields().buffer(layer + "x", parity);
            slots["velocity_y"] = state_.fields().buffer(layer + "y", parity);
        }
        status = state_.append_stage(builder, kind.stage, parity, slots);
    });
    if (!status || (asked_.mask & tiles_bit) == 0) return status;
    const std::size_t before = (set + sets - 1) % sets;
    Slots slots = {{"sand_surface", buffer(Output::sand_surface, set)},
                   {"free_surface", buffer(Output::free_surface, set)},
                   {"previous_sand_surface", buffer(Output::sand_surface, before)},
                   {"previous_free_surface", buffer(Output::free_surface, before)}};
    for (const char* name : {"strip_range", "strip_changed", "tile_range", "tile_changed"}) slots[name] = buffers_[name];
    if (status = state_.append_stage(builder, "measure_strips", parity, slots); !status) return status;
    return state_.append_stage(builder, "fold_tiles", parity, slots);
}

Status Outputs::build_interpolation(compute::ProgramBuilder& builder, const Parity& parity, std::size_t set) const {
    Status status;
    for_outputs(interpolated(), [&](Output o) {
        const Slots slots = {{"previous_output", buffer(o, (set + sets - 1) % sets)},
                             {"current_output", buffer(o, set)},
                             {"interpolated_output", buffers_[interpolated_label(o)]}};
        if (status) status = state_.append_stage(builder, "interpolate_output", parity, slots);
    });
    return status;
}

Status Outputs::publish(bool between_steps, double interpolation) {
    if (fields_of(asked_) == 0) return ok_status();
    if (between_steps && (published_ == 0 || jumped_ || published_step() != state_.steps)) {
        const std::size_t set = next_;
        auto& program = publish_[set];
        if (!program) {
            program.emplace(state_, "publish", [this, set](compute::ProgramBuilder& builder, const Parity& parity) {
                return build_publish(builder, parity, set);
            });
        }
        StepInput input{};
        input.step = stage_step(state_.steps);
        auto ticket = program->submit(input);
        if (!ticket) return ticket.status();
        sets_[set] = {state_.steps, *ticket};
        next_ = (set + 1) % sets;
        ++published_;
        jumped_ = false;
        copied_ = false;
    }
    if (published_ > 0 && !copied_) {
        auto copied = copies_.copy(current(), published_step());
        if (!copied) return copied.status();
        copied_ = *copied;
    }
    return interpolate(interpolation);
}

Status Outputs::wait() {
    if (!state_.lost()) return state_.lost();
    if (fields_of(asked_) == 0)
        return error(Code::bad_argument,
                     "no output was asked for; ask with wadi_world_set_outputs or wadi_world_set_host_outputs");
    if (published_ == 0) return error(Code::not_ready, "nothing was published yet; it is after the next update");
    copies_.give_anew();
    if (auto status = state_.device().wait(sets_[current()].ticket); !status) return status; // frees the copies before it
    if (!copied_) {
        auto copied = copies_.copy(current(), published_step());
        if (!copied) return copied.status();
        copied_ = *copied; // all copies of before are done: one has room
    }
    return copies_.wait();
}

// Two publishes may be several steps apart: the factor between them is that of the moment the host shows.
Status Outputs::interpolate(double interpolation) {
    if (interpolated() == 0 || published_ == 0 || !state_.device().finished(interpolations_[0])) return ok_status();
    const std::uint64_t from = sets_[previous()].step, to = sets_[current()].step;
    StepInput input{};
    input.interpolation = 1.0F;
    if (to > from) {
        const double factor = 1.0 - (1.0 - interpolation) / static_cast<double>(to - from);
        input.interpolation = static_cast<float>(factor);
    }
    const std::size_t set = current();
    auto& program = interpolate_[set];
    if (!program) {
        program.emplace(state_, "interpolate", [this, set](compute::ProgramBuilder& builder, const Parity& parity) {
            return build_interpolation(builder, parity, set);
        });
    }
    auto ticket = program->submit(input);
    if (!ticket) return ticket.status();
    interpolations_ = {interpolations_[1], *ticket};
    return ok_status();
}

Result<OutputView> Outputs::view(Output output, OutputSet set) const {
    const std::string name = kind_of(output).name;
    const bool between = set == OutputSet::interpolated;
    if (((between ? interpolated() : fields_of(asked_)) & bit(output)) == 0)
        return not_asked((between ? "the interpolated output " : "output ") + name);
    const bool missing = published_ < (set == OutputSet::previous ? 2u : 1u);
    if (missing) return error(Code::not_ready, "output " + name + " was not published yet; it is after the next update");
    const std::size_t at = set == OutputSet::previous ? previous() : current();
    OutputView view;
    view.buffer = between ? buffers_[interpolated_label(output)] : buffer(output, at);
    auto native = (*state_.device()).native(view.buffer);
    if (!native) return native.status();
    view.native = *native;
    view.format = kind_of(output).format;
    view.offset = first_byte(output);
    view.row_pitch = static_cast<std::uint64_t>(state_.layout().pitch()) * view.format.bytes();
    view.nx = state_.layout().nx;
    view.ny = state_.layout().ny;
    view.step = sets_[at].step;
    view.finished = state_.device().finished(between ? interpolations_[1] : sets_[at].ticket);
    return view;
}

Status Outputs::copy_to_image(Output output, OutputSet set, const Region& cells, const compute::HostImage& to) {
    auto found = view(output, set);
    if (!found) return found.status();
    const std::uint64_t bytes = found->format.bytes();
    const compute::BufferRows from{.buffer = found->buffer,
                                   .offset = found->offset + static_cast<std::uint64_t>(cells.j0) * found->row_pitch +
                                             static_cast<std::uint64_t>(cells.i0) * bytes,
                                   .row_pitch = found->row_pitch,
                                   .texel_bytes = static_cast<std::uint32_t>(bytes),
                                   .width = static_cast<std::uint32_t>(cells.nx),
                                   .height = static_cast<std::uint32_t>(cells.ny)};
    return (*state_.device()).host_sync()->copy_to_image(from, to).status(); // of a front end: never null
}

Result<Outputs::HostView> Outputs::host_view(Output output) {
    const auto& kind = kind_of(output);
    if ((asked_.host & bit(output)) == 0) return not_asked(std::string("the host copy of output ") + kind.name);
    auto copy = copies_.newest();
    if (!copy) return copy.status();
    const auto& contents = (*copy)->contents.at(kind.name);
    return HostView{contents.data(), static_cast<std::uint64_t>(state_.layout().pitch()) * kind.format.bytes(), (*copy)->step};
}

Result<Tiles> Outputs::tiles() {
    if ((asked_.mask & tiles_bit) == 0) return not_asked("tiles");
    auto copy = copies_.newest();
    if (!copy) return copy.status();
    const auto& contents = (*copy)->contents;
    return Tiles{state_.layout(), contents.at("tile_range"), contents.at("tile_changed"), (*copy)->step};
}

} // namespace wadi
