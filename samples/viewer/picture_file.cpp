#include "picture_file.hpp"
#include "../common/files.hpp"
#include "../common/jpeg.hpp"
#include "../common/png.hpp"
#include <cstdio>
#include <stdexcept>

namespace viewer {

void write_picture(const std::filesystem::path& file, const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height) {
    std::vector<uint8_t> rgb;
    rgb.reserve(rgba.size() / 4 * 3);
    for (std::size_t k = 0; k + 3 < rgba.size(); k += 4) rgb.insert(rgb.end(), {rgba[k], rgba[k + 1], rgba[k + 2]});
    const auto encode = file.extension() == ".jpg" ? common::encode_jpeg : common::encode_png;
    const std::string bytes = encode(rgb.data(), static_cast<int>(width), static_cast<int>(height));
    if (bytes.empty()) throw std::runtime_error("cannot write " + file.string() + ": no memory");
    if (const std::string error = common::write_file(file, bytes); !error.empty()) throw std::runtime_error(error);
}

std::string numbered(const char* prefix, uint64_t number, const char* ending) {
    char text[64];
    std::snprintf(text, sizeof(text), "%s_%05llu.%s", prefix, static_cast<unsigned long long>(number), ending);
    return text;
}

} // namespace viewer
