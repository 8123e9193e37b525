#include "backends/cpu/memory_budget.hpp"
#include "backends/cpu/host_memory.hpp"
#include "engine/compute/available_memory.hpp"
#include <algorithm>
#include <limits>

namespace wadi::cpu {

namespace {

// A look takes some 0.1 ms and more where much is mapped: it holds for so long and for so many bytes.
constexpr std::chrono::seconds holds_for{10};
constexpr std::uint64_t holds_for_bytes = std::uint64_t{256} << 20;
// The last part of that is not taken without another look: levels and threads took some that nobody asked for.
constexpr std::uint64_t looks_again_below = std::uint64_t{128} << 20;
// Left for what is no buffer: a level while it is drawn, threads, the system's own pages. Without a least, nothing is left of it
// where little is available.
constexpr std::uint64_t least_left = std::uint64_t{32} << 20;

} // namespace

MemoryBudget& MemoryBudget::of_process() {
    static MemoryBudget& budget = *new MemoryBudget; // worlds may outlive the process's static objects
    return budget;
}

std::uint64_t MemoryBudget::measure() const {
    const std::uint64_t resident = Pages::resident_bytes();
    std::uint64_t available = available_memory(), untouched = promised_ > resident ? promised_ - resident : 0;
    if (available == 0) { // the system does not say: as if nothing else took any
        available = physical_memory();
        untouched = promised_;
    }
    if (available == 0) return std::numeric_limits<std::uint64_t>::max();
    const std::uint64_t taken = untouched + std::max(available / 10, least_left);
    return available > taken ? available - taken : 0;
}

bool MemoryBudget::take(std::uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    const auto now = std::chrono::steady_clock::now();
    if (bytes + looks_again_below > granted_ || now - looked_ > holds_for) {
        granted_ = std::min(measure(), std::max(bytes + looks_again_below, holds_for_bytes));
        looked_ = now;
    }
    if (bytes > granted_) return false;
    granted_ -= bytes;
    promised_ += bytes;
    return true;
}

void MemoryBudget::give_back(std::uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    promised_ -= bytes;
}

std::uint64_t MemoryBudget::room() {
    const std::lock_guard lock(mutex_);
    return measure();
}

} // namespace wadi::cpu
