#include "sculpt.hpp"
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace viewer {
namespace {

/// The cells round a place, with ground and sand.
struct Patch {
    wadi_region region{};
    std::vector<float> ground, sand;
    glm::vec2 corner{0}; // middle of the first cell [m]
    float dx = 1;

    std::size_t at(int i, int j) const {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(region.nx) + static_cast<std::size_t>(i);
    }
    glm::vec2 middle(int i, int j) const { return corner + dx * glm::vec2(static_cast<float>(i), static_cast<float>(j)); }
};

Patch read_patch(const Simulation& simulation, glm::vec2 middle, float radius) {
    const float dx = simulation.grid.dx;
    const auto first = [&](float from, int cells) { return std::clamp(static_cast<int>(std::floor(from / dx)), 0, cells - 1); };
    Patch patch;
    patch.dx = dx;
    patch.region.i0 = first(middle.x - radius, simulation.info.nx);
    patch.region.j0 = first(middle.y - radius, simulation.info.ny);
    patch.region.nx = first(middle.x + radius, simulation.info.nx) - patch.region.i0 + 1;
    patch.region.ny = first(middle.y + radius, simulation.info.ny) - patch.region.j0 + 1;
    patch.corner = dx * (glm::vec2(static_cast<float>(patch.region.i0), static_cast<float>(patch.region.j0)) + 0.5f);
    const std::size_t cells = static_cast<std::size_t>(patch.region.nx) * static_cast<std::size_t>(patch.region.ny);
    patch.ground.resize(cells);
    patch.sand.resize(cells);
    check(wadi_world_read_region(simulation.world, WADI_FIELD_TERRAIN, &patch.region, patch.ground.data(), cells), "the ground");
    check(wadi_world_read_region(simulation.world, WADI_FIELD_SAND_DEPTH, &patch.region, patch.sand.data(), cells), "the sand");
    return patch;
}

void write_sand(const Simulation& simulation, const Patch& patch) {
    check(wadi_world_write_region(simulation.world, WADI_FIELD_SAND_DEPTH, &patch.region, patch.sand.data(), patch.sand.size()),
          "shaping the sand");
}

} // namespace

float surface_at(const Simulation& simulation, glm::vec2 place) {
    const Patch patch = read_patch(simulation, place, 0);
    return patch.ground[0] + patch.sand[0];
}

void smooth_sand(Simulation& simulation, glm::vec2 middle, float radius, float share) {
    Patch patch = read_patch(simulation, middle, radius);
    const double quantum = simulation.quantum();
    const std::vector<float> before = patch.sand;
    const auto flow = [&](std::size_t a, std::size_t b) {
        const double fall = static_cast<double>(patch.ground[a]) + static_cast<double>(before[a]) -
                            static_cast<double>(patch.ground[b]) - static_cast<double>(before[b]);
        const double held = static_cast<double>(fall > 0 ? before[a] : before[b]) / 4; // a cell has four neighbours
        double moved = std::clamp(static_cast<double>(share) * fall, -held, held);
        if (quantum > 0) moved = std::trunc(moved / quantum) * quantum;
        patch.sand[a] = static_cast<float>(static_cast<double>(patch.sand[a]) - moved);
        patch.sand[b] = static_cast<float>(static_cast<double>(patch.sand[b]) + moved);
    };
    const auto inside = [&](int i, int j) { return glm::distance(patch.middle(i, j), middle) <= radius; };
    for (int j = 0; j < patch.region.ny; ++j) {
        for (int i = 0; i < patch.region.nx; ++i) {
            if (!inside(i, j)) continue;
            if (i + 1 < patch.region.nx && inside(i + 1, j)) flow(patch.at(i, j), patch.at(i + 1, j));
            if (j + 1 < patch.region.ny && inside(i, j + 1)) flow(patch.at(i, j), patch.at(i, j + 1));
        }
    }
    write_sand(simulation, patch);
}

double flatten_sand(Simulation& simulation, glm::vec2 middle, float radius, float level, float most) {
    Patch patch = read_patch(simulation, middle, radius);
    double volume = 0;
    for (int j = 0; j < patch.region.ny; ++j) {
        for (int i = 0; i < patch.region.nx; ++i) {
            if (glm::distance(patch.middle(i, j), middle) > radius) continue;
            float& sand = patch.sand[patch.at(i, j)];
            const float change = std::clamp(std::max(level - patch.ground[patch.at(i, j)], 0.0f) - sand, -most, most);
            sand += change;
            volume += static_cast<double>(change * patch.dx * patch.dx);
        }
    }
    write_sand(simulation, patch);
    return volume;
}

} // namespace viewer
