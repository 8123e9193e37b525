#include "engine/image/map.hpp"
#include "engine/level/layers.hpp"
#include "engine/settings/messages.hpp"
#include "engine/settings/quanta.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace wadi {
namespace {

std::size_t cell_count(const LevelGrid& grid) { return static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny); }

double value_at(const std::vector<float>& field, std::size_t cell) {
    return field.empty() ? 0 : static_cast<double>(field[cell]);
}

double combined(double current, double value, Combine combine) {
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

Result<std::vector<float>> load_heights(const Layer& layer, const LevelGrid& grid, const FileReader& files,
                                        std::vector<std::string>& warnings) {
    const MapSource& source = *layer.map;
    auto map = read_map(source.file, source.size, files);
    if (!map) // a bad argument of ours is a bad field of the level's author
        return error(map.status().code == Code::bad_argument ? Code::bad_file : map.status().code,
                     layer.path + ".file: " + map.status().message);
    if (source.grey_range && !map->integer)
        return error(Code::bad_file, layer.path + ": min and max are for integer maps (PNG, r16); " + source.file +
                                         " holds heights, use scale and offset");
    if (map->integer && !source.grey_range && !source.scale_given)
        return error(Code::bad_file, layer.path + ": " + source.file + " holds grey values; give min and max, the heights of " +
                                         "black and white in metres");
    if (map->filled > 0) warnings.push_back(filled_warning(*map, layer.path + ".file: " + source.file));
    std::vector<float> values = resample(*map, grid.nx, grid.ny);
    const double scale = source.grey_range ? source.max - source.min : source.scale;
    const double offset = source.grey_range ? source.min : source.offset;
    for (std::size_t cell = 0; cell < values.size(); ++cell) {
        const double height = static_cast<double>(values[cell]) * scale + offset;
        if (!(std::fabs(height) <= HEIGHT_MOST))
            return error(Code::bad_file, outside_text(layer.path + ": height", height, -HEIGHT_MOST, HEIGHT_MOST) + " in cell (" +
                                             std::to_string(cell % static_cast<std::size_t>(grid.nx)) + ", " +
                                             std::to_string(cell / static_cast<std::size_t>(grid.nx)) + ")");
        values[cell] = static_cast<float>(height);
    }
    return values;
}

/// What a layer says about one cell: nothing outside its shape.
struct Sample {
    bool inside = false;
    double value = 0;
};

Sample sample_layer(const Layer& layer, double relative, double ground, double sand) {
    if (std::isinf(relative)) return {};
    if (layer.amount == Amount::wet) return {true, layer.top * sand};
    double value = layer.top + relative;
    // Water counts from the terrain, inside the sand too; sand that stands above the surface stays as it is.
    if (layer.amount == Amount::surface) value = value > ground ? value - ground + sand : 0.0;
    // Beyond the line where a sloping side meets the ground, the shape is over.
    if (has_sloping_sides(layer.shape) && relative < 0 && value <= 0) return {};
    return {true, value};
}

} // namespace

std::string filled_warning(const Map& map, const std::string& path) {
    return path + ": " + std::to_string(map.filled) + " of " + std::to_string(std::int64_t{map.nx} * map.ny) +
           " cells hold NODATA_value; they take the height of the nearest cell that has one";
}

Result<std::vector<float>> draw_layers(const std::vector<Layer>& layers, LayerTarget target, const LevelGrid& grid,
                                       const FileReader& files, const std::vector<float>& terrain, const std::vector<float>& sand,
                                       std::vector<std::string>& warnings) {
    std::vector<float> field(layers.empty() ? 0 : cell_count(grid), 0.0f);
    for (const Layer& layer : layers) {
        std::vector<float> heights;
        if (layer.map) {
            auto loaded = load_heights(layer, grid, files, warnings);
            if (!loaded) return loaded.status();
            heights = std::move(*loaded);
        }
        bool changed = false;
        std::size_t cell = 0;
        for (int j = 0; j < grid.ny; ++j) {
            const double y = (j + 0.5) * grid.dx / grid.stretch_y;
            for (int i = 0; i < grid.nx; ++i, ++cell) {
                const double current = static_cast<double>(field[cell]);
                if (layer.only_present && !(current > 0)) continue;
                const double sand_here = value_at(sand, cell);
                const double ground = value_at(terrain, cell) + sand_here;
                const double relative =
                    layer.map ? static_cast<double>(heights[cell]) : relative_height(layer.shape, (i + 0.5) * grid.dx, y);
                const Sample sample = sample_layer(layer, relative, ground, sand_here);
                if (!sample.inside) continue;
                double next = combined(current, sample.value, layer.combine);
                if (target != LayerTarget::terrain) next = std::max(next, 0.0);
                field[cell] = static_cast<float>(nearest_quantum(next, grid.quantum, Halves::away));
                changed = changed || field[cell] != static_cast<float>(current);
            }
        }
        const bool meant_as_nothing = !layer.map && layer.top == 0 && layer.amount != Amount::surface;
        if (!changed && !meant_as_nothing)
            warnings.push_back(layer.path +
                               ": changes no cell; it lies outside the grid, between cell centres, below the ground or under "
                               "what is already there");
    }
    return field;
}

void draw_velocities(const std::vector<VelocityRegion>& regions, bool of_sand, const LevelGrid& grid, std::vector<float>& x,
                     std::vector<float>& y) {
    for (const VelocityRegion& region : regions) {
        if (region.of_sand != of_sand) continue;
        x.resize(cell_count(grid), 0.0f);
        y.resize(cell_count(grid), 0.0f);
        std::size_t cell = 0;
        for (int j = 0; j < grid.ny; ++j)
            for (int i = 0; i < grid.nx; ++i, ++cell) {
                const double relative = relative_height(region.shape, (i + 0.5) * grid.dx, (j + 0.5) * grid.dx / grid.stretch_y);
                if (std::isinf(relative)) continue;
                x[cell] = static_cast<float>(region.velocity[0]);
                y[cell] = static_cast<float>(region.velocity[1]);
            }
    }
}

} // namespace wadi
