// Ranges and changes of strips and tiles, which are exact: every value is one of the inputs.
#include "tests/conformance/stage_checks.hpp"
#include <algorithm>
#include <array>
#include <bit>

namespace wadi::conformance {

namespace {

using Range = std::array<float, 4>; // least and largest solid surface, least and largest free surface

constexpr Range empty = {1e30F, -1e30F, 1e30F, -1e30F};

void widen(Range& range, const Range& by) {
    for (std::size_t n = 0; n < 4; ++n) range[n] = n % 2 == 0 ? std::min(range[n], by[n]) : std::max(range[n], by[n]);
}

Range range_at(std::span<const float> values, std::size_t at) {
    return {values[4 * at], values[4 * at + 1], values[4 * at + 2], values[4 * at + 3]};
}

Verdict differs(const char* what, int i, int j) {
    return failed(std::string(what) + " of column " + std::to_string(i) + ", row " + std::to_string(j) + " is not exact");
}

} // namespace

std::vector<std::uint32_t> strip_ranges(const FieldLayout& layout) {
    std::vector<std::uint32_t> words(4 * static_cast<std::size_t>(layout.pitch()) * static_cast<std::size_t>(layout.strips()));
    for (std::size_t n = 0; n < words.size(); ++n)
        words[n] = std::bit_cast<std::uint32_t>(static_cast<float>(n * 7919 % 1009) - 500.0F);
    return words;
}

// Whole tiles without a change, and others with one change at different places.
std::vector<std::uint32_t> strip_changes(const FieldLayout& layout) {
    const auto pitch = static_cast<std::size_t>(layout.pitch());
    std::vector<std::uint32_t> words(pitch * static_cast<std::size_t>(layout.strips()));
    for (std::size_t n = 0; n < words.size(); ++n) {
        const std::size_t column = n % pitch, tile = column / STRIP + n / pitch;
        words[n] = tile % 2 == 0 && column % STRIP == tile * 5 % STRIP ? 1 : 0;
    }
    return words;
}

Verdict check_strips(const StageRun& run) {
    const FieldLayout layout{run.params.nx, run.params.ny};
    for (int strip = 0; strip < layout.strips(); ++strip) {
        for (int i = 0; i <= layout.nx; ++i) {
            Range wanted = empty;
            bool changed = false;
            for (int j = strip * STRIP; i < layout.nx && j < std::min((strip + 1) * STRIP, layout.ny); ++j) {
                const float solid = run.before("sand_surface", i, j), free = run.before("free_surface", i, j);
                widen(wanted, {solid, solid, free, free});
                changed |=
                    solid != run.before("previous_sand_surface", i, j) || free != run.before("previous_free_surface", i, j);
            }
            const auto at = static_cast<std::size_t>(strip * layout.pitch() + i);
            if (range_at(run.buffer("strip_range").floats(), at) != wanted) return differs("strip_range", i, strip);
            if (run.buffer("strip_changed").words()[at] != (changed ? 1u : 0u)) return differs("strip_changed", i, strip);
        }
    }
    return {};
}

Verdict check_tiles(const StageRun& run) {
    const FieldLayout layout{run.params.nx, run.params.ny};
    const auto& kept = run.buffer("tile_changed");
    for (int strip = 0; strip < layout.strips(); ++strip) {
        for (int tile = 0; tile < layout.tile_columns(); ++tile) {
            Range wanted = empty;
            bool changed = false;
            for (int i = tile * STRIP; i < std::min((tile + 1) * STRIP, layout.nx); ++i) {
                const auto from = static_cast<std::size_t>(strip * layout.pitch() + i);
                widen(wanted, range_at(run.buffer("strip_range").floats(), from));
                changed |= run.buffer("strip_changed").words()[from] != 0;
            }
            const auto at = static_cast<std::size_t>(strip * layout.tile_columns() + tile);
            const bool never = static_cast<std::int32_t>(kept.before[at]) < 0;
            const auto last = changed || never ? static_cast<std::uint32_t>(run.pilot.input.step) : kept.before[at];
            if (range_at(run.buffer("tile_range").floats(), at) != wanted) return differs("tile_range", tile, strip);
            if (kept.words()[at] != last) return differs("tile_changed", tile, strip);
        }
    }
    return {};
}

} // namespace wadi::conformance
