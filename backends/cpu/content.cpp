#include "backends/cpu/content.hpp"
#include <bit>
#include <cstring>
#include <utility>

namespace wadi::cpu {

namespace {

/// Calls use(first, last) for each run of bits that are set.
template <class Use> void for_each_run(std::uint64_t bits, Use use) {
    while (bits != 0) {
        const int first = std::countr_zero(bits), last = first + std::countr_one(bits >> first);
        use(first, last);
        bits &= last == 64 ? 0 : ~std::uint64_t{0} << last;
    }
}

std::uint64_t bits_between(int first, int last) { return (~std::uint64_t{0} << first) & (~std::uint64_t{0} >> (64 - last)); }

// One row of blocks, 64 of them at a time.
class BlockRow {
  public:
    BlockRow(const ContentStage& stage, const StageCall& call, int row)
        : s_(stage), call_(call), blocks_(stage.written.front()->blocks()), row_(row) {}

    void run(int word) {
        std::uint64_t rest = bits_between(0, std::min(64, blocks_.columns() - 64 * word));
        for (const auto& lack : s_.lacks) {
            std::uint64_t free = rest;
            for (const auto& field : lack.fields) {
                if (free != 0) free &= ~read(field, word);
            }
            rest &= ~free;
            for_each_run(free, [&](int first, int last) {
                const int begin = 64 * word + first, end = 64 * word + last;
                if (lack.block != nullptr) compute(lack.block, lack.written, begin, end);
                for (const auto& output : lack.fills) fill(output, begin, end);
            });
        }
        for_each_run(rest, [&](int first, int last) { compute(call_.block, s_.written, 64 * word + first, 64 * word + last); });
    }

  private:
    // The blocks for which the field holds something where the stage reads it.
    std::uint64_t read(const ContentStage::Field& field, int word) const {
        const BlockContent& content = *field.content;
        if (!field.around) return content.word(row_, word);
        const int low = s_.reach.south > 0 ? std::max(0, row_ - 1) : row_;
        const int high = s_.reach.north > 0 ? std::min(blocks_.rows() - 1, row_ + 1) : row_;
        const auto rows = [&](int at) {
            std::uint64_t bits = 0;
            for (int row = low; row <= high && at >= 0 && at < content.words(); ++row) bits |= content.word(row, at);
            return bits;
        };
        const std::uint64_t here = rows(word);
        std::uint64_t all = here;
        if (s_.reach.west > 0) all |= here << 1 | rows(word - 1) >> 63;
        if (s_.reach.east > 0) all |= here >> 1 | rows(word + 1) << 63;
        return all;
    }

    void compute(StageBlock block, const std::vector<BlockContent*>& written, int begin, int end) const {
        StageCall call = call_;
        call.block = block;
        call(first_i(begin), last_i(end - 1), first_j(), last_j());
        // A look as long as it lies in the cache; none where the fields that lacks name first keep all lacks out.
        const int word = begin / 64;
        std::uint64_t kept_out = bits_between(begin - 64 * word, end - 64 * word);
        const std::uint64_t all = kept_out;
        for (const auto& lack : s_.lacks) kept_out &= lack.fields.front().content->word(row_, word);
        for (auto* content : written) {
            const std::uint64_t assumed = content->leads() ? 0 : kept_out;
            for_each_run(assumed, [&](int first, int last) { content->assume(row_, 64 * word + first, 64 * word + last); });
            for_each_run(all & ~assumed, [&](int first, int last) { content->look(row_, 64 * word + first, 64 * word + last); });
        }
    }

    // The blocks [begin, end), all of one word.
    void fill(const ContentStage::Output& output, int begin, int end) const {
        if (output.empty != 0) return put(output, begin, end);
        const int word = begin / 64;
        const std::uint64_t full = output.content->word(row_, word) & bits_between(begin - 64 * word, end - 64 * word);
        for_each_run(full, [&](int first, int last) { put(output, 64 * word + first, 64 * word + last); });
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
    const int row_;
};

} // namespace

BlockContent::BlockContent(FieldLayout layout, const std::uint32_t* numbers) : blocks_{layout}, numbers_(numbers) {
    holds_.resize(static_cast<std::size_t>(words()) * static_cast<std::size_t>(blocks_.rows()));
    look_everywhere();
}

void BlockContent::look(int row, int first, int last) {
    if (exposed_) return;
    const int j0 = blocks_.first_j(row, -GHOST), j1 = blocks_.last_j(row, blocks_.layout.ny + 1 + GHOST);
    // Where there is something, a number in the middle mostly tells.
    const std::uint32_t* middle = numbers_ + blocks_.layout.index(Blocks::width / 2, (j0 + j1) / 2);
    for (int column = first; column < last; ++column) {
        const bool holds = middle[column * Blocks::width] != 0 || holds_something(column, row);
        auto& word = holds_[at(row, column / 64)];
        const std::uint64_t bit = std::uint64_t{1} << (column % 64);
        word = holds ? word | bit : word & ~bit;
    }
}

void BlockContent::assume(int row, int first, int last) {
    for (int word = first / 64; 64 * word < last; ++word)
        holds_[at(row, word)] |= bits_between(std::max(0, first - 64 * word), std::min(64, last - 64 * word));
}

void BlockContent::look(const compute::Range2& range) {
    if (range.i0 >= range.i1) return;
    for (int row = blocks_.row_of(range.j0); range.j0 < range.j1 && row <= blocks_.row_of(range.j1 - 1); ++row)
        look(row, blocks_.column_of(range.i0), blocks_.column_of(range.i1 - 1) + 1);
}

void BlockContent::expose() {
    exposed_ = true;
    for (int row = 0; row < blocks_.rows(); ++row) assume(row, 0, blocks_.columns());
}

bool BlockContent::holds_something(int column, int row) const {
    const auto& layout = blocks_.layout;
    const int i0 = blocks_.first_i(column, -GHOST), i1 = blocks_.last_i(column, layout.nx + 1 + GHOST);
    const int j0 = blocks_.first_j(row, -GHOST), j1 = blocks_.last_j(row, layout.ny + 1 + GHOST);
    const auto any_of = [](const std::uint32_t* line, int count) {
        std::uint32_t any = 0;
        for (int n = 0; n < count; ++n) any |= line[n];
        return any;
    };
    std::uint32_t any = 0;
    for (int j = j0; j < j1 && any == 0; ++j) {
        const std::uint32_t* line = numbers_ + layout.index(i0, j);
        any = i1 - i0 == Blocks::width ? any_of(line, Blocks::width) : any_of(line, i1 - i0); // a constant count: no loop
    }
    return any != 0;
}

ContentStage content_stage(const compute::StageInfo& stage, std::span<const compute::StageLack> lacks, std::uint32_t effects,
                           std::span<BlockContent* const> contents, std::span<void* const> buffers,
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
            else if (binding.access == compute::Access::out) {
                std::uint32_t word = 0; // std::bit_cast is not in LLVM's library before version 14
                std::memcpy(&word, &binding.empty, sizeof word);
                part.fills.push_back({contents[n], static_cast<std::uint32_t*>(buffers[n]), word});
            }
        }
        if (part.fields.empty()) continue;
        for (std::size_t n = 0; n < contents.size(); ++n)
            if (contents[n] == part.fields.front().content) contents[n]->lead();
        made.lacks.push_back(std::move(part));
    }
    return made;
}

void run_by_content(const ContentStage& stage, const StageCall& call, int first, int last) {
    const int words = stage.written.front()->words();
    for (int row = first; row < last; ++row) {
        BlockRow blocks(stage, call, row);
        for (int word = 0; word < words; ++word) blocks.run(word);
    }
}

} // namespace wadi::cpu
