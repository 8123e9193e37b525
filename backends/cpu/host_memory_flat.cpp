#include "backends/cpu/host_memory.hpp"
#include <cstdlib>
#include <cstring>

// WebAssembly: one block of memory that only grows.
namespace wadi::cpu {

std::uint64_t physical_memory() { return 0; }

std::string processor_name() { return "WebAssembly"; }

std::byte* map_pages(std::size_t bytes, std::size_t, bool) {
    auto* const data = static_cast<std::byte*>(std::aligned_alloc(4096, bytes));
    if (data != nullptr) std::memset(data, 0, bytes);
    return data;
}

void unmap_pages(std::byte* data, std::size_t) { std::free(data); }

std::uint64_t resident_pages(std::byte*, std::size_t pages, std::size_t) { return pages; }

void forget_pages(std::byte* data, std::size_t bytes) { std::memset(data, 0, bytes); }

} // namespace wadi::cpu
