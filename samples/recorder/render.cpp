#include "render.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace recorder {
namespace {

// Towards the sun: north-west, 40 degrees above the horizon.
const glm::vec3 SUN(-0.5417f, 0.5417f, 0.6428f);
constexpr float AMBIENT = 0.34f;        // share of sky light on level ground
constexpr float STEEPEST_SHADED = 1.6f; // slopes are compressed towards this, so that cliffs keep some shape
constexpr float WATER_GAIN = 5.0f;      // waves are slight: their slopes are exaggerated by this
constexpr float STEEPEST_WAVE = 0.9f;

using Slope = glm::vec2; // rise per run, east and north

Slope compressed(Slope slope, float gain, float steepest) {
    const Slope s = slope * gain;
    return s / std::sqrt(1.0f + glm::dot(s, s) / (steepest * steepest));
}

glm::vec3 normal_of(Slope slope) { return glm::normalize(glm::vec3(-slope, 1.0f)); }

/// Sun light on a slope relative to level ground: 1 when level, 0 in its own shadow.
float sun_on(Slope slope) { return std::max(glm::dot(normal_of(slope), SUN) / SUN.z, 0.0f); }

/// Blinn's highlight, seen from straight above.
float glint_on(Slope slope) {
    static const glm::vec3 half = glm::normalize(SUN + glm::vec3(0, 0, 1));
    return std::pow(std::max(glm::dot(normal_of(slope), half), 0.0f), 60.0f);
}

/// Per cell, what is interpolated to pixels. Ratios are interpolated as their two parts (saturation: mixed and sand; depth at
/// a shore: water and wet), so that an edge of sand does not look dry and water against a wall does not look shallow.
struct Cell {
    float height = 0, sand = 0, mixed = 0, water = 0; // H, hs, water within the sand, water above it [m]
    float sandy = 0, wet = 0;                         // 1 where there is sand or water; the outline is where 0.5 is crossed
    Slope ground{0}, surface{0};
    float openness = 1; // 1 on open ground, less in hollows
};

Cell blend(const Cell& a, const Cell& b, float t) {
    const auto lerp = [t](auto p, auto q) { return glm::mix(p, q, t); };
    return {lerp(a.height, b.height), lerp(a.sand, b.sand),       lerp(a.mixed, b.mixed),
            lerp(a.water, b.water),   lerp(a.sandy, b.sandy),     lerp(a.wet, b.wet),
            lerp(a.ground, b.ground), lerp(a.surface, b.surface), lerp(a.openness, b.openness)};
}

std::size_t at(int nx, int i, int j) {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i);
}

/// Running mean of width 2 radius + 1 along one axis; edges repeat.
void box_blur(std::vector<float>& values, int nx, int ny, int radius, bool along_x) {
    const int length = along_x ? nx : ny, lines = along_x ? ny : nx;
    std::vector<float> line(static_cast<std::size_t>(length));
    for (int l = 0; l < lines; ++l) {
        const auto index = [&](int k) {
            const int c = std::clamp(k, 0, length - 1);
            return along_x ? at(nx, c, l) : at(nx, l, c);
        };
        double sum = 0;
        for (int k = -radius; k <= radius; ++k) sum += static_cast<double>(values[index(k)]);
        for (int k = 0; k < length; ++k) {
            line[static_cast<std::size_t>(k)] = static_cast<float>(sum / (2 * radius + 1));
            sum += static_cast<double>(values[index(k + radius + 1)]) - static_cast<double>(values[index(k - radius)]);
        }
        for (int k = 0; k < length; ++k) values[index(k)] = line[static_cast<std::size_t>(k)];
    }
}

/// Sky light by depth below the surroundings' mean height: darkens canyons and the feet of walls.
std::vector<float> sky_openness(const std::vector<float>& ground, const MapFields& fields, float gain) {
    const int radius = std::clamp(std::max(fields.nx, fields.ny) / 50, 1, 24);
    std::vector<float> mean = ground;
    for (int pass = 0; pass < 2; ++pass) {
        box_blur(mean, fields.nx, fields.ny, radius, true);
        box_blur(mean, fields.nx, fields.ny, radius, false);
    }
    const float per_metre = gain / (static_cast<float>(fields.dx) * static_cast<float>(2 * radius));
    for (std::size_t k = 0; k < mean.size(); ++k) {
        const float below = (mean[k] - ground[k]) * per_metre;
        mean[k] = std::clamp(1.0f - 1.6f * below, 0.45f, 1.18f);
    }
    return mean;
}

/// Rain lies on all of a map: what lies on half of it hides the ground and the streams, and is not drawn [m].
float hidden_film(const MapFields& fields, const Look& look) {
    if (look.wet_from_start) return 0;
    std::vector<float> depths = fields.water;
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    return std::min(2 * *middle, 0.04f * look.water_scale);
}

std::vector<Cell> make_cells(const MapFields& fields, const Look& look) {
    const int nx = fields.nx, ny = fields.ny;
    const float dx = static_cast<float>(fields.dx);
    std::vector<float> ground(fields.terrain.size());
    for (std::size_t k = 0; k < ground.size(); ++k) ground[k] = fields.terrain[k] + fields.sand[k];
    const std::vector<float> openness = sky_openness(ground, fields, look.relief_gain);
    const float hidden = hidden_film(fields, look);
    const float film = 0.002f * look.water_scale, sand_threshold = 0.01f * dx;

    std::vector<Cell> cells(ground.size());
    for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) {
            const std::size_t k = at(nx, i, j);
            const int west = std::max(i - 1, 0), east = std::min(i + 1, nx - 1);
            const int south = std::max(j - 1, 0), north = std::min(j + 1, ny - 1);
            const float spacing_x = dx * static_cast<float>(std::max(east - west, 1));
            const float spacing_y = dx * static_cast<float>(std::max(north - south, 1));
            Cell& cell = cells[k];
            cell.height = fields.terrain[k];
            cell.sand = fields.sand[k];
            const float phi = fields.saturation[k];
            cell.mixed = phi < 0.5f ? cell.sand * phi / (1.0f - phi) : cell.sand;
            cell.water = std::max(fields.water[k] - hidden, 0.0f);
            cell.sandy = glm::smoothstep(0.25f * sand_threshold, sand_threshold, cell.sand);
            cell.wet = glm::smoothstep(0.0f, film, cell.water);
            cell.openness = openness[k];
            cell.ground = {(ground[at(nx, east, j)] - ground[at(nx, west, j)]) / spacing_x,
                           (ground[at(nx, i, north)] - ground[at(nx, i, south)]) / spacing_y};
            // Across a shore the free surface is not smooth: only wet neighbours count.
            const float level = ground[k] + fields.water[k];
            const auto level_at = [&](std::size_t n) {
                return fields.water[n] > film + hidden ? ground[n] + fields.water[n] : level;
            };
            cell.surface = {(level_at(at(nx, east, j)) - level_at(at(nx, west, j))) / spacing_x,
                            (level_at(at(nx, i, north)) - level_at(at(nx, i, south))) / spacing_y};
        }
    }
    return cells;
}

/// `blur`: half-width of outlines in units of a cell.
Linear shade(const Cell& cell, const Look& look, float blur) {
    const Slope ground_slope = compressed(cell.ground, look.relief_gain, STEEPEST_SHADED);
    const float light = AMBIENT * cell.openness + (1.0f - AMBIENT) * sun_on(ground_slope) * std::min(cell.openness + 0.15f, 1.1f);
    const float wet = glm::smoothstep(0.5f - blur, 0.5f + blur, cell.wet),
                sandy = glm::smoothstep(0.5f - blur, 0.5f + blur, cell.sandy);
    const float depth = cell.wet > 0 ? cell.water / cell.wet : 0.0f;

    Linear ground = terrain_colour(look.high > look.low ? (cell.height - look.low) / (look.high - look.low) : 0.5f);
    // A wet film darkens rock without covering it.
    ground = ground * (1.0f - 0.35f * wet * glm::smoothstep(0.0f, 0.01f * look.water_scale, depth));
    if (sandy > 0) ground = mix(ground, sand_colour(cell.mixed / std::max(cell.mixed + cell.sand, 1e-20f)), sandy);
    ground = ground * light;
    if (wet <= 0) return ground;

    const Slope wave = compressed(cell.surface, WATER_GAIN, STEEPEST_WAVE);
    const Linear water = under_water(ground, depth, look.water_scale, 0.3f + 0.7f * sun_on(wave));
    const float body = glm::smoothstep(0.01f, 0.08f, depth / look.water_scale);
    const float glint = std::max(glint_on(wave) - glint_on({0, 0}), 0.0f);
    return mix(ground, water + Linear{0.85f, 0.95f, 1.0f} * (0.4f * body * glint), wet);
}

double round_up_125(double value) {
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (value <= factor * power * 1.0001) return factor * power;
    }
    return 10 * power;
}

} // namespace

MapFields reduced(const MapFields& fields, int factor) {
    if (factor == 1) return fields;
    MapFields result;
    result.nx = (fields.nx + factor - 1) / factor;
    result.ny = (fields.ny + factor - 1) / factor;
    result.dx = fields.dx * factor;
    const auto average = [&](const std::vector<float>& values) {
        std::vector<float> means(static_cast<std::size_t>(result.nx) * static_cast<std::size_t>(result.ny));
        for (int j = 0; j < result.ny; ++j) {
            for (int i = 0; i < result.nx; ++i) {
                double sum = 0;
                int count = 0;
                for (int y = j * factor; y < std::min((j + 1) * factor, fields.ny); ++y) {
                    for (int x = i * factor; x < std::min((i + 1) * factor, fields.nx); ++x, ++count) {
                        sum += static_cast<double>(values[at(fields.nx, x, y)]);
                    }
                }
                means[at(result.nx, i, j)] = static_cast<float>(sum / count);
            }
        }
        return means;
    };
    result.terrain = average(fields.terrain);
    result.sand = average(fields.sand);
    result.water = average(fields.water);
    result.saturation = average(fields.saturation);
    return result;
}

Look choose_look(const MapFields& fields, double water_scale) {
    Look look;
    std::vector<float> slopes;
    float low_ground = fields.terrain.front(), high_ground = low_ground, deepest = 0;
    look.low = look.high = fields.terrain.front();
    for (int j = 0; j < fields.ny; ++j) {
        for (int i = 0; i < fields.nx; ++i) {
            const std::size_t k = at(fields.nx, i, j);
            const float ground = fields.terrain[k] + fields.sand[k];
            look.low = std::min(look.low, fields.terrain[k]);
            look.high = std::max(look.high, fields.terrain[k]);
            low_ground = std::min(low_ground, ground);
            high_ground = std::max(high_ground, ground);
            deepest = std::max(deepest, fields.water[k]);
            if (i == 0 || j == 0) continue;
            const std::size_t w = at(fields.nx, i - 1, j), s = at(fields.nx, i, j - 1);
            const float slope =
                std::hypot(ground - fields.terrain[w] - fields.sand[w], ground - fields.terrain[s] - fields.sand[s]);
            if (slope > 0) slopes.push_back(slope / static_cast<float>(fields.dx));
        }
    }
    if (!slopes.empty()) {
        const auto ninth_decile = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() * 9 / 10);
        std::nth_element(slopes.begin(), ninth_decile, slopes.end());
        look.relief_gain = std::clamp(0.8f / *ninth_decile, 1.0f, 20.0f);
    }
    const double relief = static_cast<double>(high_ground - low_ground);
    double scale = std::max(static_cast<double>(deepest), 0.2 * relief);
    if (scale <= 0) scale = fields.dx;
    look.water_scale = static_cast<float>(water_scale > 0 ? water_scale : round_up_125(scale));
    look.wet_from_start = deepest > 0;
    return look;
}

bool scale_to_water(const MapFields& fields, double water_scale, Look& look) {
    std::vector<float> depths;
    for (const float depth : fields.water)
        if (depth > 0) depths.push_back(depth);
    if (depths.empty()) return false;
    if (water_scale > 0 || look.wet_from_start) return true;
    // Of the deepest hundredth, which is where streams gather out of a film; they are to grow.
    const auto place = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() - 1 - depths.size() / 100);
    std::nth_element(depths.begin(), place, depths.end());
    look.water_scale = static_cast<float>(round_up_125(3 * static_cast<double>(*place)));
    return true;
}

Scaling choose_scaling(int nx, int ny) {
    constexpr int most_cells = 1600, least_long = 800, least_wide = 48; // [cells], [pixels], [pixels]
    const auto divided_up = [](int a, int b) { return (a + b - 1) / b; };
    Scaling scaling;
    scaling.reduce = divided_up(std::max(nx, ny), most_cells);
    const int columns = divided_up(nx, scaling.reduce), rows = divided_up(ny, scaling.reduce);
    const int enlarge = divided_up(least_long, std::max(columns, rows));
    scaling.enlarge_x = std::max(enlarge, divided_up(least_wide, columns));
    scaling.enlarge_y = std::max(enlarge, divided_up(least_wide, rows));
    return scaling;
}

Linear terrain_colour(float fraction) {
    static const Linear low = decode_srgb({98, 106, 106}), high = decode_srgb({188, 185, 178});
    return mix(low, high, std::clamp(fraction, 0.0f, 1.0f));
}

Linear sand_colour(float saturation) {
    static const Linear dry = decode_srgb({233, 196, 126}), damp = decode_srgb({158, 106, 54}), full = decode_srgb({94, 58, 30});
    if (saturation < 0.25f) return mix(dry, damp, std::max(saturation, 0.0f) / 0.25f);
    return mix(damp, full, std::min((saturation - 0.25f) / 0.25f, 1.0f));
}

Linear under_water(Linear ground, float depth, float water_scale, float light) {
    struct Stop {
        float root; // square root of depth / water_scale: shallow water gets most of the colours
        float cover;
        Linear colour;
    };
    static const std::array<Stop, 6> stops = {{{0.0f, 0.0f, decode_srgb({150, 225, 215})},
                                               {0.12f, 0.35f, decode_srgb({125, 215, 208})},
                                               {0.32f, 0.72f, decode_srgb({62, 170, 196})},
                                               {0.65f, 0.93f, decode_srgb({30, 108, 180})},
                                               {1.0f, 0.98f, decode_srgb({14, 56, 132})},
                                               {1.4f, 1.0f, decode_srgb({8, 30, 84})}}};
    const float root = std::sqrt(std::max(depth, 0.0f) / water_scale);
    std::size_t upper = 1;
    while (upper + 1 < stops.size() && root > stops[upper].root) ++upper;
    const Stop &a = stops[upper - 1], &b = stops[upper];
    const float t = std::clamp((root - a.root) / (b.root - a.root), 0.0f, 1.0f);
    const float film = glm::smoothstep(0.0f, 0.004f, depth / water_scale);
    return mix(ground, mix(a.colour, b.colour, t) * light, film * (a.cover + (b.cover - a.cover) * t));
}

Image render_map(const MapFields& fields, const Look& look, const Scaling& scaling) {
    const std::vector<Cell> cells = make_cells(fields, look);
    const float blur = std::clamp(1.0f / static_cast<float>(std::min(scaling.enlarge_x, scaling.enlarge_y)), 0.1f, 0.5f);
    Image image(fields.nx * scaling.enlarge_x, fields.ny * scaling.enlarge_y);
    const float step_x = 1.0f / static_cast<float>(scaling.enlarge_x), step_y = 1.0f / static_cast<float>(scaling.enlarge_y);
    for (int y = 0; y < image.height(); ++y) {
        const float row = std::clamp(static_cast<float>(fields.ny) - 0.5f - (static_cast<float>(y) + 0.5f) * step_y, 0.0f,
                                     static_cast<float>(fields.ny - 1));
        const int j = static_cast<int>(row), j_next = std::min(j + 1, fields.ny - 1);
        for (int x = 0; x < image.width(); ++x) {
            const float column =
                std::clamp((static_cast<float>(x) + 0.5f) * step_x - 0.5f, 0.0f, static_cast<float>(fields.nx - 1));
            const int i = static_cast<int>(column), i_next = std::min(i + 1, fields.nx - 1);
            const float tx = column - static_cast<float>(i), ty = row - static_cast<float>(j);
            const Cell south = blend(cells[at(fields.nx, i, j)], cells[at(fields.nx, i_next, j)], tx);
            const Cell north = blend(cells[at(fields.nx, i, j_next)], cells[at(fields.nx, i_next, j_next)], tx);
            image.set(x, y, encode_srgb(shade(blend(south, north, ty), look, blur)));
        }
    }
    return image;
}

} // namespace recorder
