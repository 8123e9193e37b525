// Output tiles, of STRIP x STRIP cells, for a host's collision shapes: how high they reach, and when they last changed.
#pragma once
#include "engine/step/run/region.hpp"
#include "shaders/params.hpp"
#include <cstdint>
#include <span>

namespace wadi {

struct Tile {
    Region cells;
    float solid_least = 0, solid_most = 0; // ground with sand, H + hs [m]
    float free_least = 0, free_most = 0;   // visible surface, H + max(W, hs) [m]
    std::int64_t changed_step = 0;         // newest publish whose surfaces differ from the publish before
};

/// Tiles in rows from south to north, in what fold_tiles wrote (tile_range, tile_changed).
struct Tiles {
    FieldLayout layout;
    std::span<const std::byte> ranges, changes;
    std::uint64_t step = 0; // of the publish

    int columns() const { return (layout.nx + STRIP - 1) / STRIP; }
    int count() const { return columns() * ((layout.ny + STRIP - 1) / STRIP); }
    Tile operator[](int n) const;
};

/// Calls call(region) for the tiles that changed after step `since`; neighbours in a row of tiles are one region.
template <class Call> void for_dirty_regions(const Tiles& tiles, std::int64_t since, Call call) {
    Region open;
    for (int n = 0; n < tiles.count(); ++n) {
        const Tile tile = tiles[n];
        const bool dirty = tile.changed_step > since;
        const bool joins = dirty && open.nx > 0 && open.j0 == tile.cells.j0;
        if (joins) {
            open.nx += tile.cells.nx;
            continue;
        }
        if (open.nx > 0) call(open);
        open = dirty ? tile.cells : Region{};
    }
    if (open.nx > 0) call(open);
}

} // namespace wadi
