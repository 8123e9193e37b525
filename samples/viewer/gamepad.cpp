#include "gamepad.hpp"
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace viewer {
namespace {

constexpr float DEAD = 0.15f;     // share of a stick's way that is not meant
constexpr float TURN_RATE = 2.0f; // [radians per second]

float meant(float axis) {
    const float size = std::max(std::fabs(axis) - DEAD, 0.0f) / (1 - DEAD);
    return std::copysign(size * size, axis); // finer in the middle
}

} // namespace

Pad read_gamepad() {
    for (int joystick = GLFW_JOYSTICK_1; joystick <= GLFW_JOYSTICK_LAST; ++joystick) {
        GLFWgamepadstate is;
        if (glfwJoystickIsGamepad(joystick) == GLFW_FALSE || glfwGetGamepadState(joystick, &is) == GLFW_FALSE) continue;
        const auto down = [&](int button) { return is.buttons[button] == GLFW_PRESS; };
        Pad pad;
        pad.left_x = is.axes[GLFW_GAMEPAD_AXIS_LEFT_X];
        pad.left_y = -is.axes[GLFW_GAMEPAD_AXIS_LEFT_Y]; // GLFW counts down
        pad.right_x = is.axes[GLFW_GAMEPAD_AXIS_RIGHT_X];
        pad.right_y = -is.axes[GLFW_GAMEPAD_AXIS_RIGHT_Y];
        pad.away = 0.5f * (is.axes[GLFW_GAMEPAD_AXIS_LEFT_TRIGGER] + 1); // -1 where it is not pressed
        pad.closer = 0.5f * (is.axes[GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER] + 1);
        pad.act = down(GLFW_GAMEPAD_BUTTON_A);
        pad.undo = down(GLFW_GAMEPAD_BUTTON_B);
        pad.redo = down(GLFW_GAMEPAD_BUTTON_Y);
        pad.pause = down(GLFW_GAMEPAD_BUTTON_START);
        pad.last_tool = down(GLFW_GAMEPAD_BUTTON_LEFT_BUMPER);
        pad.next_tool = down(GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER);
        return pad;
    }
    return {};
}

bool Gamepad::apply(const Pad& pad, Session& session, double seconds) {
    const float time = static_cast<float>(seconds);
    const glm::vec3 move{meant(pad.left_x), meant(pad.left_y), 0};
    const float turn = meant(pad.right_x), tilt = meant(pad.right_y), away = meant(pad.away) - meant(pad.closer);
    const auto pressed = [&](bool Pad::*button) { return pad.*button && !(before_.*button); };
    const bool steps = pressed(&Pad::last_tool) || pressed(&Pad::next_tool);
    points_ = points_ || pad.act || steps || move != glm::vec3{0} || turn != 0 || tilt != 0 || away != 0;

    Camera& camera = session.picture.camera;
    camera.fly(move * (camera.distance * 0.6f * time));
    camera.orbit(TURN_RATE * turn * time, TURN_RATE * tilt * time);
    camera.zoom(std::exp(away * time));
    if (steps) {
        const int count = static_cast<int>(std::size(tool_names)), by = pad.next_tool ? 1 : count - 1;
        session.tools.tool = static_cast<Tool>((static_cast<int>(session.tools.tool) + by) % count);
    }
    if (pressed(&Pad::pause)) session.paused = !session.paused;
    if (pressed(&Pad::undo)) session.undo();
    if (pressed(&Pad::redo)) session.redo();
    before_ = pad;
    return points_;
}

} // namespace viewer
