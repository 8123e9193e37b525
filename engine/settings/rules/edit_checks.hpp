// What a world accepts as an edit or a stamp's image, and what an edit brings along.
#pragma once
#include "engine/settings/rules/effects.hpp"
#include <span>

namespace wadi {

constexpr int STAMP_MOST = 4096; // pixels per side

/// An image to be stamped: row-major nx * ny, row 0 in the south.
struct Stamp {
    int nx = 0, ny = 0;
    std::vector<float> values;
    float least = 0, largest = 0;
    std::uint64_t page = 0; // where it lies on the device, in units of STAMP_PAGE floats
    /// Least and largest of the values.
    void set_range();
};

/// ok, or bad_argument; the message begins with "function: edits[index].", or "edits[index]." where function is empty.
Status check_edit(const char* function, std::size_t index, const Edit& edit, const Settings& settings,
                  std::span<const Stamp> stamps, std::uint64_t next_step);
/// What a checked edit may bring into the world.
Content content_brought(const Edit& edit, std::span<const Stamp> stamps);

/// ok, or why an image is no stamp.
Status check_stamp(const char* function, int nx, int ny, std::span<const float> values);

} // namespace wadi
