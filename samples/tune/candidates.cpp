#include "candidates.hpp"
#include <algorithm>
#include <cmath>

namespace tune {
namespace {

constexpr int LEAST_CELLS = 16;      // along the shorter side
constexpr double FINEST = 4;         // times the level's cells along x
constexpr double GRID_RATIO = 1.025; // of neighbouring grids
constexpr double WORTH = 0.99;       // a dearer setting must leave at most this share of the error

} // namespace

std::vector<Way> ways(const Level& level, bool has_sand, bool has_water) {
    const Way own = level.own_way();
    std::vector<int> substeps = has_sand ? std::vector<int>{2, 1, 3} : std::vector<int>{own.substeps};
    if (has_sand && own.substeps > 3) substeps.push_back(own.substeps);
    std::vector<Way> list;
    for (const int t : substeps) {
        Way way = own;
        way.substeps = t;
        way.water_order = way.sand_order = 1;
        list.push_back(way);
        if (has_water) way.water_order = 2, list.push_back(way);
        if (has_sand) way.sand_order = 2, list.push_back(way); // where there is water only together with its own
    }
    return list;
}

Way reference_way(const Level& level, bool has_sand, bool has_water) {
    Way way = level.own_way();
    way.water_order = has_water ? 2 : 1;
    way.sand_order = has_sand ? 2 : 1;
    if (has_sand) way.substeps = 3;
    return way;
}

std::vector<Settings> grids(const Level& level) {
    std::vector<Settings> list;
    for (double nx = FINEST * level.nx(); nx >= 1; nx /= GRID_RATIO) {
        const Settings grid = level.on_grid(nx, {});
        if (std::min(grid.nx, grid.ny) < std::min({LEAST_CELLS, level.nx(), level.ny()})) break;
        if (list.empty() || grid.nx != list.back().nx) list.push_back(grid);
    }
    std::reverse(list.begin(), list.end());
    return list;
}

std::vector<Candidate> candidates(const Level& level, const std::vector<WayModel>& models, int reference_cells_x, double frames,
                                  double scale) {
    std::vector<Candidate> list;
    for (const Settings& grid : grids(level)) {
        for (const WayModel& model : models) {
            Candidate c;
            c.settings = grid;
            c.settings.way = model.way;
            c.step_ms = 1e3 * scale * model.time.step(grid.cells());
            c.steps_per_frame = 1 / (frames * level.dt(grid));
            c.frame_ms = c.step_ms * c.steps_per_frame;
            const double h = static_cast<double>(reference_cells_x) / grid.nx;
            if (model.sand) c.errors.sand = model.sand->at(h);
            if (model.water) c.errors.water = model.water->at(h);
            list.push_back(c);
        }
    }
    return list;
}

std::vector<Candidate> frontier(std::vector<Candidate> all) {
    std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.frame_ms < b.frame_ms; });
    std::vector<Candidate> kept;
    for (const Candidate& c : all) {
        const bool told = c.errors.sand || c.errors.water;
        if (kept.empty() || (told ? c.sum() < WORTH * kept.back().sum() : c.settings.cells() > kept.back().settings.cells()))
            kept.push_back(c);
    }
    return kept;
}

std::optional<Candidate> best_within(const std::vector<Candidate>& frontier, double budget_ms) {
    std::optional<Candidate> best;
    for (const Candidate& c : frontier) {
        if (c.frame_ms <= budget_ms) best = c;
    }
    return best;
}

std::string describe(const Way& way) {
    std::string text = "order " + std::to_string(way.water_order);
    if (way.sand_order != 1) text += ", sand order " + std::to_string(way.sand_order);
    text += ", T " + std::to_string(way.substeps);
    if (way.active_tiles >= 0) text += ", active_tiles " + std::to_string(way.active_tiles);
    return text;
}

} // namespace tune
