// 64 bits that tell whether bytes are the same: of snapshots, command logs and a level's settings.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace wadi {

/// Four lanes of multiply and rotate, 32 bytes a turn. Each step can be undone, so that a change of a single word always shows.
class Checksum {
  public:
    void add(std::span<const std::byte> bytes);
    std::uint64_t value() const;

  private:
    std::uint64_t lane_[4] = {1, 2, 3, 4};
};

} // namespace wadi
