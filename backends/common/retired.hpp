// What was destroyed while submissions in flight may still use it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

namespace wadi::backends {

/// What a thing brings that may be retired.
template <class T> struct Retirable {
    std::uint64_t last_use = 0;    // newest ticket that may use it
    std::unique_ptr<T> older = {}; // retired before it
};

/// Things that wait for the end of the submissions that may use them. Putting one here neither waits nor allocates.
template <class T> class Retired {
  public:
    void put(std::unique_ptr<T> thing, std::uint64_t last_use) {
        if (!thing) return;
        thing->last_use = last_use;
        thing->older = std::move(newest_);
        newest_ = std::move(thing);
    }
    bool empty() const { return newest_ == nullptr; }
    /// Takes those out that no submission uses after `finished`, at most `most` of them, and calls gone(thing) ahead of each
    /// one's destruction.
    template <class Call> void release(std::uint64_t finished, std::size_t most, Call gone) {
        for (std::unique_ptr<T>* at = &newest_; *at && most > 0;) {
            if ((*at)->last_use > finished) {
                at = &(*at)->older;
                continue;
            }
            const std::unique_ptr<T> thing = std::move(*at);
            *at = std::move(thing->older);
            gone(*thing);
            --most;
        }
    }

  private:
    std::unique_ptr<T> newest_;
};

} // namespace wadi::backends
