#include "camera.hpp"
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <stdexcept>

namespace viewer {
namespace {

constexpr float STEEPEST = 1.553f; // just short of straight down, where the image's axes would be undefined

struct Preset {
    const char* name;
    float yaw_degrees, pitch_degrees;
    float share;        // of the block that fills the picture
    float east, north;  // target within the block, 0 ... 1
};
// Yaw 0 looks north.
const Preset presets[] = {
    {"overview", -30, -36, 1.0f, 0.5f, 0.47f}, {"opposite", 150, -36, 1.0f, 0.5f, 0.53f}, {"top", 0, -89, 1.0f, 0.5f, 0.5f},
    {"close", -35, -30, 0.45f, 0.5f, 0.5f},    {"low", -25, -13, 0.5f, 0.5f, 0.45f},
};

} // namespace

glm::vec3 Camera::forward() const {
    return {std::sin(yaw) * std::cos(pitch), std::cos(yaw) * std::cos(pitch), std::sin(pitch)};
}
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
        if (name != preset.name) continue;
        Camera camera;
        camera.yaw = glm::radians(preset.yaw_degrees);
        camera.pitch = glm::radians(preset.pitch_degrees);
        camera.target = glm::mix(block.low, block.high, glm::vec3(preset.east, preset.north, 0.35f));
        // The least distance from which all corners of the wanted share are inside the picture.
        const glm::vec3 middle = 0.5f * (block.low + block.high);
        const float tan_up = std::tan(0.5f * camera.field), tan_right = tan_up * aspect;
        float distance = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 place{corner & 1 ? block.high.x : block.low.x, corner & 2 ? block.high.y : block.low.y,
                                  corner & 4 ? block.high.z : block.low.z};
            const glm::vec3 from_target = preset.share * (place - middle) + (preset.share == 1.0f ? middle - camera.target : glm::vec3(0));
            const float across = std::abs(glm::dot(from_target, camera.right())) / tan_right;
            const float upright = std::abs(glm::dot(from_target, camera.up())) / tan_up;
            distance = std::max(distance, std::max(across, upright) - glm::dot(from_target, camera.forward()));
        }
        camera.distance = 1.04f * distance;
        return camera;
    }
    std::string message = "camera: \"" + name + "\" is none of";
    for (const std::string& known : camera_presets()) message += " " + known;
    throw std::runtime_error(message);
}

} // namespace viewer
