// Running a stage over the active tiles of a step, and finding out in which of them it changed a bit.
#pragma once
#include "backends/cpu/stages.hpp"
#include "shaders/stage_table.hpp"
#include <cstddef>
#include <cstdint>
#include <vector>

namespace wadi::cpu {

/// A stage with its buffers, and the lists of compute::ActiveTiles.
struct ActiveStage {
    /// Of 4 bytes that the stage writes. Counts have their low words for in and out at i and i + 2 rim (account_sides), the
    /// memory of outer faces four numbers each (open_sides).
    enum class Numbers : std::uint8_t { field, counts, memory };
    struct Output {
        std::byte* data;
        Numbers numbers;
    };
    static constexpr std::size_t most_outputs = 16, number_bytes = 4;

    std::uint32_t* activity = nullptr; // null: no active tiles
    const std::uint32_t* flags = nullptr;
    const std::uint32_t* counts = nullptr;
    bool rim = false;
    std::vector<Output> outputs;
};

/// Rows [first, last) of the call's range, where they lie in active tiles. Threads may share a tile.
void run_active(const ActiveStage& stage, const StageCall& call, int first, int last);

} // namespace wadi::cpu
