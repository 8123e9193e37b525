#include "backends/cpu/host_memory.hpp"
#include <algorithm>
#include <fstream>
#include <mutex>
#include <new>
#include <set>
#include <sys/mman.h>
#include <unistd.h>
#include <vector>

namespace wadi::cpu {

std::uint64_t physical_memory() {
    const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size) : 0;
}

std::string processor_name() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);) {
        if (line.rfind("model name", 0) == 0 && line.find(':') != std::string::npos) return line.substr(line.find(':') + 2);
    }
    return "CPU";
}

namespace {
constexpr std::size_t small_page = 4096, large_page = std::size_t{2} << 20;
std::size_t rounded_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }

// Never destroyed: worlds may outlive the process's static objects.
struct Mapped {
    std::mutex mutex;
    std::set<const Pages*> pages;
};
Mapped& mapped() {
    static Mapped& all = *new Mapped;
    return all;
}
} // namespace

std::shared_ptr<Pages> Pages::map(std::size_t bytes) {
    const std::size_t whole = rounded_up(bytes, large_page);
    void* const block =
        mmap(nullptr, whole + large_page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (block == MAP_FAILED) return nullptr;
    // Large pages begin at multiples of their size: what lies around is unmapped.
    auto* const begin = static_cast<std::byte*>(block);
    const std::size_t ahead = (large_page - reinterpret_cast<std::uintptr_t>(begin) % large_page) % large_page;
    if (ahead > 0) munmap(begin, ahead);
    munmap(begin + ahead + whole, large_page - ahead);
#if defined(MADV_HUGEPAGE)
    madvise(begin + ahead, whole, MADV_HUGEPAGE); // a system without them says no
#endif
    try {
        return std::make_shared<Pages>(begin + ahead, whole);
    } catch (const std::bad_alloc&) {
        munmap(begin + ahead, whole);
        throw;
    }
}

Pages::Pages(std::byte* data, std::size_t bytes) : data_(data), bytes_(bytes) {
    const std::lock_guard lock(mapped().mutex);
    mapped().pages.insert(this);
}

Pages::~Pages() {
    const std::lock_guard lock(mapped().mutex);
    mapped().pages.erase(this);
    munmap(data_, bytes_);
}

std::uint64_t Pages::resident_bytes() {
    const std::lock_guard lock(mapped().mutex);
    std::vector<unsigned char> resident;
    std::uint64_t pages = 0;
    for (const auto* mapping : mapped().pages) {
        resident.resize(mapping->bytes() / small_page);
        if (mincore(mapping->data(), mapping->bytes(), resident.data()) != 0) continue;
        pages +=
            static_cast<std::uint64_t>(std::count_if(resident.begin(), resident.end(), [](unsigned char r) { return r & 1; }));
    }
    return pages * small_page;
}

void Pages::forget(std::byte* data, std::size_t bytes) {
    const auto begin = reinterpret_cast<std::uintptr_t>(data), end = (begin + bytes) / small_page * small_page;
    const std::size_t first = rounded_up(begin, small_page) - begin;
    if (begin + first < end) madvise(data + first, end - begin - first, MADV_DONTNEED);
}

std::shared_ptr<std::byte> PageArena::take(std::size_t bytes, std::size_t offset) {
    constexpr std::size_t least = std::size_t{64} << 20;
    const auto place = [&](std::size_t used) { return rounded_up(used, small_page) + offset; };
    auto pages = pages_.lock();
    if (!pages || place(used_) + bytes > pages->bytes()) {
        pages = Pages::map(std::max(least, offset + bytes));
        if (!pages) return nullptr;
        pages_ = pages;
        used_ = 0;
    }
    std::byte* const data = pages->data() + place(used_);
    used_ = place(used_) + bytes;
    return {std::move(pages), data};
}

} // namespace wadi::cpu
