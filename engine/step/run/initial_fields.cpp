#include "engine/step/run/initial_fields.hpp"
#include "engine/settings/data/quanta.hpp"
#include "engine/step/plan/world_params.hpp"
#include "engine/threads/bands.hpp"
#include <cmath>
#include <numeric>
#include <span>
#include <string>

namespace wadi {

namespace {

// Face velocities from cell-centred ones: the mean of the two cells; outer faces are walls until a side opens them.
void fill_faces(const FieldLayout& layout, const std::vector<float>& cells, bool along_x, int j, std::span<float> row) {
    if (j < (along_x ? 0 : 1) || j >= layout.ny) return;
    const auto width = static_cast<std::size_t>(layout.nx), start = static_cast<std::size_t>(j) * width;
    for (std::size_t i = along_x ? 1 : 0; i < width; ++i)
        row[i + GHOST] = 0.5F * (cells[start + i] + cells[start + i - (along_x ? 1 : width)]);
}

std::int64_t count_quanta(const std::vector<float>& heights, double quantum, double unit) {
    std::vector<std::int64_t> parts(bands_of(heights.size(), CELL_BAND));
    in_bands(heights.size(), CELL_BAND, [&](std::size_t n, std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell) {
            const auto height = static_cast<float>(nearest_quantum(static_cast<double>(heights[cell]), quantum, Halves::even));
            parts[n] = add_quanta(parts[n], to_quanta(static_cast<double>(height), unit));
        }
    });
    return std::accumulate(parts.begin(), parts.end(), std::int64_t{0}, add_quanta);
}

// A level's water fills pores first (NUMERICS 2.24).
Status fill_pores(WorldState& state, const InitialFields& fields, double quantum) {
    if (state.plan().find("water_in_pores") == nullptr || fields.water.empty()) return ok_status();
    const auto& layout = state.layout();
    const float porosity = state.params().porosity;
    const auto whole = [&](float h) { return nearest_quantum(static_cast<double>(h), quantum, Halves::even); };
    return state.fields().write_rows("water_in_pores", [&](int j, std::span<float> row) {
        if (j < 0 || j >= layout.ny) return;
        const std::size_t start = static_cast<std::size_t>(j) * static_cast<std::size_t>(layout.nx);
        for (std::size_t i = 0; i < static_cast<std::size_t>(layout.nx); ++i) {
            const double water = whole(fields.water[start + i]);
            const auto room =
                static_cast<double>(porosity * static_cast<float>(fields.sand.empty() ? 0.0 : whole(fields.sand[start + i])));
            const double holds = quantum > 0 ? std::floor(room / quantum) * quantum : room;
            row[i + GHOST] = water > 0 && water >= holds ? FULL_PORES : static_cast<float>(water);
        }
    });
}

} // namespace

Status upload(WorldState& state, const InitialFields& fields) {
    const auto& method = state.settings().method;
    const auto& layout = state.layout();
    const double quantum = height_quantum(method);
    const auto count = [&](const char* field, const std::vector<float>& cells) {
        return state.plan().find(field) == nullptr ? 0 : count_quanta(cells, quantum, ledger_quantum(method));
    };
    state.sand_initial = count("sand_height", fields.sand);
    state.water_initial = count("water_height", fields.water);
    // What holds nothing is left out: new buffers hold 0.
    const auto heights = [&](const char* name, const std::vector<float>& cells, bool repeat_edges) {
        if (cells.empty()) return ok_status();
        return state.fields().write_rows(name, [&](int j, std::span<float> row) {
            fill_row(layout, cells, repeat_edges, j, row);
            for (float& h : row) h = static_cast<float>(nearest_quantum(static_cast<double>(h), quantum, Halves::even));
        });
    };
    if (auto status = heights("terrain", fields.terrain, true); !status) return status;
    if (auto status = heights("sand_height", fields.sand, false); !status) return status;
    if (auto status = heights("water_height", fields.water, false); !status) return status;
    if (auto status = fill_pores(state, fields, quantum); !status) return status;
    for (const std::string layer : {"water", "mixed", "sand"})
        for (const bool along_x : {true, false}) {
            const bool sand = layer == "sand";
            const auto& cells = along_x ? (sand ? fields.sand_velocity_x : fields.velocity_x)
                                        : (sand ? fields.sand_velocity_y : fields.velocity_y);
            if (cells.empty()) continue;
            const auto fill = [&](int j, std::span<float> row) { fill_faces(layout, cells, along_x, j, row); };
            if (auto status = state.fields().write_rows(layer + "_velocity_" + (along_x ? "x" : "y"), fill); !status)
                return status;
        }
    return state.write_source_shapes();
}

} // namespace wadi
