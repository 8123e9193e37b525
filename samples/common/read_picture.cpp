#include "read_picture.hpp"
#include <memory>
#include <stdexcept>
#include <string>

#define STBI_NO_FAILURE_STRINGS
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace common {
namespace {

void check_size(const std::filesystem::path& file, int most) {
    if (!std::filesystem::is_regular_file(file)) throw std::runtime_error(file.string() + " is no file");
    int width = 0, height = 0, channels = 0;
    if (stbi_info(file.string().c_str(), &width, &height, &channels) == 0)
        throw std::runtime_error(file.string() + " is no PNG or JPEG");
    if (width > most || height > most)
        throw std::runtime_error(file.string() + " has " + std::to_string(width) + " x " + std::to_string(height) +
                                 " pixels, at most " + std::to_string(most) + " along a side are taken");
}

[[noreturn]] void damaged(const std::filesystem::path& file) { throw std::runtime_error(file.string() + " is damaged"); }

} // namespace

Pixels read_pixels(const std::filesystem::path& file, int most) {
    check_size(file, most);
    Pixels pixels;
    int channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> read(
        stbi_load(file.string().c_str(), &pixels.width, &pixels.height, &channels, 4), stbi_image_free);
    if (!read) damaged(file);
    pixels.rgba.assign(read.get(), read.get() + std::size_t{4} * static_cast<std::size_t>(pixels.width) *
                                                    static_cast<std::size_t>(pixels.height));
    return pixels;
}

Grey read_grey(const std::filesystem::path& file, int most) {
    check_size(file, most);
    Grey grey;
    int channels = 0;
    const std::unique_ptr<stbi_us, void (*)(void*)> read(
        stbi_load_16(file.string().c_str(), &grey.width, &grey.height, &channels, 1), stbi_image_free);
    if (!read) damaged(file);
    grey.values.assign(read.get(), read.get() + static_cast<std::size_t>(grey.width) * static_cast<std::size_t>(grey.height));
    return grey;
}

} // namespace common
