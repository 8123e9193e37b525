#include "picture_file.hpp"
#include <cstdio>
#include <stdexcept>
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace viewer {

void write_png(const std::filesystem::path& file, const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height) {
    std::vector<uint8_t> rgb;
    rgb.reserve(rgba.size() / 4 * 3);
    for (std::size_t k = 0; k + 3 < rgba.size(); k += 4) rgb.insert(rgb.end(), {rgba[k], rgba[k + 1], rgba[k + 2]});
    const std::filesystem::path part = file.string() + ".part";
    stbi_write_force_png_filter = 2; // "up" in every row: trying all five takes longer than compressing, and gains little
    if (stbi_write_png(part.string().c_str(), static_cast<int>(width), static_cast<int>(height), 3, rgb.data(),
                       static_cast<int>(3 * width)) == 0)
        throw std::runtime_error("cannot write " + part.string());
    std::error_code error;
    std::filesystem::rename(part, file, error);
    if (error) throw std::runtime_error("cannot write " + file.string() + ": " + error.message());
}

std::string numbered(const char* prefix, uint64_t number) {
    char text[64];
    std::snprintf(text, sizeof(text), "%s_%05llu.png", prefix, static_cast<unsigned long long>(number));
    return text;
}

} // namespace viewer
