// What a device has made, by handle.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace wadi::backends {

/// Ids count up from 1 and are never given out twice.
template <class T> class HandleTable {
  public:
    /// After this the next add() cannot fail.
    void reserve() { items_.reserve(items_.size() + 1); }
    std::uint32_t add(std::unique_ptr<T> item) {
        items_.push_back(std::move(item));
        return static_cast<std::uint32_t>(items_.size());
    }
    /// Null for an id that is not alive.
    T* find(std::uint32_t id) const { return id == 0 || id > items_.size() ? nullptr : items_[id - 1].get(); }
    /// Null for an id that is not alive, and whoever had it finds nothing from now on.
    std::unique_ptr<T> take(std::uint32_t id) { return find(id) == nullptr ? nullptr : std::move(items_[id - 1]); }
    template <class Call> void for_each(Call call) {
        for (const auto& item : items_) {
            if (item) call(*item);
        }
    }

  private:
    std::vector<std::unique_ptr<T>> items_;
};

} // namespace wadi::backends
