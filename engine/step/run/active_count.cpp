#include "engine/step/run/active_count.hpp"
#include <algorithm>
#include <array>
#include <cstring>

namespace wadi {

namespace {

using Counts = std::array<std::uint32_t, 2>; // one per list

// Whose first word is how many tiles the newest step ran over: one per list of tiles.
std::vector<compute::Buffer> counters(WorldState& state) {
    std::vector<compute::Buffer> buffers;
    for (const auto& ending : state.plan().tile_lists())
        if (ending != "_mixture") buffers.push_back(state.fields().buffer(tile_list(ending).back())); // it is part of both others
    return buffers;
}

} // namespace

Result<std::vector<std::uint32_t>> read_active_counts(WorldState& state) {
    std::vector<std::uint32_t> counts;
    for (const auto from : counters(state)) {
        counts.push_back(0);
        if (auto status = state.device().read(from, 0, std::as_writable_bytes(std::span(&counts.back(), 1))); !status)
            return status;
    }
    return counts;
}

Status ActiveCount::append(compute::ProgramBuilder& builder, int turn) {
    auto& slot = slots_[static_cast<std::size_t>(turn)];
    if (slot.buffer.id == 0) {
        auto made = state_.device().create_buffer(
            {sizeof(Counts), "active count " + std::to_string(turn), compute::HostAccess::readback});
        if (!made) return made.status();
        slot.buffer = *made;
    }
    std::uint64_t at = 0;
    for (const auto from : counters(state_)) {
        builder.copy({from, slot.buffer, 0, at, sizeof(std::uint32_t)});
        at += sizeof(std::uint32_t);
    }
    return ok_status();
}

void ActiveCount::submitted(int turn, compute::Ticket ticket, bool woken) {
    slots_[static_cast<std::size_t>(turn)].ticket = ticket;
    two_lists_ = state_.plan().tiles_by_material;
    if (woken) woken_ = ticket.value;
}

ActiveCount::Newest ActiveCount::newest() {
    const std::size_t lists = two_lists_ ? 2 : 1;
    for (const auto& slot : slots_) {
        // Only where no submission can be writing it.
        if (slot.ticket.value <= seen_ || !state_.device().finished(slot.ticket)) continue;
        Counts counts{};
        std::memcpy(counts.data(), state_.device().mapped(slot.buffer).data(), lists * sizeof(std::uint32_t));
        newest_ = *std::max_element(counts.begin(), counts.end());
        seen_ = slot.ticket.value;
    }
    return {seen_, newest_};
}

bool ActiveCount::asleep() {
    const auto [seen, count] = newest();
    return count == 0 && seen > woken_;
}

} // namespace wadi
