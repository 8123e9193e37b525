#include "camera.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <stdexcept>

namespace viewer {
namespace {

constexpr float STEEPEST = 1.553f; // just short of straight down, where the image's axes would be undefined

struct Preset {
    const char* name;
    float yaw_degrees, pitch_degrees;
    float share;       // of the block that fills the picture
    float east, north; // target within the block, 0 ... 1
};
// Yaw 0 looks north.
const Preset presets[] = {
    {"overview", -30, -38, 1.0f, 0.5f, 0.5f}, {"opposite", 150, -38, 1.0f, 0.5f, 0.5f}, {"top", 0, -89, 1.0f, 0.5f, 0.5f},
    {"close", -15, -42, 0.45f, 0.5f, 0.55f},  {"low", -30, -14, 0.6f, 0.5f, 0.5f},
};

/// Moves the eye until the share of the block round the target fills the picture.
void fit(Camera& camera, const Block& block, float share, float aspect) {
    const float tan_up = std::tan(0.5f * camera.field), tan_right = tan_up * aspect;
    const glm::vec3 middle = share == 1.0f ? 0.5f * (block.low + block.high) : camera.target;
    camera.target = middle;
    camera.distance = 2 * glm::length(block.high - block.low);
    for (int turn = 0; turn < 12; ++turn) {
        glm::vec2 low{1e9f}, high{-1e9f};
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 half = 0.5f * share * (block.high - block.low);
            const glm::vec3 place =
                middle + half * glm::vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1) - camera.eye();
            const float depth = std::max(glm::dot(place, camera.forward()), 1e-3f);
            const glm::vec2 seen{glm::dot(place, camera.right()) / (depth * tan_right),
                                 glm::dot(place, camera.up()) / (depth * tan_up)};
            low = glm::min(low, seen);
            high = glm::max(high, seen);
        }
        const glm::vec2 off = 0.5f * (low + high);
        camera.target += (camera.right() * (off.x * tan_right) + camera.up() * (off.y * tan_up)) * camera.distance;
        const glm::vec2 half_size = 0.5f * (high - low);
        camera.distance *= std::clamp(std::max(half_size.x, half_size.y) / 0.93f, 0.6f, 1.6f);
    }
}

Camera placed(const Preset& preset, const Block& block, float aspect) {
    Camera camera;
    camera.yaw = glm::radians(preset.yaw_degrees);
    camera.pitch = glm::radians(preset.pitch_degrees);
    camera.target = glm::mix(block.low, block.high, glm::vec3(preset.east, preset.north, 0.35f));
    fit(camera, block, preset.share, aspect);
    return camera;
}

} // namespace

glm::vec3 Camera::forward() const { return {std::sin(yaw) * std::cos(pitch), std::cos(yaw) * std::cos(pitch), std::sin(pitch)}; }
glm::vec3 Camera::right() const { return {std::cos(yaw), -std::sin(yaw), 0}; }
glm::vec3 Camera::up() const { return glm::cross(right(), forward()); }

void Camera::orbit(float yaw_change, float pitch_change) {
    yaw += yaw_change;
    pitch = std::clamp(pitch + pitch_change, -STEEPEST, -0.02f);
}

void Camera::look(float yaw_change, float pitch_change) {
    const glm::vec3 from = eye();
    yaw += yaw_change;
    pitch = std::clamp(pitch + pitch_change, -STEEPEST, STEEPEST);
    target = from + forward() * distance;
}

void Camera::pan(float along_right, float along_up) {
    const glm::vec3 ahead{std::sin(yaw), std::cos(yaw), 0};
    target += (right() * along_right + ahead * along_up) * distance;
}

void Camera::zoom(float factor) { distance = std::clamp(distance * factor, 0.01f, 1e6f); }

void Camera::fly(glm::vec3 move) { target += right() * move.x + forward() * move.y + glm::vec3(0, 0, move.z); }

const std::vector<std::string>& camera_presets() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const Preset& preset : presets) list.emplace_back(preset.name);
        return list;
    }();
    return names;
}

Camera camera_preset(const std::string& name, const Block& block, float aspect) {
    for (const Preset& preset : presets) {
        if (name == preset.name) return placed(preset, block, aspect);
    }
    Preset own{};
    char rest = 0;
    if (std::sscanf(name.c_str(), "%f,%f,%f,%f,%f%c", &own.yaw_degrees, &own.pitch_degrees, &own.share, &own.east, &own.north,
                    &rest) == 5) {
        // Written so that NaN is refused.
        if (!(own.pitch_degrees >= -89 && own.pitch_degrees <= -1 && own.share >= 0.01f && own.share <= 2 &&
              std::abs(own.yaw_degrees) <= 360 && std::abs(own.east - 0.5f) <= 1.5f && std::abs(own.north - 0.5f) <= 1.5f))
            throw std::runtime_error("camera: \"" + name +
                                     "\": allowed are yaw -360 ... 360, pitch -89 ... -1 degrees, share 0.01 ... 2, "
                                     "east and north -1 ... 2");
        return placed(own, block, aspect);
    }
    std::string message = "camera: \"" + name + "\" is none of";
    for (const std::string& known : camera_presets()) message += " " + known;
    throw std::runtime_error(message + ", nor five numbers YAW,PITCH,SHARE,EAST,NORTH");
}

} // namespace viewer
