#include "engine/step/run/world_device.hpp"
#include <algorithm>
#include <numeric>

namespace wadi {

namespace {

const Status& status_of(const Status& status) { return status; }
template <class T> Status status_of(const Result<T>& result) { return result.status(); }

} // namespace

template <class Answer> Answer WorldDevice::noted(Answer answer) {
    if (answer) return answer;
    const Status status = status_of(answer);
    if (status.code != Code::device_lost) return answer;
    const bool news = static_cast<bool>(lost_);
    lost_ = status;
    if (news) on_loss_(status);
    return answer;
}

Status WorldDevice::give_up(const std::string& why) { return noted(error(Code::device_lost, why)); }

std::uint64_t WorldDevice::bytes() const {
    return std::accumulate(memory_.begin(), memory_.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const MemoryItem& item) { return sum + item.bytes; });
}

Result<compute::Buffer> WorldDevice::create_buffer(const compute::BufferDesc& desc) {
    memory_.push_back({{}, desc.label, desc.bytes}); // ahead: what was made is never lost for want of the host's memory
    auto made = noted(device_->create_buffer(desc));
    if (made) memory_.back().buffer = *made;
    if (!made) memory_.pop_back();
    return made;
}

void WorldDevice::destroy_buffer(compute::Buffer buffer) {
    if (buffer.id == 0) return;
    device_->destroy_buffer(buffer);
    std::erase_if(memory_, [&](const MemoryItem& item) { return item.buffer == buffer; });
}

Status WorldDevice::write(compute::Buffer buffer, std::uint64_t offset, std::span<const std::byte> bytes) {
    return noted(device_->write(buffer, offset, bytes));
}

Status WorldDevice::read(compute::Buffer buffer, std::uint64_t offset, std::span<std::byte> bytes) {
    return noted(device_->read(buffer, offset, bytes));
}

Result<compute::Pipeline> WorldDevice::create_pipeline(int stage, std::uint32_t effects, compute::GroupSize group) {
    return noted(device_->create_pipeline(stage, effects, group));
}

Result<compute::Program> WorldDevice::compile(const compute::ProgramBuilder& builder, const WorldParams& params) {
    return noted(device_->compile(builder, params));
}

void WorldDevice::destroy_program(compute::Program& program) {
    device_->destroy_program(program);
    program = {};
}

Result<compute::Ticket> WorldDevice::submit_inputs(compute::Program program, std::span<const StepInput> inputs) {
    return noted(device_->submit_inputs(program, inputs));
}

Status WorldDevice::wait(compute::Ticket ticket) { return noted(device_->wait(ticket)); }

Result<std::vector<compute::Timing>> WorldDevice::timings(compute::Ticket ticket) { return noted(device_->timings(ticket)); }

} // namespace wadi
