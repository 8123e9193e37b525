// Samples without a header: what they are follows from the size of the file, its name, and from which reading is smooth.
#include "engine/image/map.hpp"
#include "engine/image/plausible.hpp"
#include "engine/settings/rules/messages.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <numbers>

namespace wadi {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Size = std::optional<std::pair<int, int>>;

/// The side of a square of so many samples; 0 where they are none.
std::int64_t side_of(std::uint64_t samples) {
    const std::int64_t side = std::llround(std::sqrt(static_cast<double>(samples)));
    return static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side) == samples ? side : 0;
}

std::string size_text(std::int64_t nx, std::int64_t ny) { return std::to_string(nx) + " x " + std::to_string(ny); }

/// Columns and rows of samples of so many bytes, as given or square.
Result<std::pair<int, int>> shape_of(const Bytes& bytes, const std::string& name, const Size& size, std::uint64_t each,
                                     FileRoom* room) {
    const std::int64_t side = side_of(bytes.size() / each);
    const std::string bits = std::to_string(8 * each) + "-bit samples";
    if (!size && (bytes.empty() || side == 0 || bytes.size() % each != 0))
        return error(Code::bad_file,
                     name + ": " + std::to_string(bytes.size()) + " bytes is not a square map of " + bits + "; give its size");
    const std::int64_t nx = size ? size->first : side, ny = size ? size->second : side;
    if (Status status = check_map_size(nx, ny, name, room); !status) return status;
    const std::uint64_t expected = static_cast<std::uint64_t>(nx * ny) * each;
    if (bytes.size() != expected)
        return error(Code::bad_file, name + ": " + (bytes.size() < expected ? "truncated, " : "wrong size, ") +
                                         std::to_string(bytes.size()) + " bytes where " + size_text(nx, ny) + " " + bits +
                                         " take " + std::to_string(expected));
    return std::pair{static_cast<int>(nx), static_cast<int>(ny)};
}

/// A map of value(n) of each sample, which the file has from the north on.
template <class Value> Map map_of(const std::pair<int, int>& shape, const Value& value) {
    Map map;
    map.nx = shape.first;
    map.ny = shape.second;
    const auto width = static_cast<std::size_t>(map.nx);
    map.values.reserve(width * static_cast<std::size_t>(map.ny));
    for (auto row = static_cast<std::size_t>(map.ny); row-- > 0;)
        for (std::size_t i = 0; i < width; ++i) map.values.push_back(value(row * width + i));
    return map;
}

struct Reading {
    bool swapped = false, is_signed = false;
};

/// Of 0 ... 65535; signed ones moved up, so that the lowest is black.
float sample_of_16(const Bytes& bytes, std::size_t n, const Reading& how) {
    const unsigned first = bytes[2 * n], second = bytes[2 * n + 1];
    const unsigned value = how.swapped ? 256 * first + second : first + 256 * second;
    return static_cast<float>(how.is_signed ? (value + 32768) % 65536 : value) / 65535.0f;
}

Map map_of_16(const Bytes& bytes, const std::pair<int, int>& shape, const Reading& how) {
    Map map = map_of(shape, [&](std::size_t n) { return sample_of_16(bytes, n, how); });
    map.integer = true;
    return map;
}

/// Mean difference of neighbours, not over the range: large where a sea level is read as a cliff from black to white.
double steps_of(const Map& map) {
    const auto [low, high] = std::minmax_element(map.values.begin(), map.values.end());
    return roughness_of(map) * (static_cast<double>(*high) - static_cast<double>(*low));
}

/// Signed where that has far smaller steps.
Map of_either_sign(const Bytes& bytes, const std::pair<int, int>& shape, bool swapped) {
    constexpr double by_far = 8;
    Map map = map_of_16(bytes, shape, {swapped, false});
    Map other = map_of_16(bytes, shape, {swapped, true});
    if (!(steps_of(other) < steps_of(map) / by_far)) return map;
    other.notes.emplace_back("its 16-bit samples are signed: black is -32768, white 32767");
    return other;
}

/// Little-endian, unless that is noise and the other order is none. Black and white alone are the same in any reading.
Map smoothest_of_16(const Bytes& bytes, const std::pair<int, int>& shape) {
    constexpr std::size_t fewest = 256, levels = 64;
    Map plain = map_of_16(bytes, shape, {});
    if (plain.values.size() < fewest) return plain;
    std::vector<float> different = plain.values;
    std::sort(different.begin(), different.end());
    if (std::unique(different.begin(), different.end()) - different.begin() < static_cast<std::ptrdiff_t>(levels)) return plain;
    constexpr double noisy = 0.1, by_far = 4;
    Map map = of_either_sign(bytes, shape, false);
    const double roughness = roughness_of(map);
    if (roughness < noisy) return map;
    Map other = of_either_sign(bytes, shape, true);
    if (!(roughness_of(other) < roughness / by_far)) return map;
    other.notes.insert(other.notes.begin(), "its bytes are swapped: read as big-endian 16-bit samples");
    return other;
}

float float_of(const Bytes& bytes, std::size_t n, bool swapped) {
    std::array<std::uint8_t, 4> each{};
    std::copy_n(&bytes[4 * n], 4, each.begin());
    if (swapped) std::reverse(each.begin(), each.end());
    float value = 0; // std::bit_cast is not in LLVM's library before version 14
    std::memcpy(&value, each.data(), sizeof value);
    return value;
}

/// Values that no ground has, or that are hardly numbers.
std::size_t odd_floats(const Bytes& bytes, bool swapped) {
    std::size_t odd = 0;
    for (std::size_t n = 0; n < bytes.size() / 4; ++n) {
        const float size = std::fabs(float_of(bytes, n, swapped));
        odd += !(size <= 1e6f) || (size > 0 && size < 1e-6f) ? 1 : 0;
    }
    return odd;
}

/// Whether bytes are floats rather than samples of 8 bits: those at one place in four are few, at another many.
bool looks_like_floats(const Bytes& bytes) {
    std::array<std::array<bool, 256>, 4> seen{};
    for (std::size_t n = 0; n < bytes.size(); ++n) seen[n % 4][bytes[n]] = true;
    std::array<std::ptrdiff_t, 4> counts{};
    for (std::size_t n = 0; n < 4; ++n) counts[n] = std::count(seen[n].begin(), seen[n].end(), true);
    const auto [few, many] = std::minmax_element(counts.begin(), counts.end());
    return *many > 3 * *few && std::min(odd_floats(bytes, false), odd_floats(bytes, true)) < bytes.size() / 4 / 8;
}

/// The degrees of latitude that a tile's name begins with, N46E007; nothing where it has none.
std::optional<double> latitude_of(const std::string& name) {
    const std::string file = std::filesystem::path(name).filename().string();
    const auto digit = [&](std::size_t at) { return file[at] >= '0' && file[at] <= '9'; };
    if (file.size() < 7 || !digit(1) || !digit(2) || !digit(4) || !digit(5) || !digit(6)) return std::nullopt;
    const bool south = file[0] == 'S' || file[0] == 's';
    if (!south && file[0] != 'N' && file[0] != 'n') return std::nullopt;
    const double degrees = 10 * (file[1] - '0') + (file[2] - '0');
    return south ? -degrees : degrees;
}

} // namespace

Result<Map> decode_r16(const Bytes& bytes, const std::string& name, Size size, FileRoom* room) {
    auto shape = shape_of(bytes, name, size, 2, room);
    if (!shape) return shape.status();
    return smoothest_of_16(bytes, *shape);
}

Result<Map> decode_r32(const Bytes& bytes, const std::string& name, Size size, FileRoom* room) {
    auto shape = shape_of(bytes, name, size, 4, room);
    if (!shape) return shape.status();
    const bool swapped = odd_floats(bytes, true) < odd_floats(bytes, false);
    Map map = map_of(*shape, [&](std::size_t n) {
        const float value = float_of(bytes, n, swapped);
        return is_float_limit(static_cast<double>(value)) ? std::nanf("") : value;
    });
    if (swapped) map.notes.emplace_back("its bytes are swapped: read as big-endian floats");
    const auto bad = std::find_if(map.values.begin(), map.values.end(), [](float value) { return std::isinf(value); });
    if (bad != map.values.end()) return error(Code::bad_file, name + ": it holds infinite values");
    if (Status status = fill_holes(map, name); !status) return status;
    return map;
}

Result<Map> decode_raw(const Bytes& bytes, const std::string& name, Size size, FileRoom* room) {
    const std::uint64_t samples = size ? static_cast<std::uint64_t>(size->first) * static_cast<std::uint64_t>(size->second) : 0;
    const auto holds = [&](std::uint64_t each) {
        if (bytes.empty() || bytes.size() % each != 0) return false;
        return size ? bytes.size() == samples * each : side_of(bytes.size() / each) > 0;
    };
    // A square of 16-bit samples is none of 8 or 32; each square of floats is one of 8 bits, too, twice as long.
    const bool floats = holds(4) && (!holds(1) || looks_like_floats(bytes));
    if (!floats && !holds(1)) return decode_r16(bytes, name, size, room);
    auto shape = shape_of(bytes, name, size, floats ? 4 : 1, room);
    if (!shape) return shape.status();
    const std::string note = "read as " + size_text(shape->first, shape->second) + " samples of " +
                             (floats ? "32 bits, floats" : "8 bits") + ", by its " + std::to_string(bytes.size()) + " bytes";
    if (floats) {
        auto map = decode_r32(bytes, name, std::pair{shape->first, shape->second});
        if (map) map->notes.insert(map->notes.begin(), note);
        return map;
    }
    Map map = map_of(*shape, [&](std::size_t n) { return static_cast<float>(bytes[n]) / 255.0f; });
    map.integer = true;
    map.notes.push_back(note);
    return map;
}

Result<Map> decode_hgt(const Bytes& bytes, const std::string& name, FileRoom* room) {
    auto shape = shape_of(bytes, name, std::nullopt, 2, nullptr);
    if (!shape) return shape.status();
    const int cells = shape->first - 1;
    if (cells < 1) return error(Code::bad_file, name + ": one sample is no tile");
    constexpr double along_meridian = 111132, along_equator = 111320; // of a degree [m]
    const auto south = latitude_of(name);
    const double middle = south ? (*south + 0.5) * std::numbers::pi / 180 : 0;
    const double dy = along_meridian / cells, dx = south ? along_equator * std::cos(middle) / cells : dy;
    const double rows = std::round(cells * dy / dx);
    if (Status status = check_map_size(cells, static_cast<std::int64_t>(rows), name, nullptr); !status) return status;
    const std::int64_t samples = std::int64_t{shape->first} * shape->second;
    if (room != nullptr)
        if (Status status = room->take({samples + cells * static_cast<std::int64_t>(rows), cells, static_cast<int>(rows)}, name);
            !status)
            return status;
    Map tile = map_of(*shape, [&](std::size_t n) {
        const int value = 256 * bytes[2 * n] + bytes[2 * n + 1];
        return static_cast<float>(value < 32768 ? value : value - 65536);
    });
    tile.corners = true;
    if (Status status = fill_holes(tile, name); !status) return status;
    resample_map(tile, cells, static_cast<int>(rows));
    tile.cell_size = dx;
    tile.notes.push_back(south ? "a tile of a degree at latitude " + number_text(*south) + ": " + size_text(tile.nx, tile.ny) +
                                     " square cells of " + number_text(dx) + " m"
                               : "its name says no latitude, as N46E007.hgt does: cells of " + number_text(dx) +
                                     " m, as at the equator");
    return tile;
}

} // namespace wadi
