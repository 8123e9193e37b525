#include "look.hpp"
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <sstream>
#include <stdexcept>

namespace viewer {
namespace {

/// Halton's sequence: samples spread evenly over a pixel.
float halton(int index, int base) {
    float result = 0, share = 1;
    for (; index > 0; index /= base) {
        share /= static_cast<float>(base);
        result += share * static_cast<float>(index % base);
    }
    return result;
}

} // namespace

const std::vector<Quality>& quality_presets() {
    static const std::vector<Quality> presets = {
        {"low", 1, 192, 32, 32, 6, 4, true}, {"medium", 2, 256, 64, 64, 8, 6, true}, {"high", 8, 512, 128, 128, 16, 8, false}};
    return presets;
}

const Quality& quality_preset(const std::string& name) {
    std::string known;
    for (const Quality& quality : quality_presets()) {
        if (quality.name == name) return quality;
        known += " " + quality.name;
    }
    throw std::runtime_error("quality: \"" + name + "\" is none of" + known);
}

const std::vector<View>& views() {
    static const std::vector<View> list = {{"picture", "", 0, 1},       {"depth", "m", 0, 5},   {"speed", "m/s", 0, 6},
                                           {"saturation", "", 0, 0.5f}, {"froude", "", 0, 2},   {"sand", "m", 0, 4},
                                           {"sand-speed", "m/s", 0, 3}, {"foam", "", 0, 1},     {"height", "m", 0, 20},
                                           {"sky", "", 0, 1},           {"slope", "", 0, 1.5f}, {"strain", "", 0, 0.05f},
                                           {"stress", "kPa", 0, 40},    {"active", "", 0, 1},   {"limits", "", 0, 4}};
    return list;
}

int view_number(const std::string& name) {
    std::string known;
    for (std::size_t n = 0; n < views().size(); ++n) {
        if (name == views()[n].name) return static_cast<int>(n);
        known += std::string(" ") + views()[n].name;
    }
    throw std::runtime_error("view: \"" + name + "\" is none of" + known);
}

const std::vector<std::string>& features() {
    static const std::vector<std::string> list = {"foam",     "waves",  "flow-map", "reflection", "refraction", "caustics",
                                                  "mud",      "grain",  "ripples",  "glitter",    "rock",       "shadows",
                                                  "wet-sand", "clouds", "haze",     "wetness"};
    return list;
}

uint32_t feature_bits(const std::string& list) {
    uint32_t bits = 0;
    std::stringstream words(list);
    for (std::string word; std::getline(words, word, ',');) {
        const auto found = std::find(features().begin(), features().end(), word);
        if (found == features().end()) {
            std::string known;
            for (const std::string& name : features()) known += " " + name;
            throw std::runtime_error("feature: \"" + word + "\" is none of" + known);
        }
        bits |= 1u << (found - features().begin());
    }
    return bits;
}

float default_clarity(const Grid& grid) {
    constexpr float landscape = 5, stream = 1.5f; // [m]: the sea that a map's length stands for would hide what its valleys hold
    const float model = 0.02f * std::max(grid.lengths().x, grid.lengths().y);
    return grid.dx >= landscape ? std::min(model, stream) : model;
}

FrameParams frame_params(const Picture& picture, const Grid& grid, int width, int height, int sample) {
    const Camera& camera = picture.camera;
    const Look& look = picture.look;
    const Quality& quality = picture.quality;
    const float tan_up = std::tan(0.5f * camera.field),
                tan_right = tan_up * static_cast<float>(width) / static_cast<float>(height);
    const float azimuth = glm::radians(look.sun_azimuth), elevation = glm::radians(look.sun_elevation);
    const glm::vec3 sun{std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
    const glm::vec2 lengths = grid.lengths();
    const float longest = std::max(lengths.x, lengths.y);
    // Low suns are redder.
    const float low_sun = 1.0f - glm::smoothstep(0.0f, 0.6f, sun.z);

    FrameParams p{};
    p.eye = glm::vec4(camera.eye(), look.land && picture.view == 0 ? 1.0f : 0.0f);
    p.right = glm::vec4(camera.right() * tan_right, 0);
    p.up = glm::vec4(camera.up() * tan_up, 0);
    p.forward = glm::vec4(camera.forward() - camera.right() * (tan_right * picture.shift), 0);
    p.sun = glm::vec4(sun, look.sun_softness);
    p.sunlight = glm::vec4(glm::mix(glm::vec3(2.60f, 2.35f, 2.00f), glm::vec3(2.6f, 1.6f, 0.85f), low_sun), look.exposure);
    p.zenith = glm::vec4(0.20f, 0.36f, 0.72f, look.ambient);
    p.horizon = glm::vec4(0.62f, 0.76f, 0.94f, picture.time);
    p.plinth = glm::vec4(0.335f, 0.315f, 0.285f, grid.block.low.z);
    p.domain = glm::vec4(grid.dx, lengths.x, lengths.y, static_cast<float>(quality.octaves));
    const bool one = quality.samples == 1;
    p.lens = glm::vec4(one ? 0.0f : halton(sample + 1, 2) - 0.5f, one ? 0.0f : halton(sample + 1, 3) - 0.5f,
                       1.0f / static_cast<float>(sample + 1), 2 * tan_up / static_cast<float>(height));
    p.water = glm::vec4(glm::vec3(2.6f, 1.1f, 0.9f) / look.clarity, std::max(0.004f * grid.dx, 1e-4f));
    p.water_glow = glm::vec4(look.water_glow, look.ripples);
    p.sand_dry = glm::vec4(look.sand_dry, look.glitter);
    p.sand_wet = glm::vec4(look.sand_wet, look.rim);
    p.rock = glm::vec4(look.rock, 0.15f * grid.dx);
    p.range = glm::vec4(picture.low, picture.high, longest / 40, longest / 160);
    p.section = picture.section.ends;
    p.grid = glm::ivec4(grid.nx, grid.ny, 0, 0);
    p.image = glm::ivec4(width, height, sample, 0);
    p.march_steps = glm::ivec4(quality.primary_steps, quality.reflection_steps, quality.refraction_steps, quality.sky_sectors);
    p.view = glm::ivec4(picture.view, picture.arrows ? 1 : 0, picture.section.shown ? 1 : 0, quality.smooth_edges ? 1 : 0);
    p.features = glm::ivec4(static_cast<int>(look.features), grid.foam_drifts ? 1 : 0, 0, 0);
    return p;
}

} // namespace viewer
