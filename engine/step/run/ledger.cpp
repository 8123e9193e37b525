#include "engine/step/run/ledger.hpp"

namespace wadi {

namespace {

// Sums the low and high words of one entry over its row of counters.
std::int64_t sum(const std::vector<std::uint32_t>& words, std::size_t row, std::size_t entry) {
    std::uint64_t total = 0;
    for (std::size_t n = 0; n < row; ++n)
        total += words[2 * entry * row + n] + (std::uint64_t{words[(2 * entry + 1) * row + n]} << 32);
    return static_cast<std::int64_t>(total);
}

Result<std::vector<std::uint32_t>> words_of(WorldState& state, const char* name, std::size_t count) {
    std::vector<std::uint32_t> values(count);
    const auto from = state.fields().buffer(name);
    if (auto status = state.device().read(from, 0, std::as_writable_bytes(std::span(values))); !status) return status;
    return values;
}

std::size_t row_of(const WorldState& state) {
    return static_cast<std::size_t>(state.layout().strips()) * static_cast<std::size_t>(state.layout().pitch());
}

} // namespace

Result<std::pair<std::int64_t, std::int64_t>> read_side_ledger(WorldState& state, const char* field) {
    if (state.plan().find(field) == nullptr) return std::pair<std::int64_t, std::int64_t>{0, 0};
    const auto rim = static_cast<std::size_t>(state.layout().rim());
    auto words = words_of(state, field, 4 * rim);
    if (!words) return words.status();
    return std::pair{sum(*words, rim, 0), sum(*words, rim, 1)};
}

Result<Ledger> read_ledger(WorldState& state) {
    const std::size_t row = row_of(state);
    auto words = words_of(state, "source_ledger", row * 2 * LEDGER_ENTRIES);
    if (!words) return words.status();
    Ledger ledger;
    ledger.water_in = sum(*words, row, LEDGER_WATER_IN);
    ledger.water_out = sum(*words, row, LEDGER_WATER_OUT);
    ledger.sand_in = sum(*words, row, LEDGER_SAND_IN);
    ledger.sand_out = sum(*words, row, LEDGER_SAND_OUT);
    ledger.refused = sum(*words, row, LEDGER_REFUSED);
    auto water = read_side_ledger(state, "water_side_ledger");
    if (!water) return water.status();
    auto sand = read_side_ledger(state, "sand_side_ledger");
    if (!sand) return sand.status();
    ledger.water_in += water->first;
    ledger.water_out += water->second;
    ledger.sand_in += sand->first;
    ledger.sand_out += sand->second;
    return ledger;
}

// The first counter of the entry's row takes it all: only the sum is ever looked at.
Status count_in_ledger(WorldState& state, int entry, std::int64_t quanta) {
    if (quanta == 0) return ok_status();
    const auto ledger = state.fields().buffer("source_ledger");
    const std::uint64_t low = 2 * static_cast<std::uint64_t>(entry) * row_of(state) * 4, high = low + row_of(state) * 4;
    std::array<std::uint32_t, 2> words{};
    const auto word = [&](std::size_t n) { return std::span(words).subspan(n, 1); };
    auto& device = state.device();
    if (auto status = device.read(ledger, low, std::as_writable_bytes(word(0))); !status) return status;
    if (auto status = device.read(ledger, high, std::as_writable_bytes(word(1))); !status) return status;
    const std::uint64_t count = (std::uint64_t{words[0]} + (std::uint64_t{words[1]} << 32)) + static_cast<std::uint64_t>(quanta);
    words = {static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(count >> 32)};
    if (auto status = device.write(ledger, low, std::as_bytes(word(0))); !status) return status;
    return device.write(ledger, high, std::as_bytes(word(1)));
}

} // namespace wadi
