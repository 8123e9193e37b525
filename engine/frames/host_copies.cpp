#include "engine/frames/host_copies.hpp"
#include <algorithm>
#include <utility>

namespace wadi {

std::string HostCopies::label(const Item& item, std::size_t slot) { return "host " + item.name + " " + std::to_string(slot); }

void HostCopies::destroy(Programs& programs) {
    for (auto& of_set : programs)
        for (auto& program : of_set) state_.device().destroy_program(program);
}

std::vector<compute::BufferDesc> HostCopies::wanted_buffers(const std::vector<Item>& items) const {
    std::vector<compute::BufferDesc> wanted;
    for (const auto& item : items) {
        for (std::size_t n = 0; n < slots; ++n) wanted.push_back({item.bytes, label(item, n), compute::HostAccess::readback});
    }
    return wanted;
}

// Every set into every slot: which meet depends on how far the device is, and no frame should record.
Status HostCopies::record(const std::vector<Item>& items, Programs& programs) {
    if (items.empty()) return ok_status();
    for (std::size_t set = 0; set < sets; ++set) {
        for (std::size_t slot = 0; slot < slots; ++slot) {
            compute::ProgramBuilder builder("host copies");
            for (const auto& item : items)
                builder.copy({item.from[set], buffers_[label(item, slot)], item.offset, 0, item.bytes});
            auto compiled = state_.device().compile(builder, state_.params());
            if (!compiled) return compiled.status();
            programs[set][slot] = *compiled;
        }
    }
    return ok_status();
}

Status HostCopies::set(const std::vector<Item>& items) {
    if (auto status = buffers_.keep_also(wanted_buffers(items)); !status) return status;
    Programs fresh{};
    auto status = record(items, fresh);
    if (status) {
        std::swap(programs_, fresh);
        items_ = items;
        slots_ = {};
        given_ = nullptr;
        for (std::size_t n = 0; n < slots; ++n) {
            for (const auto& item : items_) slots_[n].copy.contents[item.name] = state_.device().mapped(buffers_[label(item, n)]);
        }
    }
    destroy(fresh);
    buffers_.keep_only(wanted_buffers(items_));
    return status;
}

HostCopies::Slot* HostCopies::newest_finished() {
    Slot* found = nullptr;
    for (auto& slot : slots_) {
        if (finished(slot) && (found == nullptr || slot.ticket.value > found->ticket.value)) found = &slot;
    }
    return found;
}

// Not one that the host may be reading or the device is writing, nor the newest finished, which the host gets next.
HostCopies::Slot* HostCopies::free_slot() {
    const Slot* keep = newest_finished();
    for (auto& slot : slots_) {
        const bool with_device = filled(slot) && !finished(slot);
        const bool with_host = slot.handed_out != 0 && slot.handed_out + 1 >= update_;
        if (&slot != keep && !with_device && !with_host) return &slot;
    }
    return nullptr;
}

Result<bool> HostCopies::copy(std::size_t set, std::uint64_t step) {
    if (items_.empty()) return true;
    Slot* slot = free_slot();
    if (slot == nullptr) return false;
    const auto index = static_cast<std::size_t>(slot - slots_.data());
    auto ticket = state_.device().submit(programs_[set][index], {});
    if (!ticket) return ticket.status();
    slot->ticket = *ticket;
    slot->copy.step = step;
    slot->handed_out = 0;
    return true;
}

Status HostCopies::wait() {
    for (const auto& slot : slots_) {
        if (!filled(slot) || finished(slot)) continue;
        if (auto status = state_.device().wait(slot.ticket); !status) return status;
    }
    return ok_status();
}

Result<const HostCopies::Copy*> HostCopies::newest() {
    if (!state_.lost()) return state_.lost();
    if (given_ == nullptr) given_ = newest_finished();
    if (given_ == nullptr) return error(Code::not_ready, "no published outputs have reached the host yet; ask again later");
    given_->handed_out = update_;
    return const_cast<const Copy*>(&given_->copy);
}

} // namespace wadi
