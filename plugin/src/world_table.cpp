#include "plugin/src/world_table.hpp"
#include <atomic>
#if !defined(_WIN32)
#include <pthread.h>
#include <unistd.h>
#endif

namespace wadi::plugin {

namespace {

// Of all tables, so that an id from before a fork is none of the child's.
std::atomic<std::uint32_t> newest_generation{0};

#if defined(_WIN32)
std::pair<long, long> this_process() { return {0, 0}; } // never forks
#else
std::atomic<long> forks{0}; // of this process and those that it came from

/// Counts forks as well: in a pid namespace of its own a child may have its parent's number.
std::pair<long, long> this_process() {
    [[maybe_unused]] static const int counting = pthread_atfork(nullptr, nullptr, [] { ++forks; });
    return {getpid(), forks};
}
#endif

} // namespace

wadi_world_id WorldTable::add(HostedWorld hosted) {
    const std::lock_guard lock(mutex_);
    std::size_t n = 0;
    while (n < slots_.size() && slots_[n].hosted) ++n;
    if (n == slots_.size()) slots_.emplace_back();
    auto& slot = slots_[n];
    slot.generation = ++newest_generation;
    slot.hosted = std::make_unique<HostedWorld>(std::move(hosted));
    return {static_cast<std::uint32_t>(n + 1), slot.generation};
}

WorldTable::Slot* WorldTable::find(wadi_world_id id) {
    if (id.index == 0 || id.index > slots_.size()) return nullptr;
    auto& slot = slots_[id.index - 1];
    return slot.generation == id.generation && slot.hosted ? &slot : nullptr;
}

Entry WorldTable::enter(wadi_world_id id, HostedWorld*& hosted) {
    const std::lock_guard lock(mutex_);
    auto* slot = find(id);
    if (slot == nullptr || slot->busy) return slot == nullptr ? Entry::unknown : Entry::busy;
    slot->busy = true;
    hosted = slot->hosted.get();
    return Entry::entered;
}

void WorldTable::leave(wadi_world_id id) {
    const std::lock_guard lock(mutex_);
    find(id)->busy = false;
}

Entry WorldTable::remove(wadi_world_id id) {
    std::unique_ptr<HostedWorld> gone; // destroyed after the lock is given back: that may take its time
    const std::lock_guard lock(mutex_);
    auto* slot = find(id);
    if (slot == nullptr || slot->busy) return slot == nullptr ? Entry::unknown : Entry::busy;
    gone = std::move(slot->hosted);
    return Entry::entered;
}

// Never destroyed: other threads of the host may be inside a call when the process ends. A forked child has a table of its own,
// since it has none of the threads that its parent's worlds need.
WorldTable& worlds() {
    static std::atomic<WorldTable*> newest{nullptr};
    WorldTable* table = newest.load();
    if (table != nullptr && table->process() == this_process()) return *table;
    auto mine = std::make_unique<WorldTable>(this_process(), table);
    return newest.compare_exchange_strong(table, mine.get()) ? *mine.release() : *table;
}

} // namespace wadi::plugin
