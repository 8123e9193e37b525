#include "engine/level/draw_work.hpp"
#include "engine/level/read_level.hpp"
#include "engine/settings/rules/scripted_edits.hpp"
#include <algorithm>
#include <cmath>
#include <filesystem>

namespace wadi {
namespace {

// Bytes of the host's memory, at most; tests/faults/cost.cpp counts what loads take.
constexpr std::uint64_t PER_TEXT = 40; // of a level's text as JSON, per byte
constexpr std::uint64_t PER_SERIES =
    12; // of a series' file, per byte: lines of "9,1" are numbers of 16 bytes in a list that grows
constexpr std::uint64_t PER_VALUE =
    5; // of a map that is decoded: what comes out of its compression, twice where that has 16 bits
constexpr std::uint64_t PER_PIXEL = 8;      // its floats, and which are holes
constexpr std::uint64_t PER_SAMPLED = 8;    // of a map on the grid, per cell
constexpr std::uint64_t PER_CUT = 32;       // of a cell that an edge runs through
constexpr std::uint64_t PER_MADE = 24;      // per cell while the world is made: checks, advice
constexpr std::uint64_t PER_SAND = 80;      // more where sand is brought into balance
constexpr std::uint64_t ALWAYS = 48u << 20; // programs, threads, the library itself

std::uint64_t cells_of(const LevelGrid& grid) {
    return static_cast<std::uint64_t>(grid.nx) * static_cast<std::uint64_t>(grid.ny);
}

/// While it is decoded.
std::uint64_t bytes_of(const MapCost& map) {
    return map.file_bytes + PER_VALUE * static_cast<std::uint64_t>(map.asked.values) +
           PER_PIXEL * static_cast<std::uint64_t>(map.asked.nx) * static_cast<std::uint64_t>(map.asked.ny);
}

class Account {
  public:
    Account(LevelFiles& files, Cost& cost) : files_(files), cost_(cost) {}

    /// Errors: bad_file, also where the level's own budget of work ends.
    Status add_layers(const LayerLists& lists, const LevelGrid& grid) {
        const LayersWork work = layers_work(lists, grid, files_.work_most);
        if (Status status = files_.take_work(work.looks); !status) return status;
        cost_.work += static_cast<std::uint64_t>(work.looks);
        std::size_t maps = 0, fields = 0;
        for (const auto* list : {&lists.terrain, &lists.sand, &lists.water}) {
            fields += list->empty() ? 0 : 1;
            for (const Layer& layer : *list) {
                if (!layer.map) continue;
                ++maps;
                const bool of_lakes = list == &lists.water && layer.amount == Amount::height;
                if (Status status = add_map(*layer.map, layer.path, grid, of_lakes ? &lists : nullptr); !status) return status;
            }
        }
        has_sand_ = has_sand_ || !lists.sand.empty();
        fields_ += 4 * fields * cells_of(grid);
        at_work_ = std::max(at_work_, work.cut.cells.size() * (PER_CUT + 4 * maps));
        return ok_status();
    }

    Status add_velocities(const std::vector<VelocityLayer>& layers, const LevelGrid& grid) {
        bool any[2] = {};
        for (const VelocityLayer& layer : layers) {
            any[layer.of_sand ? 1 : 0] = true;
            cost_.work += cells_of(grid);
            if (Status status = files_.take_work(static_cast<std::int64_t>(cells_of(grid))); !status) return status;
            if (layer.map)
                if (Status status = add_map(*layer.map, layer.path, grid, nullptr); !status) return status;
        }
        for (const bool there : any) fields_ += there ? 8 * cells_of(grid) : 0;
        return ok_status();
    }

    /// Of the fields, and of what is there for a while beside them.
    std::uint64_t host_bytes(const LevelGrid& grid) const {
        return fields_ + std::max(largest_map_ + at_work_, (PER_MADE + (has_sand_ ? PER_SAND : 0)) * cells_of(grid));
    }

  private:
    Status add_map(const MapSource& map, const std::string& path, const LevelGrid& grid, const LayerLists* lakes_of) {
        const auto asked = cost_of_map(map.file, map.form, files_.read, files_.room.left());
        if (!asked)
            return error(asked.status().code == Code::bad_argument ? Code::bad_file : asked.status().code,
                         path + ".file: " + asked.status().message);
        if (Status status = take(asked->asked, path + ".file: " + map.file); !status) return status;
        cost_.file_bytes += asked->file_bytes;
        std::uint64_t bytes = bytes_of(*asked) + PER_SAMPLED * cells_of(grid);
        if (lakes_of != nullptr && (asked->asked.nx != grid.nx || asked->asked.ny != grid.ny)) {
            LevelGrid own = map_grid(grid, asked->asked.nx, asked->asked.ny);
            const auto layers = lakes_of->terrain.size() + lakes_of->sand.size();
            if (Status status = take({static_cast<std::int64_t>(cells_of(own) * layers)}, path + ".file: " + map.file); !status)
                return status;
            const std::uint64_t before = fields_;
            if (Status status = add_layers({lakes_of->terrain, lakes_of->sand, {}}, own); !status) return status;
            bytes += fields_ - before + PER_SAMPLED * cells_of(own); // for a while
            fields_ = before;
        }
        largest_map_ = std::max(largest_map_, bytes);
        return ok_status();
    }

    Status take(const FileRoom::Asked& asked, const std::string& name) {
        cost_.map_values += static_cast<std::uint64_t>(asked.values);
        return files_.room.take(asked, name);
    }

    LevelFiles& files_;
    Cost& cost_;
    std::uint64_t fields_ = 0, largest_map_ = 0, at_work_ = 0;
    bool has_sand_ = false;
};

Result<LevelCost> account(const std::string& text, const FileReader& reader, const LevelOverrides& overrides) {
    LevelCost result;
    Cost& cost = result.cost;
    cost.file_bytes = text.size();
    std::uint64_t series = 0;
    const FileReader counted = [&](const std::string& name, std::uint64_t limit) {
        auto bytes = reader(name, limit);
        if (bytes) series += bytes->size();
        return bytes;
    };
    LevelFiles files{within(counted, overrides.files)};
    auto read = read_level(text, files, overrides);
    if (!read) return read.status();
    const std::uint64_t of_series = series; // maps are read by the same reader, from here on
    cost.file_bytes += of_series;
    cost.map_values = of_series;
    const LevelLayers& layers = read->layers;
    const LevelGrid& grid = read->grid;
    Account sums(files, cost);
    if (Status status = sums.add_layers(layers, grid); !status) return status;
    if (Status status = sums.add_velocities(layers.velocities, grid); !status) return status;
    for (const std::vector<Layer>* drawn_alike : {&layers.roughness, &layers.rain}) {
        LayerLists lists;
        lists.terrain = *drawn_alike;
        if (Status status = sums.add_layers(lists, grid); !status) return status;
    }
    const Settings& settings = read->level.settings;
    cost.cells = cells_of(grid);
    cost.host_bytes = ALWAYS + PER_TEXT * text.size() + PER_SERIES * of_series + sums.host_bytes(grid);
    cost.steps = static_cast<std::uint64_t>(std::ceil(read->level.duration / settings.dt));
    cost.edits_per_step = most_edits_per_step(settings);
    result.settings = settings;
    result.sand = !layers.sand.empty();
    result.water = !layers.water.empty();
    return result;
}

Status out_of_memory() { return error(Code::out_of_memory, "the level does not fit into memory"); }

} // namespace

std::uint64_t load_bytes(const MapCost& map, std::uint64_t cells) {
    return ALWAYS + bytes_of(map) + (PER_SAMPLED + PER_MADE) * cells;
}

Result<LevelCost> cost_of_level(const std::string& text, const FileReader& files, const LevelOverrides& overrides) {
    try {
        return account(text, files, overrides);
    } catch (const std::bad_alloc&) {
        return out_of_memory();
    }
}

Result<LevelCost> cost_of_level(const std::string& path, const LevelOverrides& overrides) {
    auto bytes = read_file_bytes(path, LEVEL_BYTES_MOST);
    if (!bytes) return bytes.status();
    const std::string text(bytes->begin(), bytes->end());
    return cost_of_level(text, files_in(std::filesystem::path(path).parent_path().string(), overrides.files), overrides);
}

} // namespace wadi
