#include "image.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace recorder {
namespace {

// Tables, because pow() per channel and pixel would dominate a frame's time. 4096 entries for encoding: neighbours differ by
// at most one 8-bit step.
std::array<float, 256> make_decode_table() {
    std::array<float, 256> table{};
    for (std::size_t k = 0; k < table.size(); ++k) {
        const float s = static_cast<float>(k) / 255.0f;
        table[k] = s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
    }
    return table;
}

float decode_channel(std::uint8_t value) {
    static const std::array<float, 256> table = make_decode_table();
    return table[value];
}

constexpr int ENCODE_ENTRIES = 4096;
std::array<std::uint8_t, ENCODE_ENTRIES> make_encode_table() {
    std::array<std::uint8_t, ENCODE_ENTRIES> table{};
    for (int k = 0; k < ENCODE_ENTRIES; ++k) {
        const float x = static_cast<float>(k) / static_cast<float>(ENCODE_ENTRIES - 1);
        const float s = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
        table[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(std::lround(255.0f * s));
    }
    return table;
}

std::uint8_t encode_channel(float x) {
    static const std::array<std::uint8_t, ENCODE_ENTRIES> table = make_encode_table();
    const float clipped = x > 0.0f ? std::min(x, 1.0f) : 0.0f; // NaN becomes 0
    return table[static_cast<std::size_t>(std::lround(clipped * static_cast<float>(ENCODE_ENTRIES - 1)))];
}

} // namespace

Rgb8 encode_srgb(Linear colour) { return {encode_channel(colour.r), encode_channel(colour.g), encode_channel(colour.b)}; }

Linear decode_srgb(Rgb8 colour) { return {decode_channel(colour.r), decode_channel(colour.g), decode_channel(colour.b)}; }

Image::Image(int width, int height, Rgb8 colour)
    : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3) {
    fill(0, 0, width, height, colour);
}

std::size_t Image::offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)) * 3;
}

void Image::set(int x, int y, Rgb8 colour) {
    std::uint8_t* pixel = &pixels_[offset(x, y)];
    pixel[0] = colour.r;
    pixel[1] = colour.g;
    pixel[2] = colour.b;
}

Rgb8 Image::get(int x, int y) const {
    const std::uint8_t* pixel = &pixels_[offset(x, y)];
    return {pixel[0], pixel[1], pixel[2]};
}

void Image::fill(int x, int y, int width, int height, Rgb8 colour) {
    const int x_end = std::min(x + width, width_), y_end = std::min(y + height, height_);
    for (int row = std::max(y, 0); row < y_end; ++row) {
        for (int column = std::max(x, 0); column < x_end; ++column) set(column, row, colour);
    }
}

void Image::paste(const Image& source, int x, int y) {
    const int x_end = std::min(x + source.width(), width_), y_end = std::min(y + source.height(), height_);
    for (int row = std::max(y, 0); row < y_end; ++row) {
        for (int column = std::max(x, 0); column < x_end; ++column) set(column, row, source.get(column - x, row - y));
    }
}

Image Image::reduced(int factor) const {
    Image result(std::max(width_ / factor, 1), std::max(height_ / factor, 1));
    for (int y = 0; y < result.height(); ++y) {
        for (int x = 0; x < result.width(); ++x) {
            Linear sum;
            int count = 0;
            for (int row = y * factor; row < std::min((y + 1) * factor, height_); ++row) {
                for (int column = x * factor; column < std::min((x + 1) * factor, width_); ++column, ++count) {
                    sum = sum + decode_srgb(get(column, row));
                }
            }
            result.set(x, y, encode_srgb(sum * (1.0f / static_cast<float>(count))));
        }
    }
    return result;
}

} // namespace recorder
