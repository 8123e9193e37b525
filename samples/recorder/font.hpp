// A 5x7 bitmap font for captions: printable ASCII, nothing else.
#pragma once
#include "image.hpp"
#include <string_view>

namespace recorder {

/// Pixel width of `text` at `scale` screen pixels per font pixel; glyphs advance by 6 font pixels.
int text_width(std::string_view text, int scale);
/// Pixel height of a line of text at `scale`, without the two font pixels that g, p, q and y hang below it.
constexpr int text_height(int scale) { return 7 * scale; }

/// Draws one line with its top left corner at (x, y); what falls outside the image is cut off, a character without a
/// glyph is drawn as '?'.
void draw_text(Image& image, int x, int y, std::string_view text, Rgb8 colour, int scale);

} // namespace recorder
