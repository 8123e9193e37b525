// The parameter blocks of the stages as the host sees them, and the field layout they describe.
#pragma once
#include <cstddef>
#include <cstdint>

namespace wadi {
struct alignas(16) vec4 {
    float x, y, z, w;
};
#include "shaders/effects.h"
#include "shaders/step_params.h"

static_assert(sizeof(WorldParams) <= 512, "WorldParams must stay within 512 bytes");
static_assert(sizeof(WorldParams) % 4 == 0 && alignof(WorldParams) == 4);
static_assert(sizeof(StepInput) <= 2304, "StepInput must stay within 2304 bytes");
static_assert(offsetof(StepInput, source) == 16 && offsetof(StepInput, side) == 16 + 16 * MAX_SOURCES);
static_assert(offsetof(StepInput, edit) == offsetof(StepInput, side) + 16 * 8 && sizeof(StepInput) % 16 == 0);
static_assert(sizeof(EditInput) == 64 && alignof(EditInput) == 4, "std140 begins each edit at a multiple of 16 bytes");
static_assert(offsetof(StepInput, mapped_rain) == offsetof(StepInput, edit) + sizeof(EditInput) * MAX_EDITS);
static_assert(offsetof(StepInput, wake) == offsetof(StepInput, mapped_rain) + 16);

/// The layout every field shares: GHOST ghost cells around, one more column and row for the last faces. Cell 0 of each row lies
/// at a multiple of 32 elements (LEAD and the pitch are), so that a row begins a line of 128 bytes; its west ghosts end the row
/// before. Behind the last row lie LEAD elements more, so that vectors of cells may reach over the last row's end. u[i,j] is the
/// west face and v[i,j] the south face of cell (i,j).
struct FieldLayout {
    int nx = 0;
    int ny = 0;
    int pitch() const { return (nx + 1 + 2 * GHOST + 31) / 32 * 32; }
    int rows() const { return ny + 1 + 2 * GHOST; }
    std::size_t size() const { return static_cast<std::size_t>(pitch()) * static_cast<std::size_t>(rows()) + 2 * LEAD; }
    std::size_t index(int i, int j) const {
        return static_cast<std::size_t>(j + GHOST) * static_cast<std::size_t>(pitch()) + static_cast<std::size_t>(i + LEAD);
    }
    /// Where row j begins, its west ghosts.
    std::size_t row(int j) const { return index(-GHOST, j); }
    int strips() const { return (ny + 1 + STRIP - 1) / STRIP; }
    /// Output tiles of STRIP x STRIP cells in a row of them; the last may hold no cell.
    int tile_columns() const { return (nx + STRIP) / STRIP; }
    int rim() const { return 2 * (nx + ny); }
    /// Active tiles of `size` x `size` along one axis of `cells` cells and one face more.
    static int active_tiles(int cells, int size) { return cells / size + 1; }
};
} // namespace wadi
