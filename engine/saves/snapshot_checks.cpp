#include "engine/saves/snapshot_checks.hpp"
#include "engine/settings/data/quanta.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/messages.hpp"
#include "engine/step/plan/field_table.hpp"
#include "engine/step/plan/world_params.hpp"
#include "engine/threads/bands.hpp"
#include <algorithm>
#include <cmath>

namespace wadi {

namespace {

// Flow may pile columns above method.largest_height, by how much no rule says: as far as the fuzzer calls a world finite.
constexpr double PILED_MOST = 1e6;
constexpr double STRAIN_MOST = 1e7;            // as stages clamp it
constexpr double PUBLISHED_STRAIN_MOST = 1e30; // which the paper's method does not: as far as GPUs divide exactly
constexpr double RIM_MOST = 1e7;               // shares and speeds, no unit larger
constexpr std::uint64_t STEPS_MOST = std::uint64_t{1} << 53;
constexpr double QUANTA_MOST = 0x1p62;

struct Range {
    double least = 0, most = 0;
};

Range range_of(const std::string& field, const Settings& settings) {
    const double height = PILED_MOST * settings.method.largest_height;
    if (field == "terrain") return {-height, height};
    if (field.ends_with("_height") || field == "wedge_depth") return {0, height};
    const double strain = settings.method.published() ? PUBLISHED_STRAIN_MOST : STRAIN_MOST;
    if (field.find("velocity") == std::string::npos) return {-strain, strain};
    const double fastest = settings.method.velocity_clamp * settings.grid.dx / settings.dt *
                           std::max({1, settings.method.substeps, settings.method.water_substeps});
    const double speed = std::max(SPEED_MOST, 2 * fastest);
    return {-speed, speed};
}

/// A field in a snapshot: floats at any address.
class Contents {
  public:
    Contents(std::span<const std::byte> bytes, const FieldLayout& layout) : bytes_(bytes), layout_(layout) {}
    double at(int i, int j) const { return static_cast<double>(get<float>(bytes_, layout_.index(i, j) * 4)); }

  private:
    std::span<const std::byte> bytes_;
    FieldLayout layout_;
};

std::span<const std::byte> contents_of(const SnapshotHeader& header, std::span<const std::byte> snapshot, std::size_t field) {
    return snapshot.subspan(in_memory(header.begin_of(field)), in_memory(header.fields[field].bytes));
}

Status check_field(const std::string& name, const Contents& values, const FieldLayout& layout, const Range& range) {
    const int across = layout.nx + 1 + 2 * GHOST;
    const auto width = static_cast<std::size_t>(across);
    const auto column = [&](std::size_t n) { return static_cast<int>(n % width) - GHOST; };
    const auto row = [&](std::size_t n) { return static_cast<int>(n / width) - GHOST; };
    const std::size_t count = width * static_cast<std::size_t>(layout.rows());
    const std::size_t wrong = first_cell(count, [&](std::size_t n) {
        const double value = values.at(column(n), row(n));
        return !(value >= range.least && value <= range.most);
    });
    if (wrong == count) return ok_status();
    return error(Code::bad_file,
                 outside_text("snapshot: " + name, values.at(column(wrong), row(wrong)), range.least, range.most) + " in cell (" +
                     std::to_string(column(wrong)) + ", " + std::to_string(row(wrong)) + ")");
}

/// What outer faces have learnt: speeds and shares.
Status check_rim(const std::string& name, std::span<const std::byte> numbers) {
    for (std::size_t n = 0; n < numbers.size() / sizeof(float); ++n) {
        const auto value = static_cast<double>(get<float>(numbers, n * sizeof(float)));
        if (!(std::fabs(value) <= RIM_MOST))
            return error(Code::bad_file,
                         outside_text("snapshot: " + name + ", number " + std::to_string(n), value, -RIM_MOST, RIM_MOST));
    }
    return ok_status();
}

/// What each rate brought is cut to whole quanta: the two numbers of a total differ by less than one, and by rounding.
Status check_totals(const HostTotals& totals, double quantum) {
    const auto refuse = [](const std::string& text) { return error(Code::bad_file, "snapshot: " + text); };
    if (totals.steps > STEPS_MOST) return refuse(std::to_string(totals.steps) + " steps are more than a world takes");
    for (const std::int64_t initial : {totals.sand_initial, totals.water_initial})
        if (initial < 0 || initial > MOST_QUANTA) return refuse("its books begin with " + std::to_string(initial) + " quanta");
    for (const auto& [metres, quanta] : totals.inputs) {
        const double unit = quantum > 0 ? quantum : 1, most = QUANTA_MOST * unit;
        const bool sane = std::fabs(metres) <= most && std::fabs(quanta) <= QUANTA_MOST && quanta == std::floor(quanta);
        const double off = std::fabs(metres / unit - quanta);
        if (!sane || (quantum > 0 && !(off <= 2 + 1e-12 * std::fabs(quanta))))
            return refuse("a running total of " + number_text(metres) + " m is not its " + number_text(quanta) + " quanta");
    }
    return ok_status();
}

} // namespace

Status check_contents(const SnapshotHeader& header, std::span<const std::byte> snapshot, const Settings& settings) {
    if (auto status = check_totals(header.totals, height_quantum(settings.method)); !status) return status;
    const FieldLayout layout{header.nx, header.ny};
    for (std::size_t n = 0; n < header.fields.size(); ++n) {
        const std::string& name = header.fields[n].name;
        const FieldRole role = field_row(name).role;
        if (role == FieldRole::rim) {
            if (auto status = check_rim(name, contents_of(header, snapshot, n)); !status) return status;
        }
        if (role != FieldRole::state) continue; // counters may hold any bits
        const Contents values(contents_of(header, snapshot, n), layout);
        if (auto status = check_field(name, values, layout, range_of(name, settings)); !status) return status;
    }
    return ok_status();
}

Drift drift_of(const SnapshotHeader& header, std::span<const std::byte> snapshot, const Settings& settings) {
    const FieldLayout layout{header.nx, header.ny};
    const double quantum = ledger_quantum(settings.method);
    Drift drift{-header.totals.sand_initial, -header.totals.water_initial};
    const auto held = [&](const Contents& values) {
        std::vector<std::int64_t> rows(static_cast<std::size_t>(layout.ny));
        in_bands(rows.size(), row_band(static_cast<std::size_t>(layout.nx)),
                 [&](std::size_t, std::size_t begin, std::size_t end) {
                     for (std::size_t j = begin; j < end; ++j)
                         for (int i = 0; i < layout.nx; ++i)
                             rows[j] = add_quanta(rows[j], to_quanta(values.at(i, static_cast<int>(j)), quantum));
                 });
        std::int64_t sum = 0;
        for (const std::int64_t row : rows) sum = add_quanta(sum, row);
        return sum;
    };
    // Low words, then high words, of an entry.
    const auto entry = [](std::span<const std::byte> words, std::size_t row, int number) {
        std::uint64_t sum = 0;
        const std::size_t first = 2 * static_cast<std::size_t>(number) * row;
        for (std::size_t n = 0; n < row; ++n)
            sum += get<std::uint32_t>(words, 4 * (first + n)) +
                   (std::uint64_t{get<std::uint32_t>(words, 4 * (first + row + n))} << 32);
        return static_cast<std::int64_t>(sum);
    };
    const auto book = [&](std::int64_t& of, std::span<const std::byte> words, std::size_t row, int in, int out) {
        of = add_quanta(of, add_quanta(entry(words, row, out), -entry(words, row, in)));
    };
    const auto row = static_cast<std::size_t>(layout.strips()) * static_cast<std::size_t>(layout.pitch());
    const auto rim = static_cast<std::size_t>(layout.rim());
    for (std::size_t n = 0; n < header.fields.size(); ++n) {
        const std::string& name = header.fields[n].name;
        const auto bytes = contents_of(header, snapshot, n);
        if (name == "sand_height") drift.sand = add_quanta(drift.sand, held({bytes, layout}));
        if (name == "water_height") drift.water = add_quanta(drift.water, held({bytes, layout}));
        if (name == "sand_side_ledger") book(drift.sand, bytes, rim, 0, 1);
        if (name == "water_side_ledger") book(drift.water, bytes, rim, 0, 1);
        if (name != "source_ledger") continue;
        book(drift.sand, bytes, row, LEDGER_SAND_IN, LEDGER_SAND_OUT);
        book(drift.water, bytes, row, LEDGER_WATER_IN, LEDGER_WATER_OUT);
    }
    return drift;
}

} // namespace wadi
