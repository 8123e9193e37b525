#include "frame.hpp"
#include "font.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace recorder {
namespace {

constexpr Rgb8 BACKGROUND = {24, 27, 31}, TEXT = {236, 238, 240}, DIM_TEXT = {168, 174, 180}, FRAME_LINE = {70, 76, 84};
constexpr int MARGIN = 12, SCALE = 2, LEAST_WIDTH = 700;
constexpr int CAPTION_HEIGHT = 2 * MARGIN + text_height(SCALE);
constexpr int SWATCH_HEIGHT = 18;
constexpr int LEGEND_HEIGHT = 2 * MARGIN + text_height(SCALE) + 8 + SWATCH_HEIGHT + 8 + text_height(SCALE);
constexpr int TILE_SIDE = 400; // longest side of a contact sheet's tile [pixels]

template <typename... Values> std::string format(const char* pattern, Values... values) {
    char text[160];
    std::snprintf(text, sizeof text, pattern, values...);
    return text;
}

void draw_right(Image& image, int right, int y, const std::string& text, Rgb8 colour) {
    draw_text(image, right - text_width(text, SCALE), y, text, colour, SCALE);
}

void draw_caption(Image& image, const Caption& caption, const std::string& time) {
    const std::string grid = format("%d x %d cells of %.4g m", caption.nx, caption.ny, caption.dx);
    const int room = image.width() - 4 * MARGIN - text_width(time, SCALE) - text_width(grid, SCALE);
    const std::size_t characters = static_cast<std::size_t>(std::max(room / (6 * SCALE) - 2, 4));
    draw_text(image, MARGIN, MARGIN, caption.level.substr(0, characters), TEXT, SCALE);
    const int name_end = MARGIN + text_width(caption.level.substr(0, characters), SCALE);
    const int grid_start = image.width() - MARGIN - text_width(grid, SCALE);
    draw_text(image, (name_end + grid_start - text_width(time, SCALE)) / 2, MARGIN, time, TEXT, SCALE);
    draw_right(image, image.width() - MARGIN, MARGIN, grid, DIM_TEXT);
}

/// One key: title, a bar whose colour is `colour_at(0 ... 1)`, and numbers under its ends and middle.
template <typename ColourAt>
void draw_key(Image& image, int x, int y, int width, const char* title, const std::string (&numbers)[3], ColourAt colour_at) {
    draw_text(image, x, y, title, TEXT, SCALE);
    y += text_height(SCALE) + 8;
    image.fill(x - 1, y - 1, width + 2, SWATCH_HEIGHT + 2, FRAME_LINE);
    for (int column = 0; column < width; ++column) {
        const float fraction = static_cast<float>(column) / static_cast<float>(width - 1);
        image.fill(x + column, y, 1, SWATCH_HEIGHT, encode_srgb(colour_at(fraction)));
    }
    y += SWATCH_HEIGHT + 8;
    draw_text(image, x, y, numbers[0], DIM_TEXT, SCALE);
    draw_text(image, x + (width - text_width(numbers[1], SCALE)) / 2, y, numbers[1], DIM_TEXT, SCALE);
    draw_right(image, x + width, y, numbers[2], DIM_TEXT);
}

/// A round length that fits `room` pixels.
double bar_length(double metres_per_pixel, int room) {
    const double longest = metres_per_pixel * room;
    const double power = std::pow(10.0, std::floor(std::log10(longest)));
    for (const double factor : {5.0, 2.0}) {
        if (factor * power <= longest) return factor * power;
    }
    return power;
}

void draw_legend(Image& image, int y, const Look& look, bool square, double metres_per_pixel) {
    image.fill(0, y, image.width(), LEGEND_HEIGHT, BACKGROUND);
    y += MARGIN;
    const int gap = 28, width = std::min((image.width() - 2 * MARGIN - 3 * gap) / 4, 320);
    int x = MARGIN;
    const auto metres = [](double value) { return format("%.3g", value); };
    const double low = static_cast<double>(look.low), high = static_cast<double>(look.high);
    // Both ends of the terrain's range to a tenth of it.
    const int decimals = high > low ? std::clamp(1 - static_cast<int>(std::floor(std::log10(high - low))), 0, 6) : 0;
    const auto height = [&](double value) { return format("%.*f", decimals, value); };
    if (high > low) {
        draw_key(image, x, y, width, "ground [m]", {height(low), "", height(high)}, [](float t) { return terrain_colour(t); });
    } else {
        draw_key(image, x, y, width, "ground [m]", {"", metres(low), ""}, [](float) { return terrain_colour(0.5f); });
    }
    x += width + gap;
    draw_key(image, x, y, width, "sand dry-wet", {"0", "0.25", "0.5"}, [](float t) { return sand_colour(0.5f * t); });
    x += width + gap;
    // The key's axis is the square root of depth, as the colours are; a quarter of the scale lies in the middle.
    const double scale = static_cast<double>(look.water_scale);
    const Linear bed = terrain_colour(0.5f);
    draw_key(image, x, y, width, "water [m]", {"0", metres(scale / 4), metres(scale)},
             [&](float t) { return under_water(bed, t * t * look.water_scale, look.water_scale, 1.0f); });
    x += width + gap;

    const double length = bar_length(metres_per_pixel, width);
    const int pixels = static_cast<int>(std::lround(length / metres_per_pixel));
    const int bar_y = y + text_height(SCALE) + 8 + SWATCH_HEIGHT / 2;
    draw_text(image, x, y, square ? "scale, N up" : "scale of x", TEXT, SCALE);
    image.fill(x, bar_y, pixels, 3, TEXT);
    image.fill(x, bar_y - 6, 3, 15, TEXT);
    image.fill(x + pixels - 3, bar_y - 6, 3, 15, TEXT);
    draw_text(image, x, y + text_height(SCALE) + 16 + SWATCH_HEIGHT, format("%g m", length), DIM_TEXT, SCALE);
}

} // namespace

std::string format_time(double seconds) { return format("t = %.2f s", seconds); }

Image compose_frame(const Image& map, const Look& look, const Caption& caption, double time, double metres_per_pixel) {
    Image frame(std::max(map.width(), LEAST_WIDTH), CAPTION_HEIGHT + map.height() + LEGEND_HEIGHT, BACKGROUND);
    draw_caption(frame, caption, format_time(time));
    frame.paste(map, (frame.width() - map.width()) / 2, CAPTION_HEIGHT);
    draw_legend(frame, CAPTION_HEIGHT + map.height(), look, caption.square, metres_per_pixel);
    return frame;
}

ContactSheet::ContactSheet(std::size_t frame_count) : frame_count_(std::max<std::size_t>(frame_count, 1)) {}

void ContactSheet::add(const Image& map, double time, bool last) {
    if (tiles_.empty()) factor_ = (std::max(map.width(), map.height()) + TILE_SIDE - 1) / TILE_SIDE;
    const std::size_t tiles = std::min<std::size_t>(frame_count_, MOST_TILES);
    // Frame number of the next evenly spaced tile.
    const std::size_t next = tiles < 2 ? 0 : (tiles_.size() * (frame_count_ - 1) + (tiles - 1) / 2) / (tiles - 1);
    if (added_ >= next || last) tiles_.push_back({map.reduced(factor_), time});
    ++added_;
}

Image ContactSheet::compose(const Look& look, const Caption& caption, double metres_per_pixel) const {
    constexpr int gap = 8, label = text_height(SCALE) + 10;
    const int count = static_cast<int>(tiles_.size());
    const int tile_width = tiles_.front().map.width(), tile_height = tiles_.front().map.height();
    // The number of columns whose sheet is nearest to 3:2.
    int columns = 1;
    double best = 1e30;
    for (int c = 1; c <= count; ++c) {
        const int rows = (count + c - 1) / c;
        const double aspect = static_cast<double>(c * (tile_width + gap)) / static_cast<double>(rows * (tile_height + label));
        const double misfit = std::abs(std::log(aspect / 1.5)) + 0.15 * (c * rows - count);
        if (misfit < best) {
            best = misfit;
            columns = c;
        }
    }
    const int rows = (count + columns - 1) / columns;
    const int width = std::max(columns * (tile_width + gap) + gap, LEAST_WIDTH);
    Image sheet(width, CAPTION_HEIGHT + rows * (tile_height + label) + LEGEND_HEIGHT, BACKGROUND);
    draw_caption(sheet, caption, format("%.4g s to %.4g s", tiles_.front().time, tiles_.back().time));
    const int left = (width - columns * (tile_width + gap) + gap) / 2;
    for (int k = 0; k < count; ++k) {
        const Tile& tile = tiles_[static_cast<std::size_t>(k)];
        const int x = left + (k % columns) * (tile_width + gap);
        const int y = CAPTION_HEIGHT + (k / columns) * (tile_height + label);
        draw_text(sheet, x, y, format_time(tile.time), TEXT, SCALE);
        sheet.paste(tile.map, x, y + text_height(SCALE) + 4);
    }
    draw_legend(sheet, CAPTION_HEIGHT + rows * (tile_height + label), look, caption.square, metres_per_pixel * factor_);
    return sheet;
}

} // namespace recorder
