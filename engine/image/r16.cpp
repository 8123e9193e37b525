#include "engine/image/map.hpp"
#include <cmath>
#include <cstddef>

namespace wadi {

Result<Map> decode_r16(const std::vector<std::uint8_t>& bytes, const std::string& name, std::optional<std::pair<int, int>> size,
                       FileRoom* room) {
    const std::uint64_t samples = bytes.size() / 2;
    std::int64_t nx = 0;
    std::int64_t ny = 0;
    if (size) {
        nx = size->first;
        ny = size->second;
    } else {
        nx = std::llround(std::sqrt(static_cast<double>(samples)));
        ny = nx;
        if (bytes.empty() || static_cast<std::uint64_t>(nx * ny) * 2 != bytes.size())
            return error(Code::bad_file, name + ": " + std::to_string(bytes.size()) +
                                             " bytes is not a square map of 16-bit samples; give its size");
    }
    if (Status status = check_map_size(nx, ny, name, room); !status) return status;
    const auto expected = static_cast<std::uint64_t>(nx * ny) * 2;
    if (bytes.size() != expected)
        return error(Code::bad_file, name + ": " + (bytes.size() < expected ? "truncated, " : "wrong size, ") +
                                         std::to_string(bytes.size()) + " bytes where " + std::to_string(nx) + " x " +
                                         std::to_string(ny) + " 16-bit samples take " + std::to_string(expected));
    Map map;
    map.nx = static_cast<int>(nx);
    map.ny = static_cast<int>(ny);
    map.integer = true;
    map.values.reserve(static_cast<std::size_t>(samples));
    const auto width = static_cast<std::size_t>(nx);
    for (auto row = static_cast<std::size_t>(ny); row-- > 0;)
        for (std::size_t i = 0; i < width; ++i) {
            const std::size_t at = 2 * (row * width + i);
            map.values.push_back(static_cast<float>(bytes[at] + 256 * bytes[at + 1]) / 65535.0f);
        }
    return map;
}

} // namespace wadi
