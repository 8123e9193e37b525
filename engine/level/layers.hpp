// The layers of a level's terrain, sand, water and roughness: maps and shapes combined in order into fields.
#pragma once
#include "engine/compute/status.hpp"
#include "engine/image/map.hpp"
#include "engine/level/ground_mask.hpp"
#include "engine/level/json_reader.hpp"
#include "engine/level/level_files.hpp"
#include "engine/level/shapes.hpp"
#include "engine/settings/data/settings.hpp"
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wadi {

inline constexpr std::size_t LAYERS_MOST = 256; // per field
inline constexpr double HEIGHT_MOST = 1e6;      // [m]
inline constexpr double POSITION_MOST = 1e9;    // [m]

/// The grid that fields are drawn on. A point of the grid at y is the level's own point at y / stretch_y.
struct LevelGrid {
    int nx = 0;
    int ny = 0;
    double dx = 0; // [m]
    double stretch_y = 1;
    double quantum = 0; // fields are rounded to multiples of it, so that lakes are flat to the bit; 0 = not rounded [m]
};

inline std::size_t cell_count(const LevelGrid& grid) {
    return static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny);
}

enum class LayerTarget { terrain, sand, water, roughness, rain };
enum class Combine { add, set, max, min, subtract };
enum class Amount {
    height,  // depth, or elevation of terrain [m]; of roughness its value [s/m^(1/3)], of rain how many times it
    surface, // absolute elevation: filled up from the ground below [m]
    wet,     // water as a share of the sand's depth
};

/// What the values of a map are, as messages name them, and their range in the unit of the field.
struct MapMeaning {
    const char* name = "height";
    double least = -HEIGHT_MOST;
    double most = HEIGHT_MOST;
};

struct MapSource {
    std::string file;
    MapMeaning meaning;
    MapForm form;
    Holes holes = Holes::filled;
    std::optional<bool> corners; // where samples lie; guessed when absent
    bool grey_range = false;     // grey 0 ... 1 becomes min ... max; otherwise value * scale + offset
    double min = 0;
    double max = 1;
    bool scale_given = false;
    double scale = 1;
    double offset = 0;
};

struct Layer {
    std::string path;             // as messages name it: sand[2]
    std::optional<MapSource> map; // otherwise the shape counts
    Shape shape;
    Amount amount = Amount::height;
    double top = 0;           // height, surface or wet
    bool inside_sand = false; // water up to a surface: in the pores of sand that stands above it, too
    Combine combine = Combine::add;
    bool only_present = false;      // only cells where the field is above zero
    std::optional<GroundMask> mask; // of sand: by the terrain; of water: by terrain and sand
};

/// The grid of a map's own samples over the same ground.
LevelGrid map_grid(const LevelGrid& grid, int nx, int ny);

/// Where water or sand starts with a velocity: a shape has both components, a map one.
struct VelocityLayer {
    std::string path; // velocities[2]
    bool of_sand = false;
    std::optional<MapSource> map; // otherwise the shape counts
    bool map_along_y = false;
    Shape shape;
    Point velocity = {0, 0}; // of a shape [m/s]
};

std::vector<Layer> read_layers(const Json& value, const std::string& path, LayerTarget target, Status& status);
std::vector<VelocityLayer> read_velocities(const Json& value, const std::string& path, Status& status);

/// The layers of a level by what they make.
struct LayerLists {
    std::vector<Layer> terrain;
    std::vector<Layer> sand;
    std::vector<Layer> water;
    bool of_heights = true; // terrain's are; else what is drawn as they are
};

/// Draws terrain, sand and water into `fields`; a field without layers is empty. Maps come from `files`. Terrain is what its
/// layers say at the middle of a cell, sand and water the mean over the cell where an edge runs through it. A layer that changes
/// no cell is worth a warning.
Status draw_layers(const LayerLists& lists, const LevelGrid& grid, LevelFiles& files, InitialFields& fields,
                   std::vector<std::string>& warnings);

/// Draws what layers of roughness or rain say at the middles of cells; empty without layers.
Status draw_numbers(std::vector<Layer> layers, const LevelGrid& grid, LevelFiles& files, std::vector<float>& numbers,
                    std::vector<std::string>& warnings);

/// Draws the velocities of water or of sand at the middles of cells into x and y; both stay empty when no layer sets any. A
/// layer that changes no cell is worth a warning.
Status draw_velocities(const std::vector<VelocityLayer>& layers, bool of_sand, const LevelGrid& grid, LevelFiles& files,
                       std::vector<float>& x, std::vector<float>& y, std::vector<std::string>& warnings);

} // namespace wadi
