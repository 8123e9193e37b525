#include "../common/files.hpp"
#include "../common/png.hpp"
#include "level.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace import_map {
namespace {

using Colour = std::array<double, 3>;

/// From lowlands to peaks.
Colour tint(double share) {
    static const std::array<Colour, 5> stops = {
        {{106, 142, 96}, {170, 178, 118}, {206, 186, 136}, {168, 132, 104}, {240, 238, 234}}};
    const double at = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(at), stops.size() - 2);
    Colour colour{};
    for (std::size_t n = 0; n < colour.size(); ++n)
        colour[n] = stops[low][n] + (at - static_cast<double>(low)) * (stops[low + 1][n] - stops[low][n]);
    return colour;
}

/// Light from the north-west on the ground at a cell, 1 on level ground. `gain`: slopes are drawn so many times as steep.
double light_at(const Ground& ground, int i, int j, double gain) {
    const auto height = [&](int x, int y) {
        const auto cell = static_cast<std::size_t>(std::clamp(y, 0, ground.ny - 1)) * static_cast<std::size_t>(ground.nx) +
                          static_cast<std::size_t>(std::clamp(x, 0, ground.nx - 1));
        return static_cast<double>(ground.heights[cell]);
    };
    const double east = gain * (height(i + 1, j) - height(i - 1, j)) / (2 * ground.dx),
                 north = gain * (height(i, j + 1) - height(i, j - 1)) / (2 * ground.dx);
    return std::max(0.0, (east - north) * 0.54 + 0.64) / (0.64 * std::sqrt(1 + east * east + north * north));
}

/// Such that most slopes show.
double gain_of(const Ground& ground) {
    std::vector<double> slopes;
    for (std::size_t n = 1; n < ground.heights.size(); n += 1 + ground.heights.size() / 65536)
        if (ground.heights[n] != ground.heights[n - 1])
            slopes.push_back(std::fabs(static_cast<double>(ground.heights[n]) - static_cast<double>(ground.heights[n - 1])) /
                             ground.dx);
    if (slopes.empty()) return 1;
    const auto at = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() * 9 / 10);
    std::nth_element(slopes.begin(), at, slopes.end());
    return std::clamp(0.5 / *at, 0.05, 50.0);
}

} // namespace

void write_preview(const Request& request, const std::string& file, const Ground& ground) {
    // Holes are where it matters what they are filled with.
    const Ground filled = ground_of(request, file, ground, "filled"), pits = ground_of(request, file, ground, "pit");
    constexpr int largest = 1600, smallest = 600; // pixels of the longer side
    const int longer = std::max(ground.nx, ground.ny), reduce = (longer + largest - 1) / largest,
              enlarge = (smallest + longer - 1) / longer;
    const int width = ground.nx / reduce * enlarge, height = ground.ny / reduce * enlarge;
    const auto [low, high] = std::minmax_element(filled.heights.begin(), filled.heights.end());
    const double least = static_cast<double>(*low), relief = std::max(static_cast<double>(*high) - least, 1e-9);
    const double gain = gain_of(filled);
    std::string pixels;
    for (int y = height; y-- > 0;)
        for (int x = 0; x < width; ++x) {
            const int i = x / enlarge * reduce, j = y / enlarge * reduce;
            const auto cell = static_cast<std::size_t>(j) * static_cast<std::size_t>(ground.nx) + static_cast<std::size_t>(i);
            const bool hole = pits.heights[cell] != filled.heights[cell];
            const Colour colour = hole ? Colour{214, 48, 72} : tint((static_cast<double>(filled.heights[cell]) - least) / relief);
            const double light = 0.35 + 0.65 * light_at(filled, i, j, gain);
            for (const double part : colour)
                pixels += static_cast<char>(static_cast<unsigned char>(std::min(part * light, 255.0)));
        }
    const auto png = common::encode_png(reinterpret_cast<const unsigned char*>(pixels.data()), width, height);
    if (const std::string error = common::write_file(request.folder / "preview.png", png); !error.empty()) fail(error);
}

} // namespace import_map
