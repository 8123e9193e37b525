#include "engine/level/coverage.hpp"
#include "engine/level/crests.hpp"
#include "engine/level/draw_work.hpp"
#include "engine/level/lakes.hpp"
#include "engine/level/layer_map.hpp"
#include "engine/level/layers.hpp"
#include "engine/level/thin_lines.hpp"
#include "engine/settings/data/quanta.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/messages.hpp"
#include "engine/threads/bands.hpp"
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <mutex>
#include <span>
#include <utility>

namespace wadi {
namespace {

double value_at(const std::vector<float>& field, std::size_t cell) {
    return field.empty() ? 0 : static_cast<double>(field[cell]);
}

inline double combined(double current, double value, Combine combine) {
    switch (combine) {
    case Combine::add:
        return current + value;
    case Combine::set:
        return value;
    case Combine::max:
        return std::max(current, value);
    case Combine::min:
        return std::min(current, value);
    case Combine::subtract:
        return current - value;
    }
    return current;
}

/// What lies below a layer [m]. Surfaces count from the cell's means, so that they are flat whatever its parts hold.
struct Below {
    double terrain = 0;
    double sand = 0;
    double sand_here = 0; // in a part of the cell: what a share of the sand's depth counts from
};

inline double layer_height(const Layer& layer, double relative, const Below& below) {
    if (layer.amount == Amount::wet) return layer.top * below.sand_here;
    const double value = layer.top + relative;
    const double ground = below.terrain + below.sand;
    // Water counts from the terrain, inside the sand too; sand that stands above the surface stays as it is unless inside_sand.
    if (layer.amount == Amount::surface)
        return value > (layer.inside_sand ? below.terrain : ground) ? value - ground + below.sand : 0.0;
    return value;
}

/// The field at a place, whose height relative to the layer's top is given, after the layer. `taken`: the share of the cell that
/// the layer's mask takes; what fills up to a surface takes a cell or leaves it, so that it stays level.
inline double after_layer(const Layer& layer, LayerTarget target, const LevelGrid& grid, double current, double relative,
                          const Below& below, double taken) {
    if (layer.amount == Amount::surface) taken = taken < 0.5 ? 0 : 1;
    if (std::isinf(relative) || taken == 0 || (layer.only_present && !(current > 0))) return current;
    const double height = layer_height(layer, relative, below);
    // Beyond the line where a sloping side meets the ground, the shape is over.
    if (has_sloping_sides(layer.shape) && relative < 0 && height <= 0) return current;
    double next = combined(current, height, layer.combine);
    if (target != LayerTarget::terrain) next = std::max(next, 0.0);
    if (taken < 1) next = current + taken * (next - current);
    return nearest_quantum(next, grid.quantum, Halves::away);
}

class Drawing {
  public:
    Drawing(const LayerLists& lists, const LevelGrid& grid, LevelFiles& files, LayersWork work, InitialFields& fields,
            std::vector<std::string>& warnings)
        : lists_(lists), grid_(grid), files_(files), fields_(fields), warnings_(warnings), cut_(std::move(work.cut)),
          map_heights_(lists.sand.size() + lists.water.size()) {
        // Those of sand alone, and of both where there is water.
        const std::size_t samplings = cut_.cells.size() * (lists.sand.empty() || lists.water.empty() ? 1 : 2);
        if (samplings > 0) cell_work_ = work.sampling / static_cast<std::int64_t>(samplings);
    }

    Status draw() {
        if (Status status = draw_terrain(); !status) return status;
        if (Status status = draw_sand(); !status) return status;
        return draw_water();
    }

  private:
    Status draw_terrain() {
        fields_.terrain.resize(lists_.terrain.empty() ? 0 : cell_count(grid_));
        for (const Layer& layer : lists_.terrain) {
            auto changed = draw_centers(layer, LayerTarget::terrain, fields_.terrain, nullptr);
            if (!changed) return changed.status();
            warn_unchanged(layer, *changed);
            if (*changed) warn(warning_of_thin_terrain(layer, grid_));
        }
        lowest_ = lowest_terrain();
        return ok_status();
    }

    /// [m]
    double lowest_terrain() const {
        const std::vector<float>& terrain = fields_.terrain;
        if (terrain.empty()) return 0;
        std::vector<float> parts(bands_of(terrain.size(), CELL_BAND));
        in_bands(terrain.size(), CELL_BAND, [&](std::size_t n, std::size_t begin, std::size_t end) {
            parts[n] = *std::min_element(&terrain[begin], &terrain[begin] + (end - begin));
        });
        return static_cast<double>(*std::min_element(parts.begin(), parts.end()));
    }

    Status draw_sand() {
        std::vector<char> changed;
        if (Status status = draw_list(lists_.sand, LayerTarget::sand, fields_.sand, 0, changed); !status) return status;
        const auto cells = cut_cells(pointers(lists_.sand), grid_).cells;
        in_cut_cells(cells, pointers(lists_.sand), changed, [&](CutCell& at) {
            const Below below = below_of(at.cell, false);
            for (std::size_t n = 0; n < at.values.size(); ++n)
                at.values[n] = stack(lists_.sand, LayerTarget::sand, at, n, 0, below, at.changed);
            store(fields_.sand, at.cell, mean_of(at.values, at.samples, at.terms));
        });
        warn_unchanged(lists_.sand, changed);
        for (std::size_t n = 0; n < changed.size(); ++n)
            if (changed[n] != 0) warn(warning_of_thin_sand(lists_.sand[n], grid_));
        return ok_status();
    }

    Status draw_water() {
        std::vector<char> changed;
        if (Status status = draw_list(lists_.water, LayerTarget::water, fields_.water, lists_.sand.size(), changed); !status)
            return status;
        if (lists_.water.empty()) return ok_status();
        in_cut_cells(cut_.cells, pointers(lists_.sand, lists_.water), changed, [&](CutCell& at) {
            at.sand_changed.resize(lists_.sand.size());
            at.sand.assign(at.samples.count(), 0.0);
            for (std::size_t n = 0; n < at.sand.size(); ++n)
                at.sand[n] = stack(lists_.sand, LayerTarget::sand, at, n, 0, below_of(at.cell, false), at.sand_changed);
            // The sides of water's boxes part the cell further: in the mean its sand stays what was drawn.
            const double mean = mean_of(at.sand, at.samples, at.terms);
            Below below = below_of(at.cell, true);
            const double scale = mean > 0 ? below.sand / mean : 0;
            for (std::size_t n = 0; n < at.values.size(); ++n) {
                below.sand_here = mean == at.sand[n] ? below.sand : at.sand[n] * scale;
                at.values[n] = stack(lists_.water, LayerTarget::water, at, n, lists_.sand.size(), below, at.changed);
            }
            store(fields_.water, at.cell, mean_of(at.values, at.samples, at.terms));
        });
        warn_unchanged(lists_.water, changed);
        return ok_status();
    }

    /// A cut cell and its samples, with room for what is computed of them; a band of cells uses it again and again.
    struct CutCell {
        CellSamples samples;
        std::size_t cell = 0;
        std::vector<char> changed, sand_changed; // by each layer
        std::vector<double> values, sand, terms; // values: 0 for each sample
    };

    /// Calls draw() for each of `cells`, some of cut_ in their order, sampled for `layers`; `changed` collects what draw() says.
    template <class Draw>
    void in_cut_cells(const std::vector<std::size_t>& cells, const std::vector<const Layer*>& layers, std::vector<char>& changed,
                      const Draw& draw) {
        constexpr std::size_t band = 256;
        std::mutex collecting;
        in_bands(cells.size(), band, [&](std::size_t, std::size_t begin, std::size_t end) {
            CutCell at{CellSamples(layers, grid_), 0, std::vector<char>(changed.size()), {}, {}, {}, {}};
            auto place = std::lower_bound(cut_.cells.begin(), cut_.cells.end(), cells[begin]);
            for (std::size_t n = begin; n < end; ++n) {
                place = std::find(place, cut_.cells.end(), cells[n]);
                at.cell = cells[n];
                sample_cell(at.samples, static_cast<std::size_t>(place - cut_.cells.begin()));
                at.values.assign(at.samples.count(), 0.0);
                draw(at);
            }
            files_.did(static_cast<std::int64_t>(end - begin) * cell_work_);
            const std::lock_guard lock(collecting);
            for (std::size_t n = 0; n < changed.size(); ++n) changed[n] = changed[n] != 0 || at.changed[n] != 0;
        });
    }

    Below below_of(std::size_t cell, bool with_sand) const {
        const double sand = with_sand ? value_at(fields_.sand, cell) : 0;
        return {value_at(fields_.terrain, cell), sand, sand};
    }

    /// How much of a cell a layer's mask takes: by the terrain under sand, by terrain and sand under water.
    double taken_of(const Layer& layer, LayerTarget target, std::size_t cell) const {
        if (!layer.mask) return 1;
        const bool sand = target == LayerTarget::water;
        const auto width = static_cast<std::size_t>(grid_.nx);
        const auto ground = [&](std::size_t at) {
            return value_at(fields_.terrain, at) + (sand ? value_at(fields_.sand, at) : 0);
        };
        // Between the neighbours of both sides; at the rim to the one that is there.
        const auto rise = [&](std::size_t place, std::size_t last, std::size_t step) {
            const std::size_t low = cell - (place > 0 ? step : 0), high = cell + (place < last ? step : 0);
            return low == high ? 0 : (ground(high) - ground(low)) / (static_cast<double>((high - low) / step) * grid_.dx);
        };
        return taken_share(
            *layer.mask,
            {ground(cell), {rise(cell % width, width - 1, 1), rise(cell / width, static_cast<std::size_t>(grid_.ny) - 1, width)}},
            grid_.dx);
    }

    /// Draws every layer at the middles of cells; keeps the heights of maps in cut cells. `first`: number of the first layer
    /// there.
    Status draw_list(const std::vector<Layer>& layers, LayerTarget target, std::vector<float>& field, std::size_t first,
                     std::vector<char>& changed) {
        field.resize(layers.empty() ? 0 : cell_count(grid_));
        for (std::size_t n = 0; n < layers.size(); ++n) {
            auto result = draw_centers(layers[n], target, field, &map_heights_[first + n]);
            if (!result) return result.status();
            changed.push_back(*result);
        }
        return ok_status();
    }

    /// Whether it changed anything.
    Result<bool> draw_centers(const Layer& layer, LayerTarget target, std::vector<float>& field, std::vector<float>* at_cut) {
        std::vector<float> heights;
        files_.did(0); // ahead of a file that takes long
        if (layer.map) {
            const bool ground = target == LayerTarget::terrain && lists_.of_heights;
            const auto map = open_map(*layer.map, layer.path, files_, grid_.nx * grid_.dx, warnings_, ground);
            if (!map) return map.status();
            auto values = values_of(*map, *layer.map, layer.path, grid_.nx, grid_.ny);
            if (!values) return values.status();
            heights = std::move(*values);
            const bool raises = layer.combine != Combine::subtract && layer.combine != Combine::min;
            const bool sand = target == LayerTarget::sand && layer.amount == Amount::height;
            if ((ground || sand) && raises) keep_crests_of(layer, sand, *map, heights);
            const bool other_size = map->nx != grid_.nx || map->ny != grid_.ny;
            if (other_size && target == LayerTarget::water && layer.amount == Amount::height)
                if (Status status = level_lakes_of(layer, *map, heights); !status) return status;
            if (at_cut != nullptr)
                for (const std::size_t cell : cut_.cells) at_cut->push_back(heights[cell]);
        }
        CellRange range = reach_of(layer, grid_, lowest_);
        const std::vector<std::size_t> line =
            target == LayerTarget::terrain ? thin_line(layer, grid_) : std::vector<std::size_t>();
        if (!line.empty()) range = {0, grid_.nx, 0, grid_.ny};
        const auto rows = static_cast<std::size_t>(std::max(range.end_y - range.begin_y, 0));
        const std::int64_t row_work = files_.progress == nullptr || rows == 0
                                          ? 0
                                          : drawing_work({&layer}, grid_, files_.work_most) / static_cast<std::int64_t>(rows);
        std::atomic<bool> changed = false;
        in_bands(rows, row_band(static_cast<std::size_t>(std::max(range.end_x - range.begin_x, 0))),
                 [&](std::size_t, std::size_t begin, std::size_t end) {
                     for (std::size_t row = begin; row < end; ++row)
                         if (draw_row(layer, target, field, heights, line, range, range.begin_y + static_cast<int>(row)))
                             changed = true;
                     files_.did(static_cast<std::int64_t>(end - begin) * row_work);
                 });
        return changed.load();
    }

    /// Draws a layer at the middles of a row of its range; `heights`: its map; `line`: its thin_line(). Whether it changed
    /// anything.
    bool draw_row(const Layer& layer, LayerTarget target, std::vector<float>& field, const std::vector<float>& heights,
                  const std::vector<std::size_t>& line, const CellRange& range, int j) const {
        constexpr int piece = 64;
        std::array<double, piece> x, relative;
        const double y = cell_center(grid_, 0, j)[1];
        bool changed = false;
        for (int first = range.begin_x; first < range.end_x; first += piece) {
            const auto count = static_cast<std::size_t>(std::min(piece, range.end_x - first));
            const std::size_t start =
                static_cast<std::size_t>(j) * static_cast<std::size_t>(grid_.nx) + static_cast<std::size_t>(first);
            const std::span<float> cells(&field[start], count);
            const auto empty = [](float current) { return !(current > 0); };
            if (layer.only_present && std::all_of(cells.begin(), cells.end(), empty)) continue;
            if (layer.map) {
                std::copy_n(&heights[start], count, relative.begin());
            } else {
                for (std::size_t k = 0; k < count; ++k) x[k] = column_center(grid_, first + static_cast<int>(k));
                relative_heights(layer.shape, {x.data(), count}, y, {relative.data(), count});
                for (auto cell = std::lower_bound(line.begin(), line.end(), start); cell != line.end() && *cell < start + count;
                     ++cell)
                    relative[*cell - start] = 0;
            }
            for (std::size_t k = 0; k < count; ++k) {
                const float current = cells[k];
                cells[k] = static_cast<float>(after_layer(layer, target, grid_, static_cast<double>(current), relative[k],
                                                          below_of(start + k, target == LayerTarget::water),
                                                          taken_of(layer, target, start + k)));
                changed = changed || cells[k] != current;
            }
        }
        return changed;
    }

    /// Sand keeps its volume and is named alone.
    void keep_crests_of(const Layer& layer, bool sand, const Map& map, std::vector<float>& heights) {
        const auto [scale, offset] = scale_and_offset(*layer.map);
        std::vector<float> raised;
        if (sand) raised = heights;
        const KeptCrests kept = keep_crests(map, scale, offset, grid_, sand ? raised : heights);
        if (kept.cells == 0) return;
        const auto width = static_cast<std::size_t>(grid_.nx);
        const std::string lower = number_text(std::round(1000 * kept.most) / 1000);
        warnings_.push_back(
            layer.path + ".file: " + layer.map->file + ": " + std::to_string(kept.cells) + " cells of " + number_text(grid_.dx) +
            " m hold crests that are narrower, such as walls and dikes; " +
            (sand ? "its sand stands as wide as its cells there, up to " + lower + " m lower, and holds back less"
                  : "they are kept closed, as high as the crest where their mean is up to " + lower + " m lower") +
            ", most in cell (" + std::to_string(kept.where % width) + ", " + std::to_string(kept.where / width) + ")");
    }

    /// Levels the lakes of a map of depths on this grid, by the ground that the level has on the map's own.
    Status level_lakes_of(const Layer& layer, const Map& map, std::vector<float>& depths) {
        const LevelGrid own = map_grid(grid_, map.nx, map.ny);
        // The map chooses these cells, not the level's grid.
        const auto layers = static_cast<std::int64_t>(lists_.terrain.size() + lists_.sand.size());
        if (Status status = files_.room.take({std::int64_t{own.nx} * own.ny * layers}, layer.path + ".file: " + layer.map->file);
            !status)
            return status;
        InitialFields ground;
        std::vector<std::string> said_already;
        if (Status status = draw_layers({lists_.terrain, lists_.sand, {}}, own, files_, ground, said_already); !status)
            return status;
        auto water = values_of(map, *layer.map, layer.path, map.nx, map.ny);
        if (!water) return water.status();
        for (float& depth : *water) depth = std::max(depth, 0.0f);
        level_lakes({ground.terrain, ground.sand, *water}, own.nx, own.ny, {fields_.terrain, fields_.sand, depths}, grid_.nx,
                    grid_.ny);
        return ok_status();
    }

    void sample_cell(CellSamples& samples, std::size_t at) const {
        for (std::size_t n = 0; n < samples.map_heights().size(); ++n)
            if (!map_heights_[n].empty()) samples.map_heights()[n] = static_cast<double>(map_heights_[n][at]);
        const auto width = static_cast<std::size_t>(grid_.nx);
        samples.sample(static_cast<int>(cut_.cells[at] % width), static_cast<int>(cut_.cells[at] / width));
    }

    /// The layers' result in a sample of a cell. `first`: number of the first layer in the samples.
    double stack(const std::vector<Layer>& layers, LayerTarget target, const CutCell& at, std::size_t sample, std::size_t first,
                 const Below& below, std::vector<char>& changed) const {
        double value = 0;
        for (std::size_t place = 0; place < at.samples.near().size(); ++place) {
            const std::size_t n = at.samples.near()[place] - first;
            if (n >= layers.size()) continue; // also those before the first: n has wrapped
            const double next = after_layer(layers[n], target, grid_, value, at.samples.relative(sample, place), below,
                                            taken_of(layers[n], target, at.cell));
            if (next != value) changed[n] = 1;
            value = next;
        }
        return value;
    }

    void store(std::vector<float>& field, std::size_t cell, double height) const {
        field[cell] = static_cast<float>(nearest_quantum(height, grid_.quantum, Halves::away));
    }

    void warn(std::optional<std::string> text) {
        if (text) warnings_.push_back(std::move(*text));
    }

    void warn_unchanged(const std::vector<Layer>& layers, const std::vector<char>& changed) {
        for (std::size_t n = 0; n < layers.size(); ++n) warn_unchanged(layers[n], changed[n] != 0);
    }

    void warn_unchanged(const Layer& layer, bool changed) {
        const bool meant_as_nothing = !layer.map && layer.top == 0 && layer.amount != Amount::surface;
        if (!changed && !meant_as_nothing)
            warnings_.push_back(layer.path +
                                ": changes no cell; it lies outside the grid, between cell centres, below the ground "
                                "or under what is already there");
    }

    const LayerLists& lists_;
    const LevelGrid& grid_;
    LevelFiles& files_;
    InitialFields& fields_;
    std::vector<std::string>& warnings_;
    const CutCells cut_;                                       // by the edges of sand and water
    double lowest_ = -std::numeric_limits<double>::infinity(); // terrain, once it is drawn [m]
    std::vector<std::vector<float>> map_heights_;              // of the maps among sand's layers, then water's, in cut_
    std::int64_t cell_work_ = 0;                               // of a cut cell, in the mean
};

} // namespace

LevelGrid map_grid(const LevelGrid& grid, int nx, int ny) {
    LevelGrid own = grid;
    own.nx = nx;
    own.ny = ny;
    own.dx = grid.nx * grid.dx / nx;
    own.stretch_y = grid.stretch_y * (own.ny * own.dx) / (grid.ny * grid.dx);
    return own;
}

Status draw_layers(const LayerLists& lists, const LevelGrid& grid, LevelFiles& files, InitialFields& fields,
                   std::vector<std::string>& warnings) {
    LayersWork work = layers_work(lists, grid, files.work_most);
    if (Status status = files.take_work(work.looks); !status) return status;
    return Drawing(lists, grid, files, std::move(work), fields, warnings).draw();
}

Status LevelFiles::take_work(std::int64_t more) {
    work += more;
    if (work <= work_most) return ok_status();
    return error(Code::bad_file, "the level's layers ask for " + number_text(static_cast<double>(work)) +
                                     " looks at shapes, or more (cells by octaves of noise or segments of ridges); allowed are " +
                                     number_text(static_cast<double>(work_most)));
}

Status draw_numbers(std::vector<Layer> layers, const LevelGrid& grid, LevelFiles& files, std::vector<float>& numbers,
                    std::vector<std::string>& warnings) {
    LevelGrid unrounded = grid;
    unrounded.quantum = 0;
    LayerLists lists;
    lists.terrain = std::move(layers); // drawn alike
    lists.of_heights = false;
    InitialFields drawn;
    Status status = draw_layers(lists, unrounded, files, drawn, warnings);
    numbers = std::move(drawn.terrain);
    return status;
}

} // namespace wadi
