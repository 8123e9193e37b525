// samples/recorder/png: files that another decoder reads to the same pixels.
#include "samples/recorder/png.hpp"
#include <cstddef>
#include <doctest/doctest.h>
#include <memory>
#include <random>
#include <vector>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
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
            const std::string file = recorder::encode_png(pixels.data(), width, height);
            CHECK(decoded(file, width, height) == pixels);
        }
        // Negative control: a pixel of another colour is seen.
        Pixels other = smooth;
        other.back() ^= 1;
        CHECK(decoded(recorder::encode_png(other.data(), width, height), width, height) != smooth);
    }
    const Pixels flat(3 * 500 * 500, 7);
    CHECK(recorder::encode_png(flat.data(), 500, 500).size() < 10000); // and it is compressed
}
