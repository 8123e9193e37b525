// What the backend asks of the operating system, or of the host in its place.
#pragma once
#include "engine/compute/device.hpp"
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace wadi::cpu {
std::uint64_t physical_memory(); // bytes; 0 = unknown
std::string processor_name();

// By the system's own calls; a page has 4 KiB, addresses and sizes are multiples of it.
/// Zeros at a multiple of `alignment` where the system has pages that gain by it; null where there is no memory. `large`: in
/// large pages.
std::byte* map_pages(std::size_t bytes, std::size_t alignment, bool large);
/// The whole of what map_pages gave.
void unmap_pages(std::byte* data, std::size_t bytes);
/// How many of these pages are in memory; 0 where the system does not say.
std::uint64_t resident_pages(std::byte* data, std::size_t pages, std::size_t page);
/// Gives the memory back; the pages hold zeros when they are touched again.
void forget_pages(std::byte* data, std::size_t bytes);

/// Zeros; the memory of pages that nobody has touched is not taken yet.
class Pages {
  public:
    /// Null where there is no memory. `large`: whether in large pages, where the system gives them.
    static std::shared_ptr<Pages> map(std::size_t bytes, bool large);
    Pages(std::byte* data, std::size_t bytes);
    ~Pages();
    Pages(const Pages&) = delete;
    Pages& operator=(const Pages&) = delete;

    std::byte* data() const { return data_; }
    std::size_t bytes() const { return bytes_; }
    /// Gives back the pages that lie within [data, data + bytes).
    static void forget(std::byte* data, std::size_t bytes);
    /// Of all Pages of the process, what was touched.
    static std::uint64_t resident_bytes();

  private:
    std::byte* data_;
    std::size_t bytes_;
};

/// Zeros in memory of the host's, at a multiple of 64 bytes; null where it refuses. Goes back to it with the last pointer.
std::shared_ptr<std::byte> take_from(std::shared_ptr<const compute::Allocator> allocator, std::size_t bytes, std::size_t offset);

/// Buffers side by side in a few large mappings: where each had its own, most would be too small for a large page.
class PageArena {
  public:
    explicit PageArena(bool large) : large_(large) {}
    /// Zeros, `offset` bytes behind a multiple of 4 KiB; null where there is no memory.
    std::shared_ptr<std::byte> take(std::size_t bytes, std::size_t offset);

  private:
    const bool large_;
    std::weak_ptr<Pages> pages_; // goes with the last of its buffers
    std::size_t used_ = 0;
    std::size_t next_ = 0; // bytes of the newest mapping but for a larger buffer
};
} // namespace wadi::cpu
