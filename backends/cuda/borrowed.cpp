#include "backends/cuda/borrowed.hpp"
#include <unistd.h>

namespace wadi::cuda {

// A descriptor belongs to CUDA once its import succeeded, and to us until then.
Result<BorrowedMemory> borrow(Context& c, std::uint64_t bytes, const std::string& label) {
    BorrowedMemory memory;
    auto lent = c.options.lender->lend_buffer(bytes, label);
    if (!lent) return lent.status();
    memory.lent = *lent;
    cudaExternalMemoryHandleDesc import{};
    import.type = cudaExternalMemoryHandleTypeOpaqueFd;
    import.handle.fd = lent->descriptor;
    import.size = lent->bytes;
    import.flags = cudaExternalMemoryDedicated;
    if (Status s = c.check(cudaImportExternalMemory(&memory.external, &import), "cudaImportExternalMemory", label); !s) {
        close(lent->descriptor);
        c.options.lender->take_back(*lent);
        return s;
    }
    cudaExternalMemoryBufferDesc view{};
    view.size = bytes;
    void* data = nullptr;
    const cudaError_t mapped = cudaExternalMemoryGetMappedBuffer(&data, memory.external, &view);
    if (Status s = c.check(mapped, "cudaExternalMemoryGetMappedBuffer", label); !s) {
        give_back(c, memory);
        return s;
    }
    memory.data = static_cast<std::byte*>(data);
    return memory;
}

void give_back(Context& c, BorrowedMemory& memory) {
    if (memory.data != nullptr) c.note(cudaFree(memory.data), "cudaFree");
    if (memory.external != nullptr) c.note(cudaDestroyExternalMemory(memory.external), "cudaDestroyExternalMemory");
    c.options.lender->take_back(memory.lent);
    memory = {};
}

Semaphores::~Semaphores() {
    const CurrentContext current(c_);
    for (const auto& [handle, semaphore] : imported_)
        c_.note(cudaDestroyExternalSemaphore(semaphore), "cudaDestroyExternalSemaphore");
}

Result<cudaExternalSemaphore_t> Semaphores::find(std::uint64_t semaphore) {
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

Status Semaphores::wait_before(std::span<const compute::SyncPoint> points) {
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

Status Semaphores::signal_after(const compute::SyncPoint& point) {
    const CurrentContext current(c_);
    auto semaphore = find(point.semaphore);
    if (!semaphore) return semaphore.status();
    cudaExternalSemaphoreSignalParams params{};
    params.params.fence.value = point.value;
    const cudaError_t r = cudaSignalExternalSemaphoresAsync(&*semaphore, &params, 1, c_.stream);
    return c_.check(r, "cudaSignalExternalSemaphoresAsync");
}

Status Semaphores::begin_recording(void*, const compute::SyncPoint&) { return end_recording(); }

Status Semaphores::end_recording() { return compute::no_host_sync(c_.capabilities.backend); }

} // namespace wadi::cuda
