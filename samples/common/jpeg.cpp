#include "jpeg.hpp"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace common {
namespace {

constexpr int QUALITY = 88; // a seventh of a PNG, and the eye sees no difference

void append(void* file, void* data, int size) {
    static_cast<std::string*>(file)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

} // namespace

std::string encode_jpeg(const std::uint8_t* rgb, int width, int height) {
    std::string file;
    stbi_write_jpg_to_func(append, &file, width, height, 3, rgb, QUALITY);
    return file;
}

} // namespace common
