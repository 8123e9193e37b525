#include "engine/step/initial_fields.hpp"
#include "engine/settings/quanta.hpp"
#include "engine/step/step_inputs.hpp"
#include "engine/step/world_params.hpp"
#include <algorithm>
#include <cmath>

namespace wadi {

namespace {

// Face velocities from cell-centred ones: the mean of the two cells; outer faces are walls until a side opens them.
std::vector<float> to_faces(const FieldLayout& layout, const std::vector<float>& cells, bool along_x) {
    std::vector<float> field(layout.size(), 0.0F);
    if (cells.empty()) return field;
    const auto at = [&](int i, int j) {
        return cells[static_cast<std::size_t>(j) * static_cast<std::size_t>(layout.nx) + static_cast<std::size_t>(i)];
    };
    for (int j = along_x ? 0 : 1; j < layout.ny; ++j) {
        for (int i = along_x ? 1 : 0; i < layout.nx; ++i) {
            field[layout.index(i, j)] = 0.5F * (at(i, j) + (along_x ? at(i - 1, j) : at(i, j - 1)));
        }
    }
    return field;
}

std::vector<float> rounded(std::vector<float> heights, double quantum) {
    for (auto& h : heights) h = static_cast<float>(nearest_quantum(static_cast<double>(h), quantum, Halves::even));
    return heights;
}

std::int64_t count_quanta(const std::vector<float>& heights, double quantum) {
    std::int64_t sum = 0;
    for (const float h : heights) sum = add_quanta(sum, to_quanta(static_cast<double>(h), quantum));
    return sum;
}

} // namespace

Status upload(WorldState& state, const InitialFields& fields) {
    const auto& method = state.settings().method;
    const auto& layout = state.layout();
    const auto heights = [&](const std::vector<float>& cells, bool repeat_edges) {
        return with_ghosts(layout, rounded(cells, height_quantum(method)), repeat_edges);
    };
    const auto sand = heights(fields.sand, false), water = heights(fields.water, false);
    const auto count = [&](const char* field, const std::vector<float>& cells) {
        return state.plan().find(field) == nullptr ? 0 : count_quanta(cells, ledger_quantum(method));
    };
    state.sand_initial = count("sand_height", sand);
    state.water_initial = count("water_height", water);
    const auto u = to_faces(layout, fields.velocity_x, true), v = to_faces(layout, fields.velocity_y, false);
    const std::pair<const char*, std::vector<float>> all[] = {
        {"terrain", heights(fields.terrain, true)},
        {"sand_height", sand},
        {"water_height", water},
        {"water_velocity_x", u},
        {"water_velocity_y", v},
        {"mixed_velocity_x", u},
        {"mixed_velocity_y", v},
        {"sand_velocity_x", to_faces(layout, fields.sand_velocity_x, true)},
        {"sand_velocity_y", to_faces(layout, fields.sand_velocity_y, false)}};
    for (const auto& [name, values] : all) {
        if (auto status = state.fields().write(name, 0, values); !status) return status;
    }
    const auto shapes = state.fields().buffer("source_shapes");
    if (shapes.id == 0) return ok_status();
    return state.device().write(shapes, 0, std::as_bytes(std::span<const vec4>(source_shapes(state.settings()))));
}

} // namespace wadi
