#include "files.hpp"
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace common {

std::string write_file(const std::filesystem::path& path, std::string_view bytes) {
    std::filesystem::path temporary = path;
    temporary += ".part";
    errno = 0;
    {
        std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
        file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        file.close();
        if (!file) {
            const std::string reason = errno != 0 ? std::strerror(errno) : "write failed";
            std::error_code ignored;
            std::filesystem::remove(temporary, ignored);
            return "cannot write " + path.string() + ": " + reason;
        }
    }
    std::error_code error;
    std::filesystem::rename(temporary, path, error);
    if (error) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        return "cannot write " + path.string() + ": " + error.message();
    }
    return {};
}

std::string encode_npy(const std::vector<float>& values, int nx, int ny) {
    static_assert(std::endian::native == std::endian::little, "NPY files are written as little-endian float32");
    std::string header =
        "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(ny) + ", " + std::to_string(nx) + "), }";
    // The format wants the data to start at a multiple of 64 bytes and the header to end in a newline.
    const std::size_t fixed = 10;
    header.append((64 - (fixed + header.size() + 1) % 64) % 64, ' ');
    header += '\n';
    std::string bytes("\x93NUMPY\x01\x00", 8);
    bytes += static_cast<char>(header.size() & 0xff);
    bytes += static_cast<char>(header.size() >> 8);
    bytes += header;
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
    return bytes;
}

} // namespace common
