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

} // namespace wadi::cuda
