#include "engine/step/run/ledger.hpp"
#include <array>

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

Status count_in_ledger(WorldState& state, std::span<const LedgerChange> changes) {
    constexpr std::size_t most = LEDGER_ENTRIES;
    struct Counter { // the first of the entry's row takes it all: only the sum is ever looked at
        std::uint64_t at = 0;
        std::uint32_t before = 0, now = 0;
    };
    std::array<Counter, 2 * most> counters;
    std::size_t count = 0;
    const auto ledger = state.fields().buffer("source_ledger");
    auto& device = state.device();
    for (const auto& [entry, quanta] : changes) {
        if (quanta == 0) continue;
        const std::uint64_t low = 2 * static_cast<std::uint64_t>(entry) * row_of(state) * 4;
        Counter* pair = &counters[count];
        count += 2;
        pair[0].at = low;
        pair[1].at = low + row_of(state) * 4;
        for (Counter* word : {pair, pair + 1})
            if (auto status = device.read(ledger, word->at, std::as_writable_bytes(std::span(&word->before, 1))); !status)
                return status;
        const std::uint64_t sum =
            (std::uint64_t{pair[0].before} + (std::uint64_t{pair[1].before} << 32)) + static_cast<std::uint64_t>(quanta);
        pair[0].now = static_cast<std::uint32_t>(sum);
        pair[1].now = static_cast<std::uint32_t>(sum >> 32);
    }
    for (std::size_t n = 0; n < count; ++n) {
        auto status = device.write(ledger, counters[n].at, std::as_bytes(std::span(&counters[n].now, 1)));
        if (status) continue;
        for (std::size_t k = 0; k <= n; ++k)
            if (!device.write(ledger, counters[k].at, std::as_bytes(std::span(&counters[k].before, 1))))
                return device.give_up("the ledger is half written: " + status.message);
        return status;
    }
    return ok_status();
}

} // namespace wadi
