// samples/common/png and jpeg: files that another decoder reads to the same pixels, or to ones that look the same.
#include "samples/common/jpeg.hpp"
#include "samples/common/png.hpp"
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <vector>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace {

using Pixels = std::vector<std::uint8_t>;

Pixels decoded(const std::string& file, int width, int height) {
    int nx = 0, ny = 0, channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(file.data()),
                                                                                 static_cast<int>(file.size()), &nx, &ny,
                                                                                 &channels, 0),
                                                           stbi_image_free);
    REQUIRE_MESSAGE(pixels, stbi_failure_reason());
    CHECK(nx == width);
    CHECK(ny == height);
    CHECK(channels == 3);
    return {pixels.get(), pixels.get() + static_cast<std::size_t>(nx * ny * channels)};
}

std::string contents(const std::string& path) {
    std::ifstream stream(WADI_SOURCE_DIR + path, std::ios::binary);
    return {(std::istreambuf_iterator<char>(stream)), {}};
}

double mean_difference(const Pixels& one, const Pixels& other) {
    double sum = 0;
    for (std::size_t k = 0; k < one.size(); ++k) sum += std::abs(int{one[k]} - int{other[k]});
    return sum / static_cast<double>(one.size());
}

} // namespace

TEST_CASE("png: what stb_image reads is what was written") {
    std::mt19937 random(5);
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 40}, {37, 1}, {64, 64}, {333, 257}}) {
        Pixels noise(static_cast<std::size_t>(3 * width * height)), smooth(noise.size()), flat(noise.size(), 200);
        for (std::size_t k = 0; k < noise.size(); ++k) {
            noise[k] = static_cast<std::uint8_t>(random());
            smooth[k] = static_cast<std::uint8_t>(k / 7 + k % 3 * 40); // wraps: differences to the row above, too
        }
        for (const Pixels& pixels : {noise, smooth, flat}) {
            const std::string file = common::encode_png(pixels.data(), width, height);
            CHECK(decoded(file, width, height) == pixels);
        }
        // Negative control: a pixel of another colour is seen.
        Pixels other = smooth;
        other.back() ^= 1;
        CHECK(decoded(common::encode_png(other.data(), width, height), width, height) != smooth);
    }
    const Pixels flat(3 * 500 * 500, 7);
    CHECK(common::encode_png(flat.data(), 500, 500).size() < 10000); // and it is compressed
}

TEST_CASE("png: real pictures, smaller than by stb_image_write with the same filter; tells both times") {
    stbi_write_force_png_filter = 2;
    const auto timed = [](const auto& work) {
        const auto start = std::chrono::steady_clock::now();
        work();
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    };
    for (const std::string name : {"godot/project/picture.png", "viewer/images/beach.png"}) {
        const std::string stored = contents("/tests/" + name);
        int width = 0, height = 0, channels = 0, length = 0;
        REQUIRE(stbi_info_from_memory(reinterpret_cast<const stbi_uc*>(stored.data()), static_cast<int>(stored.size()), &width,
                                      &height, &channels) == 1);
        const Pixels pixels = decoded(stored, width, height);
        std::string file;
        const double ours = timed([&] { file = common::encode_png(pixels.data(), width, height); });
        unsigned char* other = nullptr;
        const double theirs = timed([&] { other = stbi_write_png_to_mem(pixels.data(), 3 * width, width, height, 3, &length); });
        stbi_image_free(other);
        MESSAGE(name << ", " << width << " x " << height << ": " << file.size() << " bytes in " << ours
                     << " ms; by stb_image_write " << length << " bytes in " << theirs << " ms");
        CHECK(decoded(file, width, height) == pixels);
        CHECK(file.size() < static_cast<std::size_t>(length));
    }
}

TEST_CASE("jpeg: a real picture looks the same in a quarter of a PNG's bytes or less") {
    const std::string stored = contents("/tests/godot/project/picture.png");
    int width = 0, height = 0, channels = 0;
    REQUIRE(stbi_info_from_memory(reinterpret_cast<const stbi_uc*>(stored.data()), static_cast<int>(stored.size()), &width,
                                  &height, &channels) == 1);
    const Pixels pixels = decoded(stored, width, height);
    const std::string file = common::encode_jpeg(pixels.data(), width, height);
    CHECK(file.size() < stored.size() / 4);
    const Pixels read = decoded(file, width, height);
    CHECK(mean_difference(read, pixels) < 3);
    Pixels turned(pixels.rbegin(), pixels.rend()); // negative control
    CHECK(mean_difference(read, turned) > 10);
}
