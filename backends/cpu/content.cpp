#include "backends/cpu/content.hpp"
#include <array>
#include <bit>
#include <utility>

namespace wadi::cpu {

namespace {

// One row of blocks.
class Runner {
  public:
    Runner(const ContentStage& stage, const StageCall& call)
        : s_(stage), call_(call), blocks_(stage.written.front()->blocks()), columns_(blocks_.columns()) {}

    void run(int row) {
        row_ = row;
        choose();
        for (int column = 0; column < columns_;) {
            const int begin = column;
            const auto choice = choice_[at(begin)];
            while (column < columns_ && choice_[at(column)] == choice) ++column;
            if (choice == s_.lacks.size()) {
                compute(call_.block, s_.written, begin, column);
                continue;
            }
            const auto& lack = s_.lacks[choice];
            if (lack.block != nullptr) compute(lack.block, lack.written, begin, column);
            for (const auto& output : lack.fills) fill(output, begin, column);
        }
    }

  private:
    static std::size_t at(int column) { return static_cast<std::size_t>(column); }

    // For each block the first lack that it has; their number where it has none.
    void choose() {
        const auto none = static_cast<std::uint8_t>(s_.lacks.size());
        std::fill_n(choice_.begin(), columns_, none);
        for (std::uint8_t n = none; n-- > 0;) {
            std::fill_n(holds_.begin(), columns_, std::uint8_t{0});
            for (const auto& field : s_.lacks[n].fields) add(field);
            for (int column = 0; column < columns_; ++column)
                choice_[at(column)] = holds_[at(column)] == 0 ? n : choice_[at(column)];
        }
    }

    // Adds the blocks for which the field holds something where the stage reads it.
    void add(const ContentStage::Field& field) {
        const int low = field.around && s_.reach.south > 0 ? std::max(0, row_ - 1) : row_;
        const int high = field.around && s_.reach.north > 0 ? std::min(blocks_.rows() - 1, row_ + 1) : row_;
        std::uint8_t* here = beside_.data() + 1; // a column more on either side
        std::copy_n(field.content->row(low), columns_, here);
        for (int row = low + 1; row <= high; ++row) {
            const std::uint8_t* more = field.content->row(row);
            for (int column = 0; column < columns_; ++column) here[column] |= more[column];
        }
        here[-1] = here[columns_] = 0;
        const std::uint8_t west = field.around && s_.reach.west > 0 ? 1 : 0, east = field.around && s_.reach.east > 0 ? 1 : 0;
        for (int column = 0; column < columns_; ++column)
            holds_[at(column)] |= static_cast<std::uint8_t>(here[column] | (west & here[column - 1]) | (east & here[column + 1]));
    }

    void compute(StageBlock block, const std::vector<Content*>& written, int begin, int end) const {
        StageCall call = call_;
        call.block = block;
        call(first_i(begin), last_i(end - 1), first_j(), last_j());
        for (auto* content : written) content->look(row_, begin, end); // as long as it lies in the cache
    }

    void fill(const ContentStage::Output& output, int begin, int end) const {
        if (output.empty != 0) return put(output, begin, end);
        for (int column = begin; column < end;) {
            const std::uint8_t* holds = output.content->row(row_);
            while (column < end && holds[column] == 0) ++column;
            const int first = column;
            while (column < end && holds[column] != 0) ++column;
            if (first < column) put(output, first, column);
        }
    }

    void put(const ContentStage::Output& output, int begin, int end) const {
        for (int j = first_j(); j < last_j(); ++j)
            std::fill(output.words + blocks_.layout.index(first_i(begin), j),
                      output.words + blocks_.layout.index(last_i(end - 1), j), output.empty);
        output.content->look(row_, begin, end);
    }

    int first_i(int column) const { return blocks_.first_i(column, call_.range.i0); }
    int last_i(int column) const { return blocks_.last_i(column, call_.range.i1); }
    int first_j() const { return blocks_.first_j(row_, call_.range.j0); }
    int last_j() const { return blocks_.last_j(row_, call_.range.j1); }

    const ContentStage& s_;
    const StageCall& call_;
    const Blocks& blocks_;
    const int columns_;
    int row_ = 0;
    std::array<std::uint8_t, Blocks::most_columns> choice_, holds_;
    std::array<std::uint8_t, Blocks::most_columns + 2> beside_;
};

} // namespace

Content::Content(FieldLayout layout, const std::uint32_t* words)
    : blocks_{layout}, words_(words),
      holds_(static_cast<std::size_t>(blocks_.columns()) * static_cast<std::size_t>(blocks_.rows()), 1) {
    look_everywhere();
}

void Content::look(int row, int first, int last) {
    if (exposed_) return;
    for (int column = first; column < last; ++column) holds_[at(column, row)] = holds_something(column, row) ? 1 : 0;
}

void Content::look(const compute::Range2& range) {
    if (range.i0 >= range.i1) return;
    for (int row = blocks_.row_of(range.j0); range.j0 < range.j1 && row <= blocks_.row_of(range.j1 - 1); ++row)
        look(row, blocks_.column_of(range.i0), blocks_.column_of(range.i1 - 1) + 1);
}

void Content::expose() {
    exposed_ = true;
    std::fill(holds_.begin(), holds_.end(), std::uint8_t{1});
}

bool Content::holds_something(int column, int row) const {
    const auto& layout = blocks_.layout;
    const int i0 = blocks_.first_i(column, -GHOST), i1 = blocks_.last_i(column, layout.nx + 1 + GHOST);
    const int j0 = blocks_.first_j(row, -GHOST), j1 = blocks_.last_j(row, layout.ny + 1 + GHOST);
    if (words_[layout.index((i0 + i1) / 2, (j0 + j1) / 2)] != 0) return true; // that mostly tells
    std::uint32_t any = 0;
    for (int j = j0; j < j1 && any == 0; ++j) {
        const std::uint32_t* line = words_ + layout.index(i0, j);
        for (int n = 0; n < i1 - i0; ++n) any |= line[n];
    }
    return any != 0;
}

ContentStage content_stage(const compute::StageInfo& stage, std::span<const compute::StageLack> lacks, std::uint32_t effects,
                           std::span<Content* const> contents, std::span<void* const> buffers,
                           const std::function<StageBlock(std::uint32_t)>& lean) {
    ContentStage made;
    made.reach = stage.reach;
    for (std::size_t n = 0; n < stage.bindings.size(); ++n) {
        if (stage.bindings[n].exists(effects) && stage.bindings[n].access != compute::Access::in)
            made.written.push_back(contents[n]);
    }
    for (const auto& lack : lacks) {
        ContentStage::Lack part;
        const std::uint32_t left = effects & ~lack.less;
        if (lack.less != 0) {
            part.block = left == effects ? nullptr : lean(left);
            if (part.block == nullptr) continue;
        }
        for (std::size_t n = 0; n < stage.bindings.size(); ++n) {
            const auto& binding = stage.bindings[n];
            if (!binding.exists(effects)) continue;
            const bool only_read = binding.access == compute::Access::in;
            if ((lack.slots >> binding.slot & 1) != 0) part.fields.push_back({contents[n], only_read});
            if (only_read) continue;
            if (part.block != nullptr && binding.exists(left))
                part.written.push_back(contents[n]);
            else if (binding.access == compute::Access::out)
                part.fills.push_back(
                    {contents[n], static_cast<std::uint32_t*>(buffers[n]), std::bit_cast<std::uint32_t>(binding.empty)});
        }
        if (!part.fields.empty()) made.lacks.push_back(std::move(part));
    }
    return made;
}

void run_by_content(const ContentStage& stage, const StageCall& call, int first, int last) {
    Runner runner(stage, call);
    for (int row = first; row < last; ++row) runner.run(row);
}

} // namespace wadi::cpu
