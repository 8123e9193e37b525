// Where the eye is. Orbit: round a target; fly: the target follows the eye.
#pragma once
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace viewer {

struct Camera {
    glm::vec3 target{0}; // [m]
    float yaw = 0;       // direction of view, from north to east [radians]
    float pitch = -0.6f; // below the horizon is negative [radians]
    float distance = 10; // from target to eye [m]
    float field = 0.70f; // angle of view, upright [radians]

    glm::vec3 forward() const;
    glm::vec3 right() const;
    glm::vec3 up() const;
    glm::vec3 eye() const { return target - forward() * distance; }

    void orbit(float yaw_change, float pitch_change);
    void look(float yaw_change, float pitch_change); // turns the head: the eye stays
    void pan(float along_right, float along_up);     // in units of the distance
    void zoom(float factor);
    void fly(glm::vec3 right_forward_up); // moves eye and target [m]
};

/// The block that is looked at, from corner to corner [m].
struct Block {
    glm::vec3 low{0}, high{1};
};

const std::vector<std::string>& camera_presets();
/// A preset, or "YAW,PITCH,SHARE,EAST,NORTH": where to look, from north to east and above the horizon [degrees]; the share of the
/// block that fills the picture; what of it is in the middle, 0 ... 1 from west to east and from south to north.
/// Throws std::runtime_error naming presets or ranges. `aspect`: width of the picture over its height.
Camera camera_preset(const std::string& name, const Block& block, float aspect);

} // namespace viewer
