#include "backends/cpu/host_memory.hpp"
#include <algorithm>
#include <fstream>
#include <sys/mman.h>
#include <unistd.h>
#include <vector>

namespace wadi::cpu {
namespace {

// The system fills bytes that are unsigned on Linux and not on macOS.
template <typename Data, typename Byte>
int ask_resident(int (*ask)(Data, std::size_t, Byte*), void* data, std::size_t bytes, unsigned char* resident) {
    return ask(data, bytes, reinterpret_cast<Byte*>(resident));
}

} // namespace

std::uint64_t physical_memory() {
    const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size) : 0;
}

std::string processor_name() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);) {
        // x86 and some others; on most ARM machines the line is "CPU part", a number.
        if ((line.rfind("model name", 0) == 0 || line.rfind("Model", 0) == 0) && line.find(": ") != std::string::npos)
            return line.substr(line.find(": ") + 2);
    }
    return "CPU";
}

std::byte* map_pages(std::size_t bytes, std::size_t alignment, [[maybe_unused]] bool large) {
    // Large pages begin at multiples of their size: what lies around is unmapped.
    void* const block =
        mmap(nullptr, bytes + alignment, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (block == MAP_FAILED) return nullptr;
    auto* const begin = static_cast<std::byte*>(block);
    const std::size_t ahead = (alignment - reinterpret_cast<std::uintptr_t>(begin) % alignment) % alignment;
    if (ahead > 0) munmap(begin, ahead);
    munmap(begin + ahead + bytes, alignment - ahead);
#if defined(MADV_HUGEPAGE)
    madvise(begin + ahead, bytes, large ? MADV_HUGEPAGE : MADV_NOHUGEPAGE); // a system without them says no
#endif
    return begin + ahead;
}

void unmap_pages(std::byte* data, std::size_t bytes) { munmap(data, bytes); }

std::uint64_t resident_pages(std::byte* data, std::size_t pages, std::size_t page) {
    std::vector<unsigned char> resident(pages);
    if (ask_resident(mincore, data, pages * page, resident.data()) != 0) return 0;
    return static_cast<std::uint64_t>(std::count_if(resident.begin(), resident.end(), [](unsigned char r) { return r & 1; }));
}

void forget_pages(std::byte* data, std::size_t bytes) {
#if defined(__linux__)
    madvise(data, bytes, MADV_DONTNEED);
#else // elsewhere that is advice, and what was there may stay: other pages take its place
    mmap(data, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED, -1, 0);
#endif
}

} // namespace wadi::cpu
