#include "tests/conformance/stage_checks.hpp"
#include "tests/conformance/active_tiles_check.hpp"
#include "tests/conformance/edits_check.hpp"
#include "tests/conformance/stage_inputs.hpp"
#include "tests/conformance/values_check.hpp"
#include <algorithm>
#include <bit>
#include <cmath>

namespace wadi::conformance {

namespace {

double wide(float x) { return static_cast<double>(x); }

// Quanta of a depth [m]: exact where heights are whole quanta, within one for each amount that was rounded otherwise.
struct Count {
    double least = 0, most = 0;
    void add(double depth, const WorldParams& params) {
        const double n = depth * wide(params.inv_ledger_quantum);
        const bool exact = params.quantum > 0.0F;
        least += exact ? n : std::floor(n * (1 - 1e-6));
        most += exact ? n : std::ceil(n * (1 + 1e-6) + 0.5);
    }
};

/// 64-bit counts, each kept as a low and a high word.
struct Counters {
    std::size_t low, high, number = 1; // places of the first
};

// What counters grew by together against what it should be.
Verdict check_count(const BenchBuffer& ledger, const Counters& at, const Count& expected, const std::string& what) {
    const auto count = [](std::uint32_t l, std::uint32_t h) { return std::uint64_t{l} + (std::uint64_t{h} << 32); };
    std::uint64_t grown = 0;
    for (std::size_t n = 0; n < at.number; ++n) {
        const std::size_t low = at.low + n, high = at.high + n;
        grown += count(ledger.words()[low], ledger.words()[high]) - count(ledger.before[low], ledger.before[high]);
    }
    if (static_cast<double>(grown) >= expected.least && static_cast<double>(grown) <= expected.most) return {};
    return failed(what + " grew by " + std::to_string(grown) + " quanta, expected " + std::to_string(expected.least) + " to " +
                  std::to_string(expected.most));
}

Verdict check_side_ledger(const StageRun& run) {
    const WorldParams& p = run.params;
    const std::size_t rim = static_cast<std::size_t>(2 * (p.nx + p.ny));
    const BenchBuffer& ledger = run.buffer("side_ledger");
    std::size_t n = 0;
    for (const int side : {SIDE_WEST, SIDE_EAST, SIDE_SOUTH, SIDE_NORTH}) {
        const bool along_y = side == SIDE_WEST || side == SIDE_EAST, low = side == SIDE_WEST || side == SIDE_SOUTH;
        for (int b = 0; b < (along_y ? p.ny : p.nx); ++b, ++n) {
            const int a = low ? 0 : along_y ? p.nx : p.ny;
            const double flux = wide(along_y ? run.before("flux_x", a, b) : run.before("flux_y", b, a)) * (low ? 1 : -1);
            Count in, out;
            in.add(std::max(flux, 0.0), p);
            out.add(std::max(-flux, 0.0), p);
            const std::string face = "face " + std::to_string(b) + " of side " + std::to_string(side);
            if (auto v = check_count(ledger, {n, rim + n}, in, "inflow of " + face); v.outcome != Outcome::ok) return v;
            if (auto v = check_count(ledger, {2 * rim + n, 3 * rim + n}, out, "outflow of " + face); v.outcome != Outcome::ok)
                return v;
        }
    }
    return {};
}

using Counts = std::array<Count, LEDGER_ENTRIES>;

// The water of a cell that stands so deep: where pores hold less than they could (NUMERICS 2.24), the more of it on the sand.
double wanted_water(const StageRun& run, int i, int j, double depth, double sand) {
    const double held = wide(run.before("water_in_pores", i, j)), room = pore_room(run.params, sand);
    const bool waits = (run.scene.effects & EFFECT_INFILTRATION) != 0 && held >= 0 && held < room && depth >= sand;
    return waits ? depth - (sand - held) : water_standing(run.params, depth, sand);
}

// Adds what sources and sinks do to a cell, in their order, to the counts.
void count_sources(const StageRun& run, int i, int j, Counts& counts) {
    const auto& settings = run.scene.settings;
    const double dx = settings.grid.dx, x = (i + 0.5) * dx, y = (j + 0.5) * dx;
    double water = wide(run.before("water_height", i, j)), sand = wide(run.before("sand_height", i, j));
    for (std::size_t n = 0; n < settings.sources.size(); ++n) {
        const Source& source = settings.sources[n];
        const bool point = source.shape == SourceShape::point;
        const bool here = point ? i == static_cast<int>(source.center[0] / dx) && j == static_cast<int>(source.center[1] / dx)
                          : source.shape == SourceShape::disc
                              ? std::hypot(x - source.center[0], y - source.center[1]) <= source.radius
                              : x >= source.box[0] && y >= source.box[1] && x < source.box[2] && y < source.box[3];
        if (!here) continue;
        const bool is_water = source.material == SourceMaterial::water;
        const vec4& now = run.pilot.input.source[n];
        double depth = wide(now.x);
        if (!source.level.samples.empty())
            depth =
                std::clamp(wanted_water(run, i, j, std::max(wide(now.y) - wide(run.before("terrain", i, j)), 0.0), sand) - water,
                           source.drain ? -depth : 0.0, depth);
        if (depth > 0 && wide(run.before("terrain", i, j)) + water + sand + depth > wide(run.params.largest_height)) {
            counts[LEDGER_REFUSED].add(depth, run.params);
            continue;
        }
        if ((run.scene.effects & (is_water ? EFFECT_WATER : EFFECT_SAND)) == 0) continue;
        double& held = is_water ? water : sand;
        const double added = std::max(depth, -held);
        held += added;
        const int entry = is_water ? LEDGER_WATER_IN : LEDGER_SAND_IN; // the entry that follows it counts what went out
        counts[static_cast<std::size_t>(added > 0 ? entry : entry + 1)].add(std::abs(added), run.params);
    }
}

// Under a map what a cell's share of all rain so far, cut to whole quanta, has grown by.
double rain_on(const StageRun& run, int i, int j) {
    if ((run.scene.effects & EFFECT_RAIN_MAP) == 0) return wide(run.pilot.input.rain);
    const double share = wide(run.before("rain_share", i, j)) / 65536, most = wide(run.pilot.input.mapped_rain.x),
                 before = wide(run.pilot.input.mapped_rain.y), quantum = wide(run.params.quantum);
    if (quantum == 0) return share * most;
    return (std::floor(share * (before + most / quantum)) - std::floor(share * before)) * quantum;
}

void count_rain(const StageRun& run, int i, int j, Counts& counts) {
    const double rain = rain_on(run, i, j), evaporation = wide(run.pilot.input.evaporation);
    const double water = wide(run.before("water_height", i, j)), sand = wide(run.before("sand_height", i, j));
    const bool fits = wide(run.before("terrain", i, j)) + water + sand + rain <= wide(run.params.largest_height);
    counts[fits ? LEDGER_WATER_IN : LEDGER_REFUSED].add(rain, run.params);
    counts[LEDGER_WATER_OUT].add(std::min(water + (fits ? rain : 0.0), evaporation), run.params);
}

// Counts of the row of counters of an entry, `from` to `to`.
Verdict check_entries(const StageRun& run, const Counts& counts, std::size_t from, std::size_t to, const std::string& where) {
    const BenchBuffer& ledger = run.buffer("source_ledger");
    const auto row = static_cast<std::size_t>(run.params.strips * run.params.pitch);
    for (std::size_t entry = 0; entry < LEDGER_ENTRIES; ++entry) {
        const std::size_t low = 2 * entry * row, high = low + row;
        auto v = check_count(ledger, {low + from, high + from, to - from}, counts[entry],
                             "ledger entry " + std::to_string(entry) + where);
        if (v.outcome != Outcome::ok) return v;
    }
    return {};
}

Verdict check_rain_ledger(const StageRun& run) {
    const WorldParams& p = run.params;
    for (int strip = 0; strip < p.strips; ++strip) {
        for (int i = 0; i < p.pitch; ++i) {
            Counts counts;
            for (int j = strip * STRIP; i < p.nx && j < std::min((strip + 1) * STRIP, p.ny); ++j) count_rain(run, i, j, counts);
            const auto at = static_cast<std::size_t>(strip * p.pitch + i);
            auto v =
                check_entries(run, counts, at, at + 1, " of column " + std::to_string(i) + ", strip " + std::to_string(strip));
            if (v.outcome != Outcome::ok) return v;
        }
    }
    return {};
}

// By all counters together: which of them takes a cell's depth is the stage's choice.
Verdict check_source_ledger(const StageRun& run) {
    Counts counts;
    for (int j = 0; j < run.params.ny; ++j)
        for (int i = 0; i < run.params.nx; ++i) count_sources(run, i, j, counts);
    return check_entries(run, counts, 0, static_cast<std::size_t>(run.params.strips * run.params.pitch), "");
}

// The mean of both velocities, in bits.
Verdict check_start(const StageRun& run) {
    const FieldLayout layout{run.params.nx, run.params.ny};
    for (const auto& [name, tried] : {std::pair{"velocity_x", "tried_velocity_x"}, std::pair{"velocity_y", "tried_velocity_y"}}) {
        for (int j = 0; j <= run.params.ny; ++j) {
            for (int i = 0; i <= run.params.nx; ++i) {
                const float got = run.buffer(name).floats()[layout.index(i, j)];
                const double mean = 0.5 * (wide(run.before(name, i, j)) + wide(run.before(tried, i, j)));
                const double expected = std::abs(mean) < 1e-20 ? 0 : wide(static_cast<float>(mean));
                if (wide(got) != expected)
                    return failed(std::string(name) + "(" + std::to_string(i) + ", " + std::to_string(j) + ") is " +
                                  std::to_string(got) + ", the mean " + std::to_string(expected));
            }
        }
    }
    return {};
}

struct Definition {
    const char* stage;
    Verdict (*check)(const StageRun& run);
};

constexpr Definition definitions[] = {
    {"fold_tiles", check_tiles},
    {"interpolate_output", check_published},
    {"measure_strips", check_strips},
    {"publish_flow", check_published},
    {"publish_foam", check_published},
    {"publish_free_surface", check_published},
    {"publish_normal", check_published},
    {"publish_packed", check_published},
    {"publish_packed_half", check_published},
    {"publish_sand_surface", check_published},
    {"publish_saturation", check_published},
    {"publish_smooth_surface", check_published},
    {"publish_velocity", check_published},
    {"publish_water_depth", check_published},
    {"start_water_velocity", check_start},
    {"account_sides", check_side_ledger},
    {"apply_rain", check_rain_ledger},
    {"apply_sources", check_source_ledger},
    {"mark_limits", check_marks},
    {"count_limits", check_limit_counts},
    {"fold_limits", check_limit_folds},
    {"sample_points", check_samples},
    {"apply_edits", check_edits},
    {"write_values", check_values},
    {"mark_active_tiles", check_active_tiles},
    {"choose_active_tiles", check_active_tiles},
    {"look_into_tiles", check_active_tiles},
    {"keep_water_awake", check_active_tiles},
    {"count_active_tiles", check_active_tiles},
    {"list_active_tiles", check_active_tiles},
};

} // namespace

const BenchBuffer& StageRun::buffer(const char* binding) const {
    static const BenchBuffer none;
    for (std::size_t b = 0; b < buffers.size(); ++b)
        if (stage.bindings[b].name == binding) return buffers[b];
    return none;
}

float StageRun::before(const char* binding, int i, int j) const {
    const BenchBuffer& from = buffer(binding);
    return from.exists ? std::bit_cast<float>(from.before[FieldLayout{params.nx, params.ny}.index(i, j)]) : 0.0F;
}

double pore_room(const WorldParams& params, double sand) {
    const double room = static_cast<double>(params.porosity) * sand, quantum = static_cast<double>(params.quantum);
    return quantum > 0 ? std::floor(room / quantum) * quantum : room;
}

double water_standing(const WorldParams& params, double depth, double sand) {
    return depth < sand ? pore_room(params, depth) : depth - (sand - pore_room(params, sand));
}

bool has_definition(const std::string& stage) {
    return std::any_of(std::begin(definitions), std::end(definitions), [&](const Definition& d) { return stage == d.stage; });
}

Verdict check_definition(const StageRun& run) {
    for (const Definition& definition : definitions)
        if (run.stage.name == definition.stage) return definition.check(run);
    return {};
}

} // namespace wadi::conformance
