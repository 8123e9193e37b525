#include "engine/edits/regions.hpp"
#include "engine/settings/data/quanta.hpp"
#include "engine/settings/rules/messages.hpp"
#include "engine/step/plan/world_params.hpp"
#include "engine/step/run/ledger.hpp"
#include "engine/step/run/prestress.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace wadi {

namespace {

// Whole rows of a field, padding and ghost columns included; zero where the plan lacks the field.
class Rows {
  public:
    Rows(WorldState& state, const char* field, int first, int end)
        : state_(state), field_(field), offset_(state.layout().row(first)),
          values_(static_cast<std::size_t>(end - first) * static_cast<std::size_t>(state.layout().pitch())) {}

    Status read() { return state_.fields().read(field_, offset_, values_); }
    Status write() { return state_.fields().write(field_, offset_, values_); }
    float& at(int i, int j) { return values_[state_.layout().index(i, j) - offset_]; }

  private:
    WorldState& state_;
    const char* field_;
    std::size_t offset_;
    std::vector<float> values_;
};

// What decides whether a region may be written.
struct Bands {
    Bands(WorldState& state, int first, int end)
        : terrain(state, "terrain", first, end), sand(state, "sand_height", first, end),
          water(state, "water_height", first, end) {}
    Status read() {
        for (Rows* rows : {&terrain, &sand, &water}) {
            if (auto status = rows->read(); !status) return status;
        }
        return ok_status();
    }
    Rows& of(EditLayer layer) { return layer == EditLayer::terrain ? terrain : layer == EditLayer::sand ? sand : water; }

    Rows terrain, sand, water;
};

const char* layer_name(EditLayer layer) {
    return layer == EditLayer::terrain ? "terrain" : layer == EditLayer::sand ? "sand" : "water";
}

// Rounds the values and checks them against the columns they come into.
Status round_and_check(EditLayer layer, const Region& region, Bands& bands, const Method& method, std::vector<float>& values) {
    const double quantum = height_quantum(method), most = method.largest_height;
    for (int b = 0; b < region.ny; ++b) {
        for (int a = 0; a < region.nx; ++a) {
            float& value =
                values[static_cast<std::size_t>(b) * static_cast<std::size_t>(region.nx) + static_cast<std::size_t>(a)];
            const int i = region.i0 + a, j = region.j0 + b;
            const std::string cell = " in cell (" + std::to_string(i) + ", " + std::to_string(j) + ")";
            const double least = layer == EditLayer::terrain ? -most : 0, given = static_cast<double>(value);
            if (!(given >= least && given <= most))
                return error(Code::bad_argument,
                             outside_text(std::string("write_region: ") + layer_name(layer), given, least, most) + cell);
            value = static_cast<float>(nearest_quantum(given, quantum, Halves::even));
            double column = static_cast<double>(value);
            for (const auto other : {EditLayer::terrain, EditLayer::sand, EditLayer::water})
                if (other != layer) column += static_cast<double>(bands.of(other).at(i, j));
            if (column > most)
                return error(Code::bad_argument, "write_region: the column of terrain, sand and water" + cell + " would be " +
                                                     number_text(column) + " m high, above method.largest_height, " +
                                                     number_text(most) + " m");
        }
    }
    return ok_status();
}

// Terrain repeats its edge in the ghosts, in the rows of the band and in the ghost rows that belong to it.
void repeat_edges(const FieldLayout& layout, Rows& terrain, int first, int end) {
    for (int j = first; j < end; ++j) {
        const int row = std::clamp(j, 0, layout.ny - 1);
        for (int i = -GHOST; i < layout.nx + 1 + GHOST; ++i) terrain.at(i, j) = terrain.at(std::clamp(i, 0, layout.nx - 1), row);
    }
}

// The fields that a write of this layer changes: its heights first, and the strain of sand.
class Written {
  public:
    Written(WorldState& state, EditLayer layer, int first, int end) {
        if (layer == EditLayer::terrain) rows_.emplace_back(state, "terrain", first, end);
        if (layer == EditLayer::water) rows_.emplace_back(state, "water_height", first, end);
        if (layer != EditLayer::sand) return;
        for (const char* field : {"sand_height", "stretch_xx", "stretch_xy", "stretch_yy", "rotation"})
            rows_.emplace_back(state, field, first, end);
    }
    Status read() {
        return each([](Rows& rows) { return rows.read(); });
    }
    Status write() {
        return each([](Rows& rows) { return rows.write(); });
    }
    Rows& heights() { return rows_.front(); }
    std::span<Rows> strain() { return std::span(rows_).subspan(1); }

  private:
    template <class Call> Status each(const Call& call) {
        for (Rows& rows : rows_)
            if (auto status = call(rows); !status) return status;
        return ok_status();
    }
    std::vector<Rows> rows_;
};

// Values come into the rows; what that adds and takes.
std::array<LedgerChange, 2> put_values(Written& to, EditLayer layer, const Region& region, std::span<const float> values,
                                       double quantum) {
    Rows& written = to.heights();
    const bool sand = layer == EditLayer::sand;
    std::int64_t in = 0, out = 0;
    for (int b = 0; b < region.ny; ++b) {
        for (int a = 0; a < region.nx; ++a) {
            const int i = region.i0 + a, j = region.j0 + b;
            const float value =
                values[static_cast<std::size_t>(b) * static_cast<std::size_t>(region.nx) + static_cast<std::size_t>(a)];
            const float held = written.at(i, j);
            const std::int64_t change =
                add_quanta(to_quanta(static_cast<double>(value), quantum), -to_quanta(static_cast<double>(held), quantum));
            auto& moved = change > 0 ? in : out;
            moved = add_quanta(moved, std::abs(change));
            if (value > held) {
                for (Rows& rows : to.strain()) {
                    const float stretch = rows.at(i, j) * (held / value);
                    rows.at(i, j) = std::abs(stretch) < 1e-20F ? 0.0F : stretch; // as the stages do: no denormals
                }
            }
            written.at(i, j) = value;
        }
    }
    return {{{sand ? LEDGER_SAND_IN : LEDGER_WATER_IN, in}, {sand ? LEDGER_SAND_OUT : LEDGER_WATER_OUT, out}}};
}

// What a write that fails half way has changed is put back.
Status taken_back(WorldState& state, const Status& failed, const std::function<Status()>& put_back) {
    if (failed || !state.lost()) return failed;
    return put_back() ? failed
                      : state.device().give_up("write_region: what it had half done cannot be taken back: " + failed.message);
}

} // namespace

Status write_region(WorldState& state, Stepper& stepper, EditLayer layer, const Region& region, std::span<const float> values) {
    const auto& layout = state.layout();
    const auto& method = state.settings().method;
    if (auto status = check_region("write_region", region, state.settings().grid, values.size()); !status) return status;
    const bool terrain = layer == EditLayer::terrain, sand = layer == EditLayer::sand;
    // Rows at the rim bring their ghost rows with them.
    const int first = terrain && region.j0 == 0 ? -GHOST : region.j0;
    const int end = terrain && region.j0 + region.ny == layout.ny ? layout.ny + 1 + GHOST : region.j0 + region.ny;
    std::vector<float> rounded(values.begin(), values.end());
    {
        Bands now(state, first, end);
        if (auto status = now.read(); !status) return status;
        if (auto status = round_and_check(layer, region, now, method, rounded); !status) return status;
    }
    const bool some = std::any_of(rounded.begin(), rounded.end(), [](float h) { return h > 0.0F; });
    const Content brought{some && sand, some && !sand && !terrain};
    if (auto status = check_allowed(state.settings(), brought); !status)
        return error(Code::bad_argument, "write_region: " + status.message);
    const Content content{state.content.sand || brought.sand, state.content.water || brought.water};
    if (content != state.content) {
        if (auto status = stepper.set_content(content); !status) return status;
    }
    Written before(state, layer, first, end); // with the fields that the plan has now
    if (auto status = before.read(); !status) return status;
    Written after = before;
    state.tiles().wake_all();
    const auto run = [&] {
        if (auto status = sand ? change_balance(state, region, Balance::take) : ok_status(); !status) return status;
        if (auto status = sand ? after.read() : ok_status(); !status) return status;
        const auto moved = put_values(after, layer, region, rounded, ledger_quantum(method));
        if (terrain) repeat_edges(layout, after.heights(), first, end);
        if (auto status = after.write(); !status) return status;
        if (auto status = sand ? change_balance(state, region, Balance::add) : ok_status(); !status) return status;
        return terrain ? ok_status() : count_in_ledger(state, moved); // last: it is whole or not at all
    };
    return taken_back(state, run(), [&] { return before.write(); });
}

Status trim(WorldState& state, Stepper& stepper) {
    const auto holds = [&](const char* field) -> Result<bool> {
        Rows rows(state, field, 0, state.layout().ny);
        if (auto status = rows.read(); !status) return status;
        for (int j = 0; j < state.layout().ny; ++j)
            for (int i = 0; i < state.layout().nx; ++i)
                if (rows.at(i, j) > 0.0F) return true;
        return false;
    };
    const auto sand = holds("sand_height");
    if (!sand) return sand.status();
    const auto water = holds("water_height");
    if (!water) return water.status();
    auto sand_sides = read_side_ledger(state, "sand_side_ledger"), water_sides = read_side_ledger(state, "water_side_ledger");
    if (!sand_sides) return sand_sides.status();
    if (!water_sides) return water_sides.status();
    // The first thing that is changed under the new plan, and the last that may fail.
    const auto keep = [&] {
        std::vector<LedgerChange> changes;
        const auto add = [&](const char* field, const auto& sides, int in, int out) {
            if (state.plan().find(field) == nullptr) changes.insert(changes.end(), {{in, sides.first}, {out, sides.second}});
        };
        add("sand_side_ledger", *sand_sides, LEDGER_SAND_IN, LEDGER_SAND_OUT);
        add("water_side_ledger", *water_sides, LEDGER_WATER_IN, LEDGER_WATER_OUT);
        return count_in_ledger(state, changes);
    };
    return stepper.change(state.settings().live(), {*sand, *water}, keep);
}

} // namespace wadi
