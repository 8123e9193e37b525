// What a device has made, by handle.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <utility>

namespace wadi::backends {

/// Ids count up from 1 and are never given out twice.
template <class T> class HandleTable {
  public:
    /// After this the next add() cannot fail.
    void reserve() {
        if (!spare_.empty()) return;
        Items apart;
        apart.emplace(0, nullptr);
        spare_ = apart.extract(0);
    }
    std::uint32_t add(std::unique_ptr<T> item) {
        reserve();
        spare_.key() = ++newest_;
        spare_.mapped() = std::move(item);
        items_.insert(std::move(spare_));
        return newest_;
    }
    /// Null for an id that is not alive.
    T* find(std::uint32_t id) const {
        const auto found = items_.find(id);
        return found == items_.end() ? nullptr : found->second.get();
    }
    /// Null for an id that is not alive, and whoever had it finds nothing from now on.
    std::unique_ptr<T> take(std::uint32_t id) {
        auto node = items_.extract(id);
        return node.empty() ? nullptr : std::move(node.mapped());
    }
    template <class Call> void for_each(Call call) {
        for (const auto& item : items_) call(*item.second);
    }

  private:
    using Items = std::map<std::uint32_t, std::unique_ptr<T>>;
    Items items_; // those alive: a host that changes its world every frame makes and destroys without end
    typename Items::node_type spare_;
    std::uint32_t newest_ = 0;
};

} // namespace wadi::backends
