// Map files built in memory for the tests of engine/image and engine/level, and a folder that is removed at the end.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace map_files {

using Bytes = std::vector<std::uint8_t>;

inline void append(Bytes& bytes, const std::string& text) { bytes.insert(bytes.end(), text.begin(), text.end()); }

inline void append_big(Bytes& bytes, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

inline std::uint32_t crc(const std::uint8_t* data, std::size_t size) {
    std::uint32_t value = 0xffffffffu;
    for (std::size_t n = 0; n < size; ++n) {
        value ^= data[n];
        for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1u) != 0 ? 0xedb88320u : 0u);
    }
    return ~value;
}

inline void append_chunk(Bytes& png, const std::string& kind, const Bytes& data) {
    append_big(png, static_cast<std::uint32_t>(data.size()));
    const std::size_t start = png.size();
    append(png, kind);
    png.insert(png.end(), data.begin(), data.end());
    append_big(png, crc(png.data() + start, png.size() - start));
}

/// A PNG whose data is one stored (uncompressed) block. `samples` is what the file holds: rows from north to south, big-endian.
inline Bytes png(std::uint32_t nx, std::uint32_t ny, std::uint8_t depth, std::uint8_t color, const Bytes& samples) {
    Bytes raw;
    const std::size_t pitch = ny == 0 ? 0 : samples.size() / ny;
    for (std::size_t row = 0; row < ny && !samples.empty(); ++row) {
        raw.push_back(0);
        for (std::size_t n = 0; n < pitch; ++n) raw.push_back(samples[row * pitch + n]);
    }
    std::uint32_t a = 1;
    std::uint32_t b = 0;
    for (const std::uint8_t byte : raw) {
        a = (a + byte) % 65521;
        b = (b + a) % 65521;
    }
    const auto size = static_cast<std::uint16_t>(raw.size());
    Bytes zlib = {0x78, 0x01, 0x01};
    for (const int word : {int{size}, 0xffff - size}) {
        zlib.push_back(static_cast<std::uint8_t>(word & 0xff));
        zlib.push_back(static_cast<std::uint8_t>(word >> 8));
    }
    zlib.insert(zlib.end(), raw.begin(), raw.end());
    append_big(zlib, (b << 16) | a);

    Bytes header;
    append_big(header, nx);
    append_big(header, ny);
    header.insert(header.end(), {depth, color, 0, 0, 0});
    Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    append_chunk(file, "IHDR", header);
    append_chunk(file, "IDAT", zlib);
    append_chunk(file, "IEND", {});
    return file;
}

/// A PNG of zeros whose data is one deflate block of repeats: some 1/159 of what it decodes to. `bytes`: what that is, by default
/// what the header implies.
inline Bytes png_of_zeros(std::uint32_t nx, std::uint32_t ny, std::uint8_t depth, std::uint8_t color, std::uint64_t bytes = 0) {
    const std::uint64_t channels = color == 2 ? 3 : color == 4 ? 2 : color == 6 ? 4 : 1;
    std::uint64_t left = bytes > 0 ? bytes : (nx * channels * depth / 8 + 1) * ny;
    Bytes zlib = {0x78, 0x01};
    std::uint32_t bits = 0;
    int filled = 0;
    const auto put = [&](std::uint32_t code, int length) { // from its first bit on
        for (int n = length; n-- > 0; ++filled) {
            if (filled == 8) zlib.push_back(static_cast<std::uint8_t>(bits)), bits = 0, filled = 0;
            bits |= ((code >> n) & 1u) << filled;
        }
    };
    // RFC 1951: last block, fixed codes; a literal 0, then repeats of 258 bytes at distance 1, then literals.
    put(1, 1), put(2, 2), put(0x30, 8);
    for (--left; left >= 258; left -= 258) put(0xc5, 8), put(0, 5);
    for (; left > 0; --left) put(0x30, 8);
    put(0, 7);
    zlib.push_back(static_cast<std::uint8_t>(bits));
    append_big(zlib, 0); // Adler-32, which the decoder does not ask for: the chunks have sums of their own
    Bytes header;
    append_big(header, nx);
    append_big(header, ny);
    header.insert(header.end(), {depth, color, 0, 0, 0});
    Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    append_chunk(file, "IHDR", header);
    append_chunk(file, "IDAT", zlib);
    append_chunk(file, "IEND", {});
    return file;
}

inline Bytes words(const std::vector<std::uint16_t>& values, bool big_endian) {
    Bytes bytes;
    for (const std::uint16_t value : values) {
        const auto low = static_cast<std::uint8_t>(value & 0xff);
        const auto high = static_cast<std::uint8_t>(value >> 8);
        bytes.push_back(big_endian ? high : low);
        bytes.push_back(big_endian ? low : high);
    }
    return bytes;
}

inline Bytes png16(std::uint32_t nx, std::uint32_t ny, const std::vector<std::uint16_t>& values) {
    return png(nx, ny, 16, 0, words(values, true));
}

/// An NPY file with this dictionary and these values.
template <class Scalar> Bytes npy(const std::string& dictionary, const std::vector<Scalar>& values, int version = 1) {
    Bytes file = {0x93, 'N', 'U', 'M', 'P', 'Y', static_cast<std::uint8_t>(version), 0};
    for (int n = 0; n < (version == 1 ? 2 : 4); ++n)
        file.push_back(static_cast<std::uint8_t>((dictionary.size() >> (8 * n)) & 0xff));
    append(file, dictionary);
    const std::size_t start = file.size();
    file.resize(start + values.size() * sizeof(Scalar));
    if (!values.empty()) std::memcpy(file.data() + start, values.data(), values.size() * sizeof(Scalar));
    return file;
}

inline std::string dictionary(const std::string& type, const std::string& shape, const std::string& order = "False") {
    return "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
}

class Folder {
  public:
    Folder() {
        std::random_device random;
        path_ = std::filesystem::temp_directory_path() / ("wadi_" + std::to_string(random()) + std::to_string(random()));
        std::filesystem::create_directories(path_);
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string path() const { return path_.string(); }
    std::string file(const std::string& name) const { return (path_ / name).string(); }
    std::string write(const std::string& name, const Bytes& bytes) const {
        std::ofstream out(path_ / name, std::ios::binary);
        out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return file(name);
    }
    std::string write(const std::string& name, const std::string& text) const {
        return write(name, Bytes(text.begin(), text.end()));
    }

  private:
    std::filesystem::path path_;
};

} // namespace map_files
