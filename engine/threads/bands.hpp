// The host's own work shared among threads: drawing a level, checking it, figures and hashes of a state. What a device runs is
// its own matter.
#pragma once
#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace wadi {

/// While it lives, work that this thread shares out runs on `most` threads in all; 0: one for each core.
class ThreadLimit {
  public:
    explicit ThreadLimit(int most);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

  private:
    const int before_;
};

/// Number of bands of `band` items, the last one shorter, that hold `count` items.
constexpr std::size_t bands_of(std::size_t count, std::size_t band) { return (count + band - 1) / band; }

/// Cells in a band: enough work that another thread is worth its start.
inline constexpr std::size_t CELL_BAND = 32768;
/// Rows of `length` cells in a band.
constexpr std::size_t row_band(std::size_t length) {
    return length < CELL_BAND ? CELL_BAND / std::max<std::size_t>(length, 1) : 1;
}

/// Calls work(n, begin, end) for each band n of `count` items, on as many threads as ThreadLimit allows and the system gives, the
/// caller's being one; returns when all are done. What a band does may depend on its own numbers only, never on other bands, so
/// that the threads change no bit. An exception ends the work and is thrown again here.
void in_bands(std::size_t count, std::size_t band,
              const std::function<void(std::size_t n, std::size_t begin, std::size_t end)>& work);

/// The first of `count` cells for which found(cell) is true, else `count`. Others are asked as well, some twice.
template <class Found> std::size_t first_cell(std::size_t count, const Found& found) {
    constexpr std::size_t block = 256; // without a branch within, so that the loop vectorises
    std::vector<std::size_t> first(bands_of(count, CELL_BAND), count);
    in_bands(count, CELL_BAND, [&](std::size_t n, std::size_t begin, std::size_t end) {
        for (std::size_t start = begin; start < end && first[n] == count; start += block) {
            const std::size_t stop = std::min(end, start + block);
            bool any = false;
            for (std::size_t cell = start; cell < stop; ++cell) any |= found(cell);
            for (std::size_t cell = start; any && cell < stop && first[n] == count; ++cell)
                if (found(cell)) first[n] = cell;
        }
    });
    return first.empty() ? count : *std::min_element(first.begin(), first.end());
}

} // namespace wadi
