#include "engine/level/coverage.hpp"
#include "engine/level/layer_map.hpp"
#include "engine/threads/bands.hpp"
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace wadi {

Status draw_velocities(const std::vector<VelocityLayer>& layers, bool of_sand, const LevelGrid& grid, LevelFiles& files,
                       std::vector<float>& x, std::vector<float>& y, std::vector<std::string>& warnings) {
    for (const VelocityLayer& layer : layers) {
        if (layer.of_sand != of_sand) continue;
        if (Status status = files.take_work(static_cast<std::int64_t>(cell_count(grid))); !status) return status;
        x.resize(cell_count(grid), 0.0f);
        y.resize(cell_count(grid), 0.0f);
        std::atomic<bool> changed = false;
        const auto set = [&changed](float& velocity, float to) {
            if (velocity != to) changed = true;
            velocity = to;
        };
        if (layer.map) {
            const auto map = open_map(*layer.map, layer.path, files, grid.nx * grid.dx, warnings);
            if (!map) return map.status();
            const auto values = values_of(*map, *layer.map, layer.path, grid.nx, grid.ny);
            if (!values) return values.status();
            std::vector<float>& along = layer.map_along_y ? y : x;
            for (std::size_t cell = 0; cell < along.size(); ++cell) set(along[cell], (*values)[cell]);
        } else {
            const auto width = static_cast<std::size_t>(grid.nx);
            std::vector<double> columns(width);
            for (std::size_t i = 0; i < width; ++i) columns[i] = column_center(grid, static_cast<int>(i));
            in_bands(static_cast<std::size_t>(grid.ny), row_band(width), [&](std::size_t, std::size_t begin, std::size_t end) {
                files.did(static_cast<std::int64_t>((end - begin) * width));
                std::vector<double> relative(width);
                for (std::size_t j = begin; j < end; ++j) {
                    relative_heights(layer.shape, columns, cell_center(grid, 0, static_cast<int>(j))[1], relative);
                    for (std::size_t i = 0; i < width; ++i) {
                        if (std::isinf(relative[i])) continue;
                        set(x[j * width + i], static_cast<float>(layer.velocity[0]));
                        set(y[j * width + i], static_cast<float>(layer.velocity[1]));
                    }
                }
            });
        }
        const bool meant_as_nothing = !layer.map && layer.velocity == Point{0, 0};
        if (!changed && !meant_as_nothing)
            warnings.push_back(layer.path +
                               ": changes no cell; it lies outside the grid or between cell centres, or says what is "
                               "there already");
    }
    return ok_status();
}

} // namespace wadi
