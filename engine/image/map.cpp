#include "engine/image/map.hpp"
#include "engine/threads/bands.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace wadi {
namespace {

constexpr const char* OUTSIDE = "lies outside the level's folder, where levels may name no files unless their host allows it";

std::string lower_case_ending(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return ending;
}

/// The two neighbouring samples of a position and the weight of the second.
struct Tap {
    std::size_t low = 0;
    std::size_t high = 0;
    double weight = 0;
};

std::vector<Tap> taps(int source, int target, bool corners) {
    std::vector<Tap> result(static_cast<std::size_t>(target));
    for (int i = 0; i < target; ++i) {
        const double place = corners ? (i + 0.5) * (source - 1) / target : (i + 0.5) * source / target - 0.5;
        const double position = std::clamp(place, 0.0, source - 1.0);
        const double low = std::floor(position);
        Tap& tap = result[static_cast<std::size_t>(i)];
        tap.low = static_cast<std::size_t>(low);
        tap.high = std::min(tap.low + 1, static_cast<std::size_t>(source - 1));
        tap.weight = position - low;
    }
    return result;
}

/// Places per cell along an axis, so that no sample is passed over.
int places(int source, int target) { return (source + target - 1) / target; }

} // namespace

FileRoom FileRoom::that_listens(std::int64_t values) {
    FileRoom room(values);
    room.listens_ = true;
    return room;
}

Status FileRoom::take(const Asked& asked, const std::string& name) {
    asked_ = asked;
    if (asked.values > left_)
        return error(Code::bad_file, name + ": its " + std::to_string(asked.values) + " values are more than the " +
                                         std::to_string(left_) + " that are left of what a level's files may hold together");
    left_ -= asked.values;
    return listens_ ? error(Code::not_ready, name + ": not decoded") : ok_status();
}

Status check_map_size(std::int64_t nx, std::int64_t ny, const std::string& name, FileRoom* room) {
    if (nx >= 1 && ny >= 1 && nx <= MAP_LIMIT && ny <= MAP_LIMIT)
        return room != nullptr ? room->take({nx * ny, static_cast<int>(nx), static_cast<int>(ny)}, name) : ok_status();
    return error(Code::bad_file, name + ": a map of " + std::to_string(nx) + " x " + std::to_string(ny) + " is outside 1 ... " +
                                     std::to_string(MAP_LIMIT) + " on each side");
}

Result<std::vector<std::uint8_t>> read_file_bytes(const std::string& path, std::uint64_t limit) {
    std::error_code failure;
    const auto kind = std::filesystem::status(path, failure).type();
    if (kind == std::filesystem::file_type::not_found) return error(Code::not_found, path + ": no such file");
    if (kind != std::filesystem::file_type::regular) return error(Code::bad_file, path + ": not a regular file");
    const std::uintmax_t size = std::filesystem::file_size(path, failure);
    if (failure) return error(Code::bad_file, path + ": " + failure.message());
    if (size > limit)
        return error(Code::bad_file, path + ": " + std::to_string(size) + " bytes is more than the largest accepted file, " +
                                         std::to_string(limit) + " bytes");
    std::ifstream file(path, std::ios::binary);
    if (!file) return error(Code::bad_file, path + ": cannot be opened for reading");
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(file.gcount()) != size)
        return error(Code::bad_file, path + ": reading stopped after " + std::to_string(file.gcount()) + " of " +
                                         std::to_string(size) + " bytes");
    return bytes;
}

Status check_below(const std::string& name) {
    const auto outside = [&] { return error(Code::bad_file, name + ": " + OUTSIDE); };
    if (name.empty() || name[0] == '/' || name[0] == '\\' || (name.size() > 1 && name[1] == ':')) return outside();
    for (std::size_t begin = 0; begin <= name.size();) {
        const std::size_t end = std::min(name.find_first_of("/\\", begin), name.size());
        if (name.compare(begin, end - begin, "..") == 0) return outside();
        begin = end + 1;
    }
    return ok_status();
}

FileReader files_in(const std::string& folder, FilesFrom from) {
    return [folder, from](const std::string& name, std::uint64_t limit) -> Result<std::vector<std::uint8_t>> {
        const auto path = std::filesystem::path(folder) / name;
        if (from == FilesFrom::below) {
            if (Status status = check_below(name); !status) return status;
            std::error_code failure;
            const auto around = std::filesystem::canonical(folder.empty() ? "." : folder, failure);
            const auto real = std::filesystem::weakly_canonical(path, failure);
            if (std::mismatch(around.begin(), around.end(), real.begin(), real.end()).first != around.end())
                return error(Code::bad_file, name + ": " + OUTSIDE);
        }
        return read_file_bytes(path.string(), limit);
    };
}

namespace {

/// Errors: bad_argument.
Status check_form(const std::string& path, const std::string& ending, const MapForm& form) {
    const bool raw = ending == ".r16" || ending == ".r32" || ending == ".raw";
    if (!raw && form.size) return error(Code::bad_argument, path + ": only .r16, .r32 and .raw maps are given a size");
    if (ending != ".png" && form.packing != Packing::grey)
        return error(Code::bad_argument, path + ": only .png maps hold heights packed into colours");
    return ok_status();
}

Result<Map> decode_map(const std::vector<std::uint8_t>& bytes, const std::string& path, const std::string& ending,
                       const MapForm& form, FileRoom& room) {
    if (ending == ".raw") return decode_raw(bytes, path, form.size, &room);
    if (ending == ".r32") return decode_r32(bytes, path, form.size, &room);
    if (ending == ".r16") return decode_r16(bytes, path, form.size, &room);
    if (ending == ".hgt") return decode_hgt(bytes, path, &room);
    if (ending == ".asc") return decode_asc(bytes, path, &room);
    return ending == ".png" ? decode_png(bytes, path, &room, form.packing) : decode_npy(bytes, path, &room);
}

template <class Values> void flip(Values& values, int nx, int ny, bool along_x, bool along_y) {
    const auto width = static_cast<std::ptrdiff_t>(nx);
    if (along_x)
        for (std::ptrdiff_t j = 0; j < ny; ++j) std::reverse(values.begin() + j * width, values.begin() + (j + 1) * width);
    if (along_y)
        for (std::ptrdiff_t j = 0; j < ny / 2; ++j)
            std::swap_ranges(values.begin() + j * width, values.begin() + (j + 1) * width, values.begin() + (ny - 1 - j) * width);
}

} // namespace

Result<Map> read_map(const std::string& path, const MapForm& form, const FileReader& files, FileRoom& room) {
    const std::string ending = lower_case_ending(path);
    static const char* const endings[] = {".png", ".r16", ".r32", ".raw", ".hgt", ".npy", ".asc"};
    if (std::find(std::begin(endings), std::end(endings), ending) == std::end(endings))
        return error(Code::bad_file, path + ": maps end in .png, .r16, .r32, .raw, .hgt, .npy or .asc");
    if (Status status = check_form(path, ending, form); !status) return status;
    // The largest map as float64 or as text, and some room for a header.
    const std::uint64_t values = std::min(static_cast<std::uint64_t>(room.left()), std::uint64_t{MAP_LIMIT} * MAP_LIMIT / 2);
    const std::uint64_t limit = values * 16 + 65536;
    auto bytes = files(path, limit);
    if (!bytes) return bytes.status();
    auto map = decode_map(*bytes, path, ending, form, room);
    if (!map) return map;
    flip(map->values, map->nx, map->ny, form.flip_x, form.flip_y);
    if (!map->holes.empty()) flip(map->holes, map->nx, map->ny, form.flip_x, form.flip_y);
    return map;
}

Result<MapCost> cost_of_map(const std::string& path, const MapForm& form, const FileReader& files, std::int64_t most_values) {
    MapCost cost;
    const FileReader measured = [&](const std::string& name, std::uint64_t limit) {
        auto bytes = files(name, limit);
        if (bytes) cost.file_bytes = bytes->size();
        return bytes;
    };
    FileRoom room = FileRoom::that_listens(most_values);
    const auto map = read_map(path, form, measured, room);
    if (!map && map.status().code != Code::not_ready) return map.status();
    cost.asked = room.asked();
    return cost;
}

std::vector<float> resample(const Map& map, int nx, int ny) {
    if (map.nx == nx && map.ny == ny && !map.corners) return map.values;
    const auto width = static_cast<std::size_t>(places(map.nx, nx));
    const auto depth = static_cast<std::size_t>(places(map.ny, ny));
    const std::vector<Tap> columns = taps(map.nx, nx * static_cast<int>(width), map.corners);
    const std::vector<Tap> rows = taps(map.ny, ny * static_cast<int>(depth), map.corners);
    const auto share = 1.0 / static_cast<double>(width * depth);
    const auto length = static_cast<std::size_t>(nx);
    std::vector<float> result(length * static_cast<std::size_t>(ny));
    const auto along = [&](std::size_t start, const Tap& column) {
        return static_cast<double>(map.values[start + column.low]) * (1 - column.weight) +
               static_cast<double>(map.values[start + column.high]) * column.weight;
    };
    in_bands(static_cast<std::size_t>(ny), row_band(length), [&](std::size_t, std::size_t begin, std::size_t end) {
        std::vector<double> sums(length);
        for (std::size_t j = begin; j < end; ++j) {
            std::fill(sums.begin(), sums.end(), 0.0);
            for (std::size_t n = j * depth; n < (j + 1) * depth; ++n) {
                const Tap& row = rows[n];
                const std::size_t south = row.low * static_cast<std::size_t>(map.nx);
                const std::size_t north = row.high * static_cast<std::size_t>(map.nx);
                for (std::size_t i = 0; i < columns.size(); ++i)
                    sums[i / width] += along(south, columns[i]) * (1 - row.weight) + along(north, columns[i]) * row.weight;
            }
            for (std::size_t i = 0; i < length; ++i) result[j * length + i] = static_cast<float>(sums[i] * share);
        }
    });
    return result;
}

void resample_map(Map& map, int nx, int ny) {
    std::vector<float> values = resample(map, nx, ny);
    if (!map.holes.empty()) {
        const auto nearest = [corners = map.corners](int i, int source, int target) {
            const double place = corners ? (i + 0.5) * (source - 1) / target + 0.5 : (i + 0.5) * source / target;
            return static_cast<std::size_t>(std::clamp(static_cast<int>(place), 0, source - 1));
        };
        std::vector<bool> holes;
        holes.reserve(values.size());
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i)
                holes.push_back(map.holes[nearest(j, map.ny, ny) * static_cast<std::size_t>(map.nx) + nearest(i, map.nx, nx)]);
        map.holes = std::move(holes);
    }
    map.values = std::move(values);
    map.nx = nx;
    map.ny = ny;
    map.corners = false;
}

} // namespace wadi
