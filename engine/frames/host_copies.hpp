// Copies of published buffers in host memory, for hosts that share no API with the device: one frame late, never waited for.
#pragma once
#include "engine/step/run/world_state.hpp"
#include <optional>
#include <span>

namespace wadi {

class HostCopies {
  public:
    static constexpr std::size_t sets = 3;

    /// What is copied: a part of one buffer of each output set.
    struct Item {
        std::string name;
        std::array<compute::Buffer, sets> from{};
        std::uint64_t offset = 0, bytes = 0;
    };
    /// A finished copy of every item.
    struct Copy {
        std::uint64_t step = 0;
        std::map<std::string, std::span<const std::byte>> contents; // by item name
    };

    explicit HostCopies(WorldState& state) : state_(state), buffers_(state.device()) {}
    ~HostCopies() { destroy(programs_); }
    HostCopies(const HostCopies&) = delete;
    HostCopies& operator=(const HostCopies&) = delete;

    /// Chooses what is copied from now on; earlier copies are gone. Waits for the device. Errors: out_of_memory (nothing
    /// changed).
    Status set(const std::vector<Item>& items);
    /// To be called as each update begins: copies handed out before the one before are free again.
    void begin_update() {
        ++update_;
        give_anew();
    }
    /// newest() may give another copy than it gave since the last update, whose memory stays all the same.
    void give_anew() { given_ = nullptr; }
    /// Submits a copy of an output set that was submitted before. False: not now, the device is behind and no memory is free.
    Result<bool> copy(std::size_t set, std::uint64_t step);
    /// Waits for all copies.
    Status wait();
    /// The newest finished copy, the same for all calls until an update or give_anew(); its memory stays until the second next
    /// update. Errors: not_ready (none yet).
    Result<const Copy*> newest();

  private:
    // One with the device, the newest finished, and those handed out in this update and in the last one. Where a host waited, the
    // newest finished was handed out, too, and none is with the device.
    static constexpr std::size_t slots = 4;
    struct Slot {
        Copy copy;
        compute::Ticket ticket;       // null: never filled
        std::uint64_t handed_out = 0; // the update after which the host got it; 0 = never
    };
    static std::string label(const Item& item, std::size_t slot);
    bool filled(const Slot& slot) const { return slot.ticket.value != 0; }
    bool finished(const Slot& slot) const { return filled(slot) && state_.device().finished(slot.ticket); }
    Slot* newest_finished();
    Slot* free_slot();
    using Programs = std::array<std::array<compute::Program, slots>, sets>;
    std::vector<compute::BufferDesc> wanted_buffers(const std::vector<Item>& items) const;
    Status record(const std::vector<Item>& items, Programs& programs);
    void destroy(Programs& programs);

    WorldState& state_;
    NamedBuffers buffers_;
    std::vector<Item> items_;
    std::array<Slot, slots> slots_{};
    Programs programs_{};
    std::uint64_t update_ = 1;
    Slot* given_ = nullptr; // what newest() gives
};

} // namespace wadi
