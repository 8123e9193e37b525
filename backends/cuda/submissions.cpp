#include "backends/cuda/submissions.hpp"
#include <algorithm>

namespace wadi::cuda {

Status Submissions::open() {
    c_.capabilities.queue_depth = most_in_flight;
    auto inputs = allocate(c_, compute::most_inputs * sizeof(StepInput), "step inputs");
    if (!inputs) return inputs.status();
    inputs_ = std::move(*inputs);
    void* staging = nullptr;
    const cudaError_t r =
        cudaHostAlloc(&staging, most_in_flight * compute::most_inputs * sizeof(StepInput), cudaHostAllocDefault);
    if (Status s = c_.check(r, "cudaHostAlloc", "step inputs"); !s) return s;
    staging_ = static_cast<StepInput*>(staging);
    for (Slot& slot : slots_) {
        const cudaError_t made = cudaEventCreateWithFlags(&slot.done, cudaEventDisableTiming);
        if (Status s = c_.check(made, "cudaEventCreateWithFlags"); !s) return s;
    }
    return ok_status();
}

Submissions::~Submissions() {
    const CurrentContext current(c_);
    for (const Slot& slot : slots_) {
        if (slot.done != nullptr) c_.note(cudaEventDestroy(slot.done), "cudaEventDestroy");
    }
    if (staging_ != nullptr) c_.note(cudaFreeHost(staging_), "cudaFreeHost", "step inputs");
    release(c_, inputs_);
}

Result<std::size_t> Submissions::acquire() {
    const std::size_t slot = slot_of(last_ + 1);
    if (Status s = wait({slots_[slot].ticket}); !s) return s;
    return slot;
}

Status Submissions::begin(std::size_t slot, std::span<const StepInput> inputs) {
    StepInput* staged = staging_ + slot * compute::most_inputs;
    std::ranges::copy(inputs, staged);
    const cudaError_t r = cudaMemcpyAsync(inputs_.data, staged, inputs.size_bytes(), cudaMemcpyHostToDevice, c_.stream);
    return c_.check(r, "cudaMemcpyAsync", inputs_.label);
}

Result<compute::Ticket> Submissions::finish(std::size_t index, compute::Program program) {
    Slot& slot = slots_[index];
    if (Status s = c_.check(cudaEventRecord(slot.done, c_.stream), "cudaEventRecord"); !s) return s;
    ++c_.counters.submits;
    slot.ticket = ++last_;
    slot.program = program;
    return compute::Ticket{last_};
}

Result<bool> Submissions::finished(compute::Ticket ticket) {
    if (ticket.value <= finished_) return true;
    const cudaError_t r = cudaEventQuery(slots_[slot_of(ticket.value)].done);
    if (r == cudaErrorNotReady) return false;
    if (Status s = c_.check(r, "cudaEventQuery"); !s) return s;
    finished_ = ticket.value;
    return true;
}

Status Submissions::wait(compute::Ticket ticket) {
    if (ticket.value <= finished_) return ok_status();
    if (Status s = c_.check(cudaEventSynchronize(slots_[slot_of(ticket.value)].done), "waiting for a submission"); !s) return s;
    finished_ = ticket.value;
    return ok_status();
}

compute::Program Submissions::program_of(compute::Ticket ticket) const {
    const Slot& slot = slots_[slot_of(ticket.value)];
    return ticket.value != 0 && slot.ticket == ticket.value ? slot.program : compute::Program{};
}

} // namespace wadi::cuda
