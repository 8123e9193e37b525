// The same case at two places of a plateau: nothing may depend on where in the grid, in a group of threads or in a row it lies.
#include "tests/fuzz/run.hpp"
#include <algorithm>
#include <cmath>

namespace wadi::fuzz {

namespace {

constexpr int MARGIN = 16, MOST_SHIFT = 5; // cells of plateau on every side

struct Place {
    int x = 0, y = 0; // of the case's first cell
};

// The case with walls, without rain, on a plateau as high as its highest column and a cell more. Edits lie on whole 1/256 cells
// and sources on whole cells, so that their distances to cells are the same floats anywhere.
Case placed(const Case& c, Place at) {
    Case result = c;
    auto& s = result.scene.settings;
    const Grid small = c.scene.settings.grid;
    s.grid.nx += 2 * MARGIN;
    s.grid.ny += 2 * MARGIN;
    s.sides = {};
    s.rain = {};
    s.evaporation = {};
    const auto& f = c.scene.fields;
    const auto value = [](const std::vector<float>& field, std::size_t n) { return field.empty() ? 0.0F : field[n]; };
    float top = 0;
    for (std::size_t n = 0; n < static_cast<std::size_t>(small.nx) * static_cast<std::size_t>(small.ny); ++n)
        top = std::max(top, value(f.terrain, n) + value(f.sand, n) + value(f.water, n));
    const auto put = [&](std::vector<float>& field, float beyond) {
        std::vector<float> large(static_cast<std::size_t>(s.grid.nx) * static_cast<std::size_t>(s.grid.ny), beyond);
        for (int j = 0; j < small.ny; ++j)
            for (int i = 0; i < small.nx; ++i)
                large[static_cast<std::size_t>(j + at.y) * static_cast<std::size_t>(s.grid.nx) +
                      static_cast<std::size_t>(i + at.x)] =
                    value(field, static_cast<std::size_t>(j) * static_cast<std::size_t>(small.nx) + static_cast<std::size_t>(i));
        field = large;
    };
    auto& to = result.scene.fields;
    put(to.terrain, top + static_cast<float>(small.dx));
    for (auto* field : {&to.sand, &to.water, &to.velocity_x, &to.velocity_y, &to.sand_velocity_x, &to.sand_velocity_y})
        if (!field->empty()) put(*field, 0);
    if (!s.roughness.empty()) put(s.roughness, 0);
    if (!s.rain_map.empty()) put(s.rain_map, 0);
    const auto moved = [&](double metres, int cells) { return (std::round(metres / small.dx * 256) / 256 + cells) * small.dx; };
    for (Edit& edit : result.commands) {
        edit.x0 = moved(edit.x0, at.x);
        edit.x1 = moved(edit.x1, at.x);
        edit.y0 = moved(edit.y0, at.y);
        edit.y1 = moved(edit.y1, at.y);
    }
    const auto within = [&](double metres, int cells, double part) {
        return (std::floor(metres / small.dx) + part + cells) * small.dx;
    };
    for (Source& source : s.sources) {
        source.center = {within(source.center[0], at.x, 0.5), within(source.center[1], at.y, 0.5)};
        source.box = {within(source.box[0], at.x, 0.25), within(source.box[1], at.y, 0.25), within(source.box[2], at.x, 1.25),
                      within(source.box[3], at.y, 1.25)};
    }
    return result;
}

// Whether something has come so near to the rim that its walls may have been felt.
bool rim_is_dry(Run& run) {
    const Grid& grid = run.world->settings().grid;
    for (const char* name : {"sand_height", "water_height"}) {
        std::vector<float> heights(static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny));
        run.note("read", run.world->reader().read(name, heights));
        if (!run.good()) return false;
        for (int j = 0; j < grid.ny; ++j)
            for (int i = 0; i < grid.nx; ++i) {
                const bool inside = std::min(i, j) > 2 && i < grid.nx - 3 && j < grid.ny - 3;
                if (!inside &&
                    heights[static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.nx) + static_cast<std::size_t>(i)] > 0)
                    return false;
            }
    }
    return true;
}

} // namespace

std::string check_shift(const Case& c, const Case& twin, Session& session, Random& random, bool& compared) {
    const Place first{MARGIN, MARGIN},
        second{MARGIN + random.whole(-MOST_SHIFT, MOST_SHIFT), MARGIN + random.whole(-MOST_SHIFT, MOST_SHIFT)};
    const Case a = placed(c, first), b = placed(twin, second);
    Run one = open(a, session), other = open(b, session);
    if (!one.refused.empty() || !other.refused.empty()) return one.refused == other.refused ? "" : one.refused + other.refused;
    queue(one, a);
    queue(other, b);
    step(one, c.steps);
    step(other, c.steps);
    if (!one.good() || !other.good()) return one.failure + other.failure;
    if (!rim_is_dry(one) || !rim_is_dry(other)) return one.failure + other.failure;
    compared = true;
    const auto& grid = c.scene.settings.grid;
    const FieldLayout layout{one.world->settings().grid.nx, one.world->settings().grid.ny};
    for (const auto& field : one.world->plan().fields) {
        if (field.role != FieldRole::state) continue;
        auto here = one.world->reader().read_raw(field.name), there = other.world->reader().read_raw(field.name);
        one.note("read", here.status());
        other.note("read", there.status());
        if (!here || !there) return one.failure + other.failure;
        for (int j = 0; j <= grid.ny; ++j)
            for (int i = 0; i <= grid.nx; ++i) {
                const float x = (*here)[layout.index(i + first.x, j + first.y)],
                            y = (*there)[layout.index(i + second.x, j + second.y)];
                if (!(x <= y && x >= y) && !(std::isnan(x) && std::isnan(y)))
                    return field.name + "(" + std::to_string(i) + ", " + std::to_string(j) + ") is " +
                           text(static_cast<double>(x)) + ", " + text(static_cast<double>(y)) + " when shifted by (" +
                           std::to_string(second.x - first.x) + ", " + std::to_string(second.y - first.y) + ") cells";
            }
    }
    return {};
}

} // namespace wadi::fuzz
