// Which parts of a field hold only zeros, and what a stage need not compute for it.
#pragma once
#include "backends/cpu/stages.hpp"
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace wadi::cpu {

/// Blocks of width x height cells. Those along the east and the north side take what is left over, and those at the rim the
/// ghosts.
struct Blocks {
    static constexpr int width = 16, height = 8;
    FieldLayout layout;

    int columns() const { return std::max(1, layout.nx / width); }
    int rows() const { return std::max(1, layout.ny / height); }
    int column_of(int i) const { return std::clamp(i / width, 0, columns() - 1); }
    int row_of(int j) const { return std::clamp(j / height, 0, rows() - 1); }
    /// The indices [first, last) of a column's or a row's cells, of those in [low, high).
    int first_i(int column, int low) const { return column == 0 ? low : column * width; }
    int last_i(int column, int high) const { return column == columns() - 1 ? high : (column + 1) * width; }
    int first_j(int row, int low) const { return row == 0 ? low : row * height; }
    int last_j(int row, int high) const { return row == rows() - 1 ? high : (row + 1) * height; }
};

/// What the blocks of one field hold. Whoever writes the field looks anew, so that this is never wrong when others ask.
class BlockContent {
  public:
    BlockContent(FieldLayout layout, const std::uint32_t* numbers);

    const Blocks& blocks() const { return blocks_; }
    /// Words of a row of blocks, 64 blocks each.
    int words() const { return (blocks_.columns() + 63) / 64; }
    /// A bit for each block: 0 only where every number is +0, ghosts included, and beyond the last one.
    std::uint64_t word(int row, int word) const { return holds_[at(row, word)]; }
    /// Looks into the blocks [first, last) of a row.
    void look(int row, int first, int last);
    /// Says of them that they may hold something, without a look.
    void assume(int row, int first, int last);
    /// Some lack names the field first, so that the others that it names are not asked where this one holds something.
    void lead() { leads_ = true; }
    bool leads() const { return leads_; }
    /// Looks into all blocks that have cells in the range or, at the rim of the grid, ghosts beside.
    void look(const compute::Range2& range);
    void look_everywhere() { look({0, 0, blocks_.layout.nx, blocks_.layout.ny}); }
    /// From now on somebody else may write, unseen: every block may hold something.
    void expose();

  private:
    std::size_t at(int row, int word) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(words()) + static_cast<std::size_t>(word);
    }
    bool holds_something(int column, int row) const;

    Blocks blocks_;
    const std::uint32_t* numbers_;
    std::vector<std::uint64_t> holds_;
    bool exposed_ = false, leads_ = false;
};

/// A stage whose fields have contents.
struct ContentStage {
    struct Field {
        const BlockContent* content;
        bool around; // read beyond the kernel's own index
    };
    struct Output {
        BlockContent* content;
        std::uint32_t* words;
        std::uint32_t empty; // the word that the stage writes where it is empty
    };
    /// What one compute::StageLack comes to.
    struct Lack {
        StageBlock block = nullptr; // null: empty
        std::vector<Field> fields;
        std::vector<Output> fills;          // what the block does not write
        std::vector<BlockContent*> written; // what it does
    };
    std::vector<Lack> lacks;
    std::vector<BlockContent*> written; // by the whole stage
    compute::Reach reach;

    bool on() const { return !lacks.empty(); }
};

/// By what the stage lacks. `contents` and `buffers` go by binding, null where the mask lacks it. `lean`: the stage's block for a
/// mask, null where there is none; lacks of that mask are left out then, and those of fields that the mask does not have.
ContentStage content_stage(const compute::StageInfo& stage, std::span<const compute::StageLack> lacks, std::uint32_t effects,
                           std::span<BlockContent* const> contents, std::span<void* const> buffers,
                           const std::function<StageBlock(std::uint32_t)>& lean);

/// The stage over the rows [first, last) of blocks; what it writes has the bits of a call over all of them. Threads may run rows
/// of one call at the same time, but not the same one.
void run_by_content(const ContentStage& stage, const StageCall& call, int first, int last);

} // namespace wadi::cpu
