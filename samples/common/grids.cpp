#include "grids.hpp"
#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>

namespace common {
namespace {

template <class Number> void append_number(std::string& text, Number value) {
    std::array<char, 64> digits{};
    text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

void append_bytes(std::string& to, const void* from, std::size_t size) { to.append(static_cast<const char*>(from), size); }

/// The directory of a TIFF: tags in ascending order, and behind them what does not fit into their four bytes.
class Directory {
  public:
    explicit Directory(std::uint32_t at, std::uint16_t tags) : behind_at_(at + 2 + 12U * tags + 4) {
        append_bytes(tags_, &tags, 2);
    }

    template <class Value> void add(std::uint16_t tag, std::uint16_t type, const std::vector<Value>& values) {
        const auto count = static_cast<std::uint32_t>(values.size());
        append_bytes(tags_, &tag, 2);
        append_bytes(tags_, &type, 2);
        append_bytes(tags_, &count, 4);
        std::string bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
        if (bytes.size() > 4) {
            const auto place = static_cast<std::uint32_t>(behind_at_ + behind_.size());
            behind_ += bytes;
            bytes.assign(reinterpret_cast<const char*>(&place), 4);
        }
        bytes.resize(4, '\0');
        tags_ += bytes;
    }
    std::string whole() const { return tags_ + std::string(4, '\0') + behind_; }

  private:
    std::size_t behind_at_;
    std::string tags_, behind_;
};

} // namespace

std::string encode_asc(const std::vector<float>& values, const GridPlace& place) {
    std::string text = "ncols ";
    append_number(text, place.nx);
    append_number(text += "\nnrows ", place.ny);
    append_number(text += "\nxllcorner ", place.west);
    append_number(text += "\nyllcorner ", place.south);
    append_number(text += "\ncellsize ", place.dx);
    text += "\nNODATA_value -9999\n";
    for (int j = place.ny; j-- > 0;)
        for (int i = 0; i < place.nx; ++i) {
            append_number(text,
                          values[static_cast<std::size_t>(j) * static_cast<std::size_t>(place.nx) + static_cast<std::size_t>(i)]);
            text += i + 1 == place.nx ? '\n' : ' ';
        }
    return text;
}

std::string encode_geotiff(const std::vector<float>& values, const GridPlace& place) {
    static_assert(std::endian::native == std::endian::little, "TIFFs are written in the order of bytes of this machine");
    enum : std::uint16_t { SHORT = 3, LONG = 4, DOUBLE = 12 };
    using Shorts = std::vector<std::uint16_t>;
    using Longs = std::vector<std::uint32_t>;
    const auto width = static_cast<std::size_t>(place.nx), rows = static_cast<std::size_t>(place.ny);
    const std::size_t row = width * sizeof(float), header = 8;
    const auto data_bytes = static_cast<std::uint32_t>(row * rows), at = static_cast<std::uint32_t>(header) + data_bytes;
    std::string bytes("II*\0", 4);
    append_bytes(bytes, &at, 4);
    for (std::size_t j = rows; j-- > 0;) append_bytes(bytes, &values[j * width], row);
    Directory directory(at, 13);
    directory.add(256, LONG, Longs{static_cast<std::uint32_t>(place.nx)});
    directory.add(257, LONG, Longs{static_cast<std::uint32_t>(place.ny)});
    directory.add(258, SHORT, Shorts{32});                                 // bits
    directory.add(259, SHORT, Shorts{1});                                  // not packed
    directory.add(262, SHORT, Shorts{1});                                  // black is 0
    directory.add(273, LONG, Longs{static_cast<std::uint32_t>(header)});   // one strip
    directory.add(277, SHORT, Shorts{1});                                  // one sample each
    directory.add(278, LONG, Longs{static_cast<std::uint32_t>(place.ny)}); // rows of the strip
    directory.add(279, LONG, Longs{data_bytes});
    directory.add(339, SHORT, Shorts{3}); // floats
    directory.add(33550, DOUBLE, std::vector<double>{place.dx, place.dx, 0});
    directory.add(33922, DOUBLE, std::vector<double>{0, 0, 0, place.west, place.south + place.ny * place.dx, 0});
    directory.add(34735, SHORT, Shorts{1, 1, 0, 1, 1025, 0, 1, 1}); // samples are cells, not their corners
    return bytes + directory.whole();
}

} // namespace common
