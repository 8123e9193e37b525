#include "backends/common/front_end.hpp"
#include "backends/common/group_size.hpp"
#include "engine/compute/hazards.hpp"
#include <algorithm>

namespace wadi::backends {

namespace {

Status status_of(const Status& status) { return status; }
template <class T> Status status_of(const Result<T>& result) { return result.status(); }

// A row made ahead of the handle that it is for, so that nothing can fail once the backend has made the thing.
template <class Row> auto row_for(std::map<std::uint32_t, Row>&, Row row) {
    std::map<std::uint32_t, Row> apart;
    apart.emplace(0, std::move(row));
    return apart.extract(0);
}
template <class Row, class Node> void keep(std::map<std::uint32_t, Row>& rows, Node node, std::uint32_t id) {
    node.key() = id;
    rows.insert(std::move(node));
}

constexpr const char* semaphores = "timeline semaphores";
constexpr const char* events = "CUDA events";
constexpr const char* images = "images";
constexpr const char* memory = "device memory";
constexpr const char* command_buffers = "command buffers";

Status check_given(bool given, const char* call, const char* what) {
    return given ? ok_status() : error(Code::bad_argument, std::string(call) + ": the " + what + " is null");
}
Status check_semaphore(const compute::SyncPoint& point, const char* call) {
    return check_given(point.semaphore != 0, call, "semaphore");
}

} // namespace

template <class Call> auto FrontEnd::unless_lost(Call call) -> decltype(call()) {
    return guarded([&]() -> decltype(call()) {
        if (!lost_) return lost_;
        auto result = call();
        if (!result && status_of(result).code == Code::device_lost) lost_ = status_of(result);
        return result;
    });
}

void FrontEnd::inject_device_lost() {
    lost_ =
        error(Code::device_lost, "the device " + capabilities().name + " (" + capabilities().backend + ") was lost (injected)");
}

Result<compute::Buffer> FrontEnd::create_buffer(const compute::BufferDesc& desc) {
    return unless_lost([&]() -> Result<compute::Buffer> {
        const std::uint64_t largest = capabilities().largest_buffer_bytes;
        if (desc.bytes == 0 || desc.bytes > largest) {
            return error(Code::bad_argument, "size of buffer '" + desc.label + "' is " + std::to_string(desc.bytes) +
                                                 " bytes; allowed on " + capabilities().name + " are 1 to " +
                                                 std::to_string(largest));
        }
        auto row = row_for(objects_.buffers, {desc.bytes, desc.label, desc.host != compute::HostAccess::none});
        auto made = device_->create_buffer(desc);
        if (made) keep(objects_.buffers, std::move(row), made->id);
        return made;
    });
}

std::span<std::byte> FrontEnd::mapped(compute::Buffer buffer) {
    const auto found = objects_.buffers.find(buffer.id);
    return found != objects_.buffers.end() && found->second.host ? device_->mapped(buffer) : std::span<std::byte>{};
}

void FrontEnd::destroy_buffer(compute::Buffer buffer) {
    if (objects_.buffers.erase(buffer.id) == 0) return;
    for (auto& [id, program] : programs_) {
        if (program.buffers.count(buffer.id) != 0) program.gone = buffer.id;
    }
    device_->destroy_buffer(buffer);
}

Status FrontEnd::write(compute::Buffer buffer, std::uint64_t offset, std::span<const std::byte> bytes) {
    return unless_lost([&] {
        Status status = check_range(objects_, buffer, offset, bytes.size(), "write");
        return !status || bytes.empty() ? status : device_->write(buffer, offset, bytes);
    });
}

Status FrontEnd::read(compute::Buffer buffer, std::uint64_t offset, std::span<std::byte> bytes) {
    return unless_lost([&] {
        Status status = check_range(objects_, buffer, offset, bytes.size(), "read");
        return !status || bytes.empty() ? status : device_->read(buffer, offset, bytes);
    });
}

Result<compute::Pipeline> FrontEnd::create_pipeline(int index, std::uint32_t effects, compute::GroupSize asked) {
    return unless_lost([&]() -> Result<compute::Pipeline> {
        if (auto status = check_stage(index); !status) return status;
        const auto& stage = compute::stage_table()[static_cast<std::size_t>(index)];
        effects &= stage.tested_effects;
        const auto lacks = [&](const char* what) {
            return error(Code::not_supported,
                         "stage " + std::string(stage.name) + ": " + capabilities().name + " has no " + what);
        };
        if (stage.fused() && !capabilities().fused_stages) return lacks("groups large enough for fused stages");
        auto group = choose_group(stage, asked, capabilities().groups);
        if (!group) return group.status();
        const Objects::Pipeline wanted{index, effects, *group};
        for (const auto& [id, pipeline] : objects_.pipelines) {
            if (pipeline == wanted) return compute::Pipeline{id};
        }
        auto row = row_for(objects_.pipelines, wanted);
        auto made = device_->create_pipeline(index, effects, *group);
        if (made) keep(objects_.pipelines, std::move(row), made->id);
        return made;
    });
}

Result<compute::Program> FrontEnd::compile(const compute::ProgramBuilder& builder, const WorldParams& params) {
    return unless_lost([&]() -> Result<compute::Program> {
        if (auto status = check_program(builder, params, objects_); !status) return status;
        Program used{builder.label(), {}, static_cast<std::size_t>(builder.inputs())};
        for (const auto& op : builder.ops())
            for (const auto& use : compute::buffer_uses(op)) used.buffers.insert(use.buffer.id);
        auto row = row_for(programs_, std::move(used));
        auto made = device_->compile(builder, params);
        if (made) keep(programs_, std::move(row), made->id);
        return made;
    });
}

void FrontEnd::destroy_program(compute::Program program) {
    if (programs_.erase(program.id) != 0) device_->destroy_program(program);
}

Result<compute::Ticket> FrontEnd::submit_inputs(compute::Program program, std::span<const StepInput> inputs) {
    return unless_lost([&]() -> Result<compute::Ticket> {
        const auto found = programs_.find(program.id);
        if (found == programs_.end())
            return error(Code::bad_argument, "submit: no program has the handle " + std::to_string(program.id));
        const Program& known = found->second;
        const auto refuse = [&](const std::string& what) {
            return error(Code::bad_argument, "submit: program '" + known.label + "': " + what);
        };
        if (known.gone != 0) return refuse("its buffer with the handle " + std::to_string(known.gone) + " was destroyed");
        if (inputs.size() != known.inputs)
            return refuse(std::to_string(inputs.size()) + " inputs for the " + std::to_string(known.inputs) + " that it reads");
        auto ticket = device_->submit_inputs(program, inputs);
        if (ticket) newest_ = *ticket;
        return ticket;
    });
}

Status FrontEnd::check_given_out(compute::Ticket ticket) const {
    if (ticket.value <= newest_.value) return ok_status();
    return error(Code::bad_argument, "ticket " + std::to_string(ticket.value) + " was never given out; the newest is " +
                                         std::to_string(newest_.value));
}

bool FrontEnd::finished(compute::Ticket ticket) {
    if (!lost_) return true; // nothing is going to run any more
    const auto done = guarded([&]() -> Result<bool> { return ticket.value <= newest_.value && device_->finished(ticket); });
    return done && *done;
}

Status FrontEnd::wait(compute::Ticket ticket) {
    return unless_lost([&] {
        Status status = check_given_out(ticket);
        return status ? device_->wait(ticket) : status;
    });
}

Result<std::vector<compute::Timing>> FrontEnd::timings(compute::Ticket ticket) {
    return unless_lost([&]() -> Result<std::vector<compute::Timing>> {
        if (auto status = check_given_out(ticket); !status) return status;
        if (!device_->finished(ticket))
            return error(Code::bad_argument, "ticket " + std::to_string(ticket.value) + " has not finished; wait for it first");
        return device_->timings(ticket);
    });
}

Result<compute::NativeBuffer> FrontEnd::native(compute::Buffer buffer) {
    return guarded([&]() -> Result<compute::NativeBuffer> {
        if (auto status = check_range(objects_, buffer, 0, 0, "native"); !status) return status;
        return device_->native(buffer);
    });
}

template <class Call>
auto FrontEnd::with_host_sync(const char* what, Call call) -> decltype(call(std::declval<compute::HostSync&>())) {
    compute::HostSync* sync = device_->host_sync();
    if (sync == nullptr) return compute::no_host_sync(capabilities().backend, what);
    return call(*sync);
}

Status FrontEnd::wait_before(std::span<const compute::SyncPoint> points) {
    return unless_lost([&] {
        for (const auto& point : points) {
            if (auto status = check_semaphore(point, "wait_before"); !status) return status;
        }
        if (points.empty()) return ok_status();
        return with_host_sync(semaphores, [&](compute::HostSync& sync) { return sync.wait_before(points); });
    });
}

Status FrontEnd::signal_after(const compute::SyncPoint& point) {
    return unless_lost([&] {
        if (auto status = check_semaphore(point, "signal_after"); !status) return status;
        return with_host_sync(semaphores, [&](compute::HostSync& sync) { return sync.signal_after(point); });
    });
}

Status FrontEnd::wait_event(void* event) {
    return unless_lost([&] {
        if (auto status = check_given(event != nullptr, "wait_event", "event"); !status) return status;
        return with_host_sync(events, [&](compute::HostSync& sync) { return sync.wait_event(event); });
    });
}

Status FrontEnd::record_event(void* event) {
    return unless_lost([&] {
        if (auto status = check_given(event != nullptr, "record_event", "event"); !status) return status;
        return with_host_sync(events, [&](compute::HostSync& sync) { return sync.record_event(event); });
    });
}

Result<compute::Ticket> FrontEnd::copy_to_image(const compute::BufferRows& from, const compute::HostImage& to) {
    return unless_lost([&]() -> Result<compute::Ticket> {
        constexpr const char* call = "copy_to_image";
        if (auto status = check_given(to.image != 0, call, "image"); !status) return status;
        const bool whole = from.texel_bytes != 0 && from.offset % from.texel_bytes == 0 && from.row_pitch % from.texel_bytes == 0;
        const std::uint64_t row = std::uint64_t{from.width} * from.texel_bytes;
        if (!whole || row == 0 || from.height == 0 || row > from.row_pitch)
            return error(Code::bad_argument, std::string(call) + ": rows of " + std::to_string(from.width) + " texels of " +
                                                 std::to_string(from.texel_bytes) + " bytes, " + std::to_string(from.height) +
                                                 " of them " + std::to_string(from.row_pitch) + " bytes apart from byte " +
                                                 std::to_string(from.offset) + " on, are none");
        const std::uint64_t bytes = (from.height - 1) * from.row_pitch + row;
        if (auto status = check_range(objects_, from.buffer, from.offset, bytes, call); !status) return status;
        auto ticket = with_host_sync(images, [&](compute::HostSync& sync) { return sync.copy_to_image(from, to); });
        if (ticket) newest_ = *ticket;
        return ticket;
    });
}

Result<compute::Ticket> FrontEnd::copy_from(const compute::HostRows& from, compute::Buffer to) {
    return unless_lost([&]() -> Result<compute::Ticket> {
        constexpr const char* call = "copy_from";
        if (auto status = check_given(from.handle != 0, call, "handle"); !status) return status;
        const std::uint64_t row = std::uint64_t{from.width} * 4;
        if (from.offset % 4 != 0 || from.row_pitch % 4 != 0 || row == 0 || from.height == 0 || row > from.row_pitch)
            return error(Code::bad_argument, std::string(call) + ": rows of " + std::to_string(from.width) + " numbers, " +
                                                 std::to_string(from.height) + " of them " + std::to_string(from.row_pitch) +
                                                 " bytes apart from byte " + std::to_string(from.offset) + " on, are none");
        if (auto status = check_range(objects_, to, 0, row * from.height, call); !status) return status;
        auto ticket = with_host_sync(memory, [&](compute::HostSync& sync) { return sync.copy_from(from, to); });
        if (ticket) newest_ = *ticket;
        return ticket;
    });
}

Status FrontEnd::begin_recording(void* commands, const compute::SyncPoint& promise) {
    return unless_lost([&] {
        if (auto status = check_semaphore(promise, "begin_recording"); !status) return status;
        if (auto status = check_given(commands != nullptr, "begin_recording", "command buffer"); !status) return status;
        if (recording_) return error(Code::bad_argument, "begin_recording: a recording is under way; end it first");
        Status status =
            with_host_sync(command_buffers, [&](compute::HostSync& sync) { return sync.begin_recording(commands, promise); });
        recording_ = bool(status);
        return status;
    });
}

Status FrontEnd::end_recording() {
    return unless_lost([&] {
        if (!recording_) return error(Code::bad_argument, "end_recording: no recording is under way");
        recording_ = false;
        return with_host_sync(command_buffers, [](compute::HostSync& sync) { return sync.end_recording(); });
    });
}

} // namespace wadi::backends
