#include "engine/image/map.hpp"
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string_view>

namespace wadi {
namespace {

static_assert(std::endian::native == std::endian::little, "NPY values are copied as stored");

constexpr std::size_t PREAMBLE_BYTES = 8; // magic and version
constexpr std::size_t HEADER_LIMIT = 65536;

/// What follows `'key':` in the header's Python dictionary, without leading spaces; empty when the key is missing.
std::string_view dictionary_value(std::string_view header, std::string_view key) {
    const std::size_t at = header.find(key);
    if (at == std::string_view::npos) return {};
    const std::size_t colon = header.find(':', at);
    if (colon == std::string_view::npos) return {};
    const std::size_t start = header.find_first_not_of(' ', colon + 1);
    return start == std::string_view::npos ? std::string_view{} : header.substr(start);
}

/// The numbers of a tuple such as "(3, 4)" or "(3,)"; false when it is none.
bool tuple(std::string_view text, std::vector<std::int64_t>& numbers) {
    if (text.empty() || text.front() != '(') return false;
    const char* at = text.data() + 1;
    const char* end = text.data() + text.size();
    while (at != end && *at != ')') {
        if (*at == ' ' || *at == ',') {
            ++at;
            continue;
        }
        std::int64_t number = 0;
        const auto parsed = std::from_chars(at, end, number);
        if (parsed.ec != std::errc{}) return false;
        numbers.push_back(number);
        at = parsed.ptr;
    }
    return at != end;
}

template <class Scalar> Result<Map> read_values(const std::uint8_t* data, int nx, int ny, const std::string& name) {
    Map map;
    map.nx = nx;
    map.ny = ny;
    const std::size_t count = static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
    map.values.reserve(count);
    for (std::size_t n = 0; n < count; ++n) {
        Scalar stored;
        std::memcpy(&stored, data + n * sizeof(Scalar), sizeof(Scalar));
        if (!(std::fabs(stored) <= static_cast<Scalar>(std::numeric_limits<float>::max())))
            return error(Code::bad_file, name + ": the value in column " + std::to_string(n % static_cast<std::size_t>(nx)) +
                                             ", row " + std::to_string(n / static_cast<std::size_t>(nx)) + " is " +
                                             (std::isnan(stored) ? "NaN" : "infinite or too large for a float"));
        map.values.push_back(static_cast<float>(stored));
    }
    return map;
}

} // namespace

Result<Map> decode_npy(const std::vector<std::uint8_t>& bytes, const std::string& name, FileRoom* room) {
    static const std::uint8_t magic[6] = {0x93, 'N', 'U', 'M', 'P', 'Y'};
    if (bytes.size() < PREAMBLE_BYTES + 2 || !std::equal(magic, magic + 6, bytes.begin()))
        return error(Code::bad_file, name + ": not an NPY file");
    const int version = bytes[6];
    if (version != 1 && version != 2)
        return error(Code::bad_file, name + ": NPY format version " + std::to_string(version) + " is not read, only 1 and 2");
    const std::size_t length_bytes = version == 1 ? 2 : 4;
    const std::size_t header_at = PREAMBLE_BYTES + length_bytes;
    std::size_t header_size = 0;
    for (std::size_t n = 0; n < length_bytes && PREAMBLE_BYTES + n < bytes.size(); ++n)
        header_size |= static_cast<std::size_t>(bytes[PREAMBLE_BYTES + n]) << (8 * n);
    if (header_size > HEADER_LIMIT || bytes.size() < header_at + header_size)
        return error(Code::bad_file, name + ": truncated inside the NPY header");

    const std::string_view header(reinterpret_cast<const char*>(bytes.data()) + header_at, header_size);
    const std::string_view type = dictionary_value(header, "'descr'");
    const bool wide = type.starts_with("'<f8'");
    if (!wide && !type.starts_with("'<f4'"))
        return error(Code::bad_file, name + ": element type " + std::string(type.substr(0, type.find(','))) +
                                         " is not read, only '<f4' and '<f8'");
    if (!dictionary_value(header, "'fortran_order'").starts_with("False"))
        return error(Code::bad_file, name + ": only arrays in C order are read");
    std::vector<std::int64_t> shape;
    if (!tuple(dictionary_value(header, "'shape'"), shape) || shape.size() != 2)
        return error(Code::bad_file, name + ": the shape must be (rows, columns)");
    if (Status status = check_map_size(shape[1], shape[0], name, room); !status) return status;

    const auto nx = static_cast<int>(shape[1]);
    const auto ny = static_cast<int>(shape[0]);
    const std::uint64_t expected = static_cast<std::uint64_t>(shape[0]) * static_cast<std::uint64_t>(shape[1]) * (wide ? 8 : 4);
    const std::uint64_t held = bytes.size() - header_at - header_size;
    if (held != expected)
        return error(Code::bad_file, name + ": " + (held < expected ? "truncated, " : "wrong size, ") + std::to_string(held) +
                                         " bytes of data where " + std::to_string(nx) + " x " + std::to_string(ny) +
                                         " values take " + std::to_string(expected));
    const std::uint8_t* data = bytes.data() + header_at + header_size;
    return wide ? read_values<double>(data, nx, ny, name) : read_values<float>(data, nx, ny, name);
}

} // namespace wadi
