#include "engine/level/layer_map.hpp"
#include "engine/image/plausible.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/messages.hpp"
#include "engine/threads/bands.hpp"
#include <cstddef>
#include <cstdint>

namespace wadi {

Result<Map> open_map(const MapSource& source, const std::string& path, LevelFiles& files, double length,
                     std::vector<std::string>& warnings, bool ground) {
    auto map = read_map(source.file, source.form, files.read, files.room);
    if (!map) // a bad argument of ours is a bad field of the level's author
        return error(map.status().code == Code::bad_argument ? Code::bad_file : map.status().code,
                     path + ".file: " + map.status().message);
    if (source.grey_range && !map->integer)
        return error(Code::bad_file, path + ": min and max are for integer maps (PNG, r16); " + source.file +
                                         " holds numbers as they are, use scale and offset");
    if (map->integer && !source.grey_range && !source.scale_given)
        return error(Code::bad_file,
                     path + ": " + source.file + " holds grey values; give min and max, what black and white stand for");
    const bool own_size = map->nx == files.own_nx && map->ny == files.own_ny;
    map->corners = source.corners.value_or(!own_size && looks_like_corners(map->nx, map->ny));
    if (map->corners && !source.corners)
        map->notes.push_back(std::to_string(map->nx) + " x " + std::to_string(map->ny) +
                             " samples are taken for the corners of cells, as engines have them; \"samples\": \"cells\" or "
                             "\"corners\" says which they are");
    if (ground) note_odd_ground(*map);
    raise_holes(*map, source.holes, length / (map->corners ? map->nx - 1 : map->nx));
    add_map_notes(*map, path + ".file: " + source.file, warnings);
    return map;
}

std::pair<double, double> scale_and_offset(const MapSource& source) {
    return source.grey_range ? std::pair(source.max - source.min, source.min) : std::pair(source.scale, source.offset);
}

Result<std::vector<float>> values_of(const Map& map, const MapSource& source, const std::string& path, int nx, int ny) {
    std::vector<float> values = resample(map, nx, ny);
    const auto [scale, offset] = scale_and_offset(source);
    const MapMeaning& meaning = source.meaning;
    const auto value_of = [&, scale = scale, offset = offset](std::size_t cell) {
        return static_cast<double>(values[cell]) * scale + offset;
    };
    const std::size_t wrong = first_cell(values.size(), [&](std::size_t cell) {
        const double value = value_of(cell);
        return !(value >= meaning.least && value <= meaning.most);
    });
    if (wrong < values.size())
        return error(Code::bad_file, outside_text(path + ": " + meaning.name, value_of(wrong), meaning.least, meaning.most) +
                                         " in cell (" + std::to_string(wrong % static_cast<std::size_t>(nx)) + ", " +
                                         std::to_string(wrong / static_cast<std::size_t>(nx)) + ")");
    in_bands(values.size(), CELL_BAND, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell) values[cell] = static_cast<float>(value_of(cell));
    });
    return values;
}

bool looks_like_corners(int nx, int ny) {
    constexpr int least = 32; // cells: smaller maps are drawn by hand
    const auto power = [](int n) { return n >= least && (n & (n - 1)) == 0; };
    return power(nx - 1) && power(ny - 1);
}

void add_map_notes(const Map& map, const std::string& path, std::vector<std::string>& warnings) {
    if (map.filled > 0)
        warnings.push_back(path + ": " + std::to_string(map.filled) + " of " + std::to_string(std::int64_t{map.nx} * map.ny) +
                           " cells hold NODATA_value; they take the height of the nearest cell that has one");
    for (const std::string& note : map.notes) warnings.push_back(path + ": " + note);
}

} // namespace wadi
