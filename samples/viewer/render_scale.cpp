#include "render_scale.hpp"
#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

constexpr int LOOKS = 4;           // pictures between two changes
constexpr float GRAIN = 1 / 16.0f; // of the scale: each change shows

} // namespace

void RenderScale::follow(double frame, double pixels) {
    if (target <= 0) {
        value_ = 1;
        return;
    }
    frame_ += frame;
    pixels_ += std::min(pixels, frame);
    if (++counted_ < LOOKS) return;
    // Pixels cost the square of the scale, the rest of the frame stays.
    const double beside = (frame_ - pixels_) / LOOKS, of_pixels = std::max(pixels_ / LOOKS, 1e-6);
    const double room = std::max(target - beside, 0.0);
    const auto wanted = static_cast<float>(static_cast<double>(value_) * std::sqrt(room / of_pixels));
    float next = std::clamp(std::floor(std::min(wanted, 2.0f) / GRAIN) * GRAIN, LEAST, 1.0f);
    // Up only where that leaves room: a scale that is just too large would be taken back at once.
    if (next > value_ && next < 1 && wanted < value_ + 2 * GRAIN) next = value_;
    value_ = next;
    frame_ = pixels_ = 0;
    counted_ = 0;
}

} // namespace viewer
