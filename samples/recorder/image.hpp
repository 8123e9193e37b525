// An 8-bit sRGB image, row 0 at the top, and the few operations that frames need.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace recorder {

struct Rgb8 {
    std::uint8_t r = 0, g = 0, b = 0;
};

/// Linear light, 0 ... 1 (more is clipped when encoded).
struct Linear {
    float r = 0, g = 0, b = 0;
};
inline Linear operator+(Linear a, Linear b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
inline Linear operator*(Linear a, float s) { return {a.r * s, a.g * s, a.b * s}; }
inline Linear mix(Linear a, Linear b, float t) { return a * (1.0f - t) + b * t; }

/// sRGB transfer function, IEC 61966-2-1.
Rgb8 encode_srgb(Linear colour);
Linear decode_srgb(Rgb8 colour);

class Image {
  public:
    Image() = default;
    Image(int width, int height, Rgb8 colour = {});

    int width() const { return width_; }
    int height() const { return height_; }
    const std::uint8_t* data() const { return pixels_.data(); }

    void set(int x, int y, Rgb8 colour);
    Rgb8 get(int x, int y) const;
    /// Fills a rectangle; what falls outside is cut off.
    void fill(int x, int y, int width, int height, Rgb8 colour);
    /// Copies `source` with its top left corner to (x, y); what falls outside is cut off.
    void paste(const Image& source, int x, int y);
    /// Mean over factor x factor blocks, in linear light.
    Image reduced(int factor) const;

  private:
    std::size_t offset(int x, int y) const;
    int width_ = 0, height_ = 0;
    std::vector<std::uint8_t> pixels_;
};

} // namespace recorder
