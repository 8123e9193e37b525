#include "backends/cpu/host_memory.hpp"
#include <algorithm>
#include <cstring>
#include <mutex>
#include <new>
#include <set>

namespace wadi::cpu {

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

std::shared_ptr<Pages> Pages::map(std::size_t bytes, bool large) {
    const std::size_t whole = rounded_up(bytes, large_page);
    std::byte* const data = map_pages(whole, large_page, large);
    if (data == nullptr) return nullptr;
    try {
        return std::make_shared<Pages>(data, whole);
    } catch (const std::bad_alloc&) {
        unmap_pages(data, whole);
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
    unmap_pages(data_, bytes_);
}

std::uint64_t Pages::resident_bytes() {
    const std::lock_guard lock(mapped().mutex);
    std::uint64_t pages = 0;
    for (const auto* mapping : mapped().pages)
        pages += resident_pages(mapping->data(), mapping->bytes() / small_page, small_page);
    return pages * small_page;
}

void Pages::forget(std::byte* data, std::size_t bytes) {
    const auto begin = reinterpret_cast<std::uintptr_t>(data), end = (begin + bytes) / small_page * small_page;
    const std::size_t first = rounded_up(begin, small_page) - begin;
    if (begin + first < end) forget_pages(data + first, end - begin - first);
}

std::shared_ptr<std::byte> PageArena::take(std::size_t bytes, std::size_t offset) {
    // Twice as much with every mapping: a world of a few cells takes no more than it needs.
    constexpr std::size_t least = large_page, most = std::size_t{64} << 20;
    const auto place = [&](std::size_t used) { return rounded_up(used, small_page) + offset; };
    auto pages = pages_.lock();
    if (!pages || place(used_) + bytes > pages->bytes()) {
        next_ = std::min(most, std::max(least, 2 * next_));
        pages = Pages::map(std::max(next_, offset + bytes), large_ && next_ > least);
        if (!pages) return nullptr;
        pages_ = pages;
        used_ = 0;
    }
    std::byte* const data = pages->data() + place(used_);
    used_ = place(used_) + bytes;
    return {data, [kept = std::move(pages), bytes](std::byte* begin) { Pages::forget(begin, bytes); }}; // others keep the mapping
}

std::shared_ptr<std::byte> take_from(std::shared_ptr<const compute::Allocator> allocator, std::size_t bytes, std::size_t offset) {
    constexpr std::size_t alignment = 64; // a line of the cache, the widest vector
    const std::size_t whole = offset + bytes;
    auto* const begin = static_cast<std::byte*>(allocator->allocate(whole, alignment));
    if (begin == nullptr) return nullptr;
    std::memset(begin, 0, whole);
    return {begin + offset, [from = std::move(allocator), begin, whole](std::byte*) { from->free(begin, whole); }};
}

} // namespace wadi::cpu
