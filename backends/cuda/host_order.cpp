#include "backends/cuda/host_order.hpp"
#include <unistd.h>

namespace wadi::cuda {

HostOrder::~HostOrder() {
    const CurrentContext current(c_);
    for (const auto& [handle, semaphore] : imported_)
        c_.note(cudaDestroyExternalSemaphore(semaphore), "cudaDestroyExternalSemaphore");
}

Result<cudaExternalSemaphore_t> HostOrder::find(std::uint64_t semaphore) {
    if (const auto found = imported_.find(semaphore); found != imported_.end()) return found->second;
    auto descriptor = c_.options.lender->lend_semaphore(semaphore);
    if (!descriptor) return descriptor.status();
    cudaExternalSemaphoreHandleDesc import{};
    import.type = cudaExternalSemaphoreHandleTypeTimelineSemaphoreFd;
    import.handle.fd = *descriptor;
    cudaExternalSemaphore_t made = nullptr;
    if (Status s = c_.check(cudaImportExternalSemaphore(&made, &import), "cudaImportExternalSemaphore"); !s) {
        close(*descriptor);
        return s;
    }
    imported_[semaphore] = made;
    return made;
}

Status HostOrder::check_lender() const {
    return c_.options.lender != nullptr ? ok_status() : compute::no_host_sync(c_.capabilities.backend, "timeline semaphores");
}

Status HostOrder::wait_before(std::span<const compute::SyncPoint> points) {
    if (Status s = check_lender(); !s) return s;
    const CurrentContext current(c_);
    for (const compute::SyncPoint& point : points) {
        auto semaphore = find(point.semaphore);
        if (!semaphore) return semaphore.status();
        cudaExternalSemaphoreWaitParams params{};
        params.params.fence.value = point.value;
        const cudaError_t r = cudaWaitExternalSemaphoresAsync(&*semaphore, &params, 1, c_.stream);
        if (Status s = c_.check(r, "cudaWaitExternalSemaphoresAsync"); !s) return s;
    }
    return ok_status();
}

Status HostOrder::signal_after(const compute::SyncPoint& point) {
    if (Status s = check_lender(); !s) return s;
    const CurrentContext current(c_);
    auto semaphore = find(point.semaphore);
    if (!semaphore) return semaphore.status();
    cudaExternalSemaphoreSignalParams params{};
    params.params.fence.value = point.value;
    const cudaError_t r = cudaSignalExternalSemaphoresAsync(&*semaphore, &params, 1, c_.stream);
    return c_.check(r, "cudaSignalExternalSemaphoresAsync");
}

// What the runtime says of handles that are no events, or of another context.
Status HostOrder::check_event(cudaError_t result, const char* what) {
    if (result != cudaErrorInvalidResourceHandle && result != cudaErrorInvalidValue) return c_.check(result, what);
    static_cast<void>(cudaGetLastError()); // else the runtime would report it again from a later call
    return error(Code::bad_argument, std::string(what) + ": the event is none of the primary context of " + c_.capabilities.name);
}

Status HostOrder::wait_event(void* event) {
    const CurrentContext current(c_);
    return check_event(cudaStreamWaitEvent(c_.stream, static_cast<cudaEvent_t>(event), 0), "cudaStreamWaitEvent");
}

Status HostOrder::record_event(void* event) {
    const CurrentContext current(c_);
    return check_event(cudaEventRecord(static_cast<cudaEvent_t>(event), c_.stream), "cudaEventRecord");
}

Result<compute::Ticket> HostOrder::copy_from(const compute::HostRows& from, compute::Buffer to) {
    const CurrentContext current(c_);
    auto slot = submissions_.acquire();
    if (!slot) return slot.status();
    const void* rows = reinterpret_cast<const void*>(static_cast<std::uintptr_t>(from.handle + from.offset));
    const std::size_t row = std::size_t{from.width} * 4;
    const cudaError_t r =
        cudaMemcpy2DAsync(buffers_.find(to)->data, row, rows, from.row_pitch, row, from.height, cudaMemcpyDefault, c_.stream);
    if (r == cudaErrorInvalidValue) {
        static_cast<void>(cudaGetLastError()); // else the runtime would report it again from a later call
        return error(Code::bad_argument, "cudaMemcpy2DAsync: the address is none of " + c_.capabilities.name);
    }
    if (Status s = c_.check(r, "cudaMemcpy2DAsync"); !s) return s;
    return submissions_.finish(*slot, {});
}

Result<compute::Ticket> HostOrder::copy_to_image(const compute::BufferRows&, const compute::HostImage&) {
    return compute::no_host_sync(c_.capabilities.backend, "images");
}

Status HostOrder::begin_recording(void*, const compute::SyncPoint&) { return end_recording(); }

Status HostOrder::end_recording() { return compute::no_host_sync(c_.capabilities.backend, "command buffers"); }

} // namespace wadi::cuda
