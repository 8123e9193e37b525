#include "backends/cpu/active_tiles.hpp"
#include "backends/cpu/processor.hpp"
#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>

namespace wadi::cpu {

namespace {

class Runner {
  public:
    Runner(const ActiveStage& stage, const StageCall& call) : s_(stage), call_(call), p_(call.params) {}

    // Active neighbours run together, as rows as long as can be: a row's first cells cost the most.
    void run_tile_row(int row, int j0, int j1) {
        const int first = row * p_.tile_columns, size = p_.tile_size;
        const int most = std::max(1, static_cast<int>(old_.size() / s_.outputs.size()) / size);
        for (int column = 0; column < p_.tile_columns && column * size < call_.range.i1; ++column) {
            if (s_.flags[first + column] == 0) continue;
            const int begin = column;
            while (column + 1 < p_.tile_columns && column + 1 - begin < most && s_.flags[first + column + 1] != 0) ++column;
            run_span(first + begin, column + 1 - begin, begin * size, std::min((column + 1) * size, call_.range.i1), j0, j1);
        }
    }

    // Only the thread's own face and ghost are written: a chunk at a time is saved, run and compared.
    void run_rim() {
        constexpr int chunk = 128;
        std::array<std::uint32_t, ActiveStage::most_outputs * 4 * chunk> old;
        for (int i0 = call_.range.i0; i0 < call_.range.i1; i0 += chunk) {
            const int i1 = std::min(i0 + chunk, call_.range.i1);
            const auto visit = [&](auto use) {
                std::size_t at = 0;
                for (int i = i0; i < i1; ++i) {
                    const Place place = rim_place(i);
                    for (const auto& output : s_.outputs) {
                        const auto look = [&](std::size_t n) {
                            std::uint32_t word = 0;
                            std::memcpy(&word, output.data + n * ActiveStage::number_bytes, ActiveStage::number_bytes);
                            use(old[at++], word, place.tile);
                        };
                        const auto own = static_cast<std::size_t>(i);
                        switch (output.numbers) {
                        case ActiveStage::Numbers::field:
                            look(place.face), look(place.ghost);
                            break;
                        case ActiveStage::Numbers::counts:
                            look(own), look(own + static_cast<std::size_t>(4 * (p_.nx + p_.ny)));
                            break;
                        case ActiveStage::Numbers::memory:
                            for (std::size_t n = 0; n < 4; ++n) look(4 * own + n);
                            break;
                        }
                    }
                }
            };
            visit([](std::uint32_t& kept, std::uint32_t now, int) { kept = now; });
            call_(i0, i1, 0, 1);
            visit([&](std::uint32_t kept, std::uint32_t now, int tile) {
                if (kept != now) stamp(tile);
            });
        }
    }

  private:
    struct Place {
        std::size_t face, ghost;
        int tile;
    };

    std::uint32_t now() const { return static_cast<std::uint32_t>(call_.input.step); }
    bool stamped(int tile) const { return SharedNumber(s_.activity[tile]).load() == now(); }
    void stamp(int tile) const { SharedNumber(s_.activity[tile]).store(now()); }

    // Runs `count` tiles from `tile` on, the cells [i0, i1) x [j0, j1), and compares what tiles without a stamp write with what
    // was there: some rows at a time, and no further than the first that differs.
    void run_span(int tile, int count, int i0, int i1, int j0, int j1) {
        const int size = p_.tile_size, rows = std::max(1, static_cast<int>(old_.size() / s_.outputs.size()) / (count * size));
        for (int j = j0; j < j1;) {
            int unstamped = 0;
            for (int n = 0; n < count; ++n) unstamped += stamped(tile + n) ? 0 : 1;
            const int end = unstamped == 0 ? j1 : std::min(j + rows, j1);
            std::size_t at = 0;
            const auto visit = [&](auto use) {
                at = 0;
                for (int n = 0; n < count && unstamped > 0; ++n) {
                    const int low = i0 + n * size, high = std::min(low + size, i1);
                    if (watched_[static_cast<std::size_t>(n)]) use(tile + n, low, static_cast<std::size_t>(high - low));
                }
            };
            for (int n = 0; n < count; ++n) watched_[static_cast<std::size_t>(n)] = unstamped > 0 && !stamped(tile + n);
            visit([&](int, int low, std::size_t width) {
                for (const auto& output : s_.outputs) {
                    for (int row = j; row < end; ++row, at += width)
                        std::memcpy(old_.data() + at, output.data + index(low, row) * ActiveStage::number_bytes,
                                    width * ActiveStage::number_bytes);
                }
            });
            call_(i0, i1, j, end);
            visit([&](int watched, int low, std::size_t width) {
                bool same = true;
                for (const auto& output : s_.outputs) {
                    for (int row = j; row < end; ++row, at += width)
                        same = same && std::memcmp(old_.data() + at, output.data + index(low, row) * ActiveStage::number_bytes,
                                                   width * ActiveStage::number_bytes) == 0;
                }
                if (!same) stamp(watched);
            });
            j = end;
        }
    }

    std::size_t index(int i, int j) const { return FieldLayout{p_.nx, p_.ny}.index(i, j); }

    Place rim_place(int i) const {
        const int west_east = 2 * p_.ny;
        const bool along_y = i < west_east, low = along_y ? i < p_.ny : i < west_east + p_.nx;
        const int along = along_y ? (low ? i : i - p_.ny) : (low ? i - west_east : i - west_east - p_.nx);
        const int x = along_y ? (low ? 0 : p_.nx) : along, y = along_y ? along : (low ? 0 : p_.ny);
        const std::size_t face = index(x, y), ghost = !low ? face : along_y ? index(-1, y) : index(x, -1);
        return {face, ghost, y / p_.tile_size * p_.tile_columns + x / p_.tile_size};
    }

    const ActiveStage& s_;
    const StageCall& call_;
    const WorldParams& p_;
    std::array<std::uint32_t, 16384> old_; // 64 KiB: stays in the level-2 cache
    std::array<bool, 16384 / 8> watched_;
};

} // namespace

void run_active(const ActiveStage& stage, const StageCall& call, int first, int last) {
    Runner runner(stage, call);
    if (stage.rim) return runner.run_rim();
    const int size = call.params.tile_size;
    for (int j = first; j < last;) {
        const int row = j / size, end = std::min(last, (row + 1) * size);
        if (stage.counts[row] != 0) runner.run_tile_row(row, j, end);
        j = end;
    }
}

} // namespace wadi::cpu
