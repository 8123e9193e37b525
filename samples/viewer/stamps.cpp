#include "stamps.hpp"
#include "../common/read_picture.hpp"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace viewer {
namespace {

constexpr int DRAWN_SIZE = 128, MOST_PIXELS = 1024;

// x, y from -1 to 1.
float castle(float x, float y) {
    const float across = std::max(std::abs(x), std::abs(y)), along = std::min(std::abs(x), std::abs(y));
    float height = across < 0.9f ? 0.12f : 0.0f;                                            // the mound
    if (across > 0.56f && across < 0.7f) height = 0.5f;                                     // walls
    if (across > 0.64f && across < 0.7f && std::fmod(along, 0.14f) < 0.07f) height = 0.58f; // and their battlements
    if (std::abs(x) < 0.1f && y < -0.5f && y > -0.75f) height = 0.12f;                      // the gate, in the south
    if (std::hypot(std::abs(x) - 0.63f, std::abs(y) - 0.63f) < 0.17f) height = 0.75f;
    if (std::max(std::abs(x), std::abs(y)) < 0.26f) height = 0.8f; // the keep
    if (std::hypot(x, y) < 0.13f) height = 1.0f;
    return height;
}

float drawn(const std::string& name, float x, float y) {
    const float radius = std::hypot(x, y);
    if (name == "castle") return castle(x, y);
    if (name == "cone") return std::max(1 - radius, 0.0f);
    if (name == "ring") return std::max(1 - std::abs(radius - 0.75f) / 0.25f, 0.0f);
    return std::max(radius < 0.7f ? radius * radius / 0.49f : 1 - (radius - 0.7f) / 0.3f, 0.0f); // crater
}

StampImage read_picture_file(const std::string& file) {
    const common::Grey grey = common::read_grey(file, MOST_PIXELS);
    StampImage image{grey.width, grey.height, {}};
    for (int j = grey.height - 1; j >= 0; --j) {
        for (int i = 0; i < grey.width; ++i)
            image.values.push_back(static_cast<float>(grey.values[static_cast<std::size_t>(j * grey.width + i)]) / 65535.0f);
    }
    return image;
}

} // namespace

double StampImage::mean(glm::vec2 low, glm::vec2 high) const {
    const auto inside = [](int n, int pixels, float from, float to) {
        const float place = (static_cast<float>(n) + 0.5f) / static_cast<float>(pixels);
        return place > from && place < to;
    };
    double sum = 0;
    for (int j = 0; j < ny; ++j) {
        if (!inside(j, ny, low.y, high.y)) continue;
        for (int i = 0; i < nx; ++i) {
            if (inside(i, nx, low.x, high.x)) sum += static_cast<double>(values[static_cast<std::size_t>(j * nx + i)]);
        }
    }
    return sum / static_cast<double>(values.size());
}

StampImage StampImage::of_cells(int cells) const {
    StampImage to{cells, cells, {}};
    // Pixels from `first` on, and the share of each that lies between two places.
    const auto covered = [&](int n, int pixels, auto&& add) {
        const double low = static_cast<double>(n) * pixels / cells, high = static_cast<double>(n + 1) * pixels / cells;
        for (int k = static_cast<int>(low); k < pixels && k < high; ++k)
            add(k, std::min(high, k + 1.0) - std::max(low, static_cast<double>(k)));
    };
    for (int j = 0; j < cells; ++j) {
        for (int i = 0; i < cells; ++i) {
            double sum = 0, area = 0;
            covered(j, ny, [&](int y, double down) {
                covered(i, nx, [&](int x, double across) {
                    sum += down * across * static_cast<double>(values[static_cast<std::size_t>(y * nx + x)]);
                    area += down * across;
                });
            });
            to.values.push_back(static_cast<float>(sum / area));
        }
    }
    return to;
}

const std::vector<std::string>& built_in_stamps() {
    static const std::vector<std::string> names = {"castle", "cone", "crater", "ring"};
    return names;
}

StampImage stamp_image(const std::string& name_or_file) {
    const std::vector<std::string>& names = built_in_stamps();
    if (std::find(names.begin(), names.end(), name_or_file) == names.end()) {
        if (!std::filesystem::exists(name_or_file))
            throw std::runtime_error("stamp: \"" + name_or_file + "\" is no file and none of castle, cone, crater, ring");
        return read_picture_file(name_or_file);
    }
    StampImage image{DRAWN_SIZE, DRAWN_SIZE, {}};
    for (int j = 0; j < DRAWN_SIZE; ++j) {
        for (int i = 0; i < DRAWN_SIZE; ++i) {
            const auto place = [](int n) { return (2 * static_cast<float>(n) + 1) / static_cast<float>(DRAWN_SIZE) - 1; };
            image.values.push_back(drawn(name_or_file, place(i), place(j)));
        }
    }
    return image;
}

} // namespace viewer
