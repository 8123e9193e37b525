#include "engine/step/active_count.hpp"
#include <algorithm>
#include <array>
#include <cstring>

namespace wadi {

namespace {

using Counts = std::array<std::uint32_t, 2>; // one per list

} // namespace

Status ActiveCount::append(compute::ProgramBuilder& builder, int turn) {
    auto& slot = slots_[static_cast<std::size_t>(turn)];
    if (slot.buffer.id == 0) {
        auto made = state_.make_buffer({sizeof(Counts), "active count " + std::to_string(turn), compute::HostAccess::readback});
        if (!made) return made.status();
        slot.buffer = *made;
    }
    std::uint64_t at = 0;
    for (const auto count : state_.active_counts()) {
        builder.copy({count, slot.buffer, 0, at, sizeof(std::uint32_t)});
        at += sizeof(std::uint32_t);
    }
    return ok_status();
}

void ActiveCount::submitted(int turn, compute::Ticket ticket, bool woken) {
    slots_[static_cast<std::size_t>(turn)].ticket = ticket;
    if (woken) woken_ = ticket.value;
}

bool ActiveCount::asleep() {
    for (const auto& slot : slots_) {
        // Only where no submission can be writing it.
        if (slot.ticket.value <= seen_ || !state_.device().finished(slot.ticket)) continue;
        Counts counts{};
        std::memcpy(counts.data(), state_.device().mapped(slot.buffer).data(),
                    sizeof(std::uint32_t) * state_.active_counts().size());
        newest_ = *std::max_element(counts.begin(), counts.end());
        seen_ = slot.ticket.value;
        report(newest_);
    }
    return newest_ == 0 && seen_ > woken_;
}

void ActiveCount::report(std::uint32_t count) {
    const double tiles = static_cast<double>(state_.params().tile_columns) * static_cast<double>(state_.params().tile_rows);
    const bool above = static_cast<double>(count) > state_.settings().active_tiles_most * tiles;
    if (above && !above_ && state_.log)
        state_.log(1, "step " + std::to_string(state_.steps) + ": " + std::to_string(count) + " of " +
                          std::to_string(static_cast<std::uint64_t>(tiles)) +
                          " tiles are active, more than active_tiles_most allows");
    above_ = above;
}

} // namespace wadi
