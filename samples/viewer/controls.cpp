#include "controls.hpp"
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <cmath>
#include <imgui.h>

namespace viewer {
namespace {

constexpr float TURN = 0.006f; // [radians per pixel]

void move_camera(Session& session, double seconds, bool over_panel) {
    const ImGuiIO& io = ImGui::GetIO();
    Camera& camera = session.picture.camera;
    if (!over_panel) {
        const bool turns = ImGui::IsMouseDown(ImGuiMouseButton_Right) ||
                           (session.tools.tool == Tool::look && ImGui::IsMouseDown(ImGuiMouseButton_Left));
        if (turns && io.KeyShift)
            camera.look(TURN * io.MouseDelta.x, -TURN * io.MouseDelta.y);
        else if (turns)
            camera.orbit(TURN * io.MouseDelta.x, -TURN * io.MouseDelta.y);
        if (ImGui::IsMouseDown(ImGuiMouseButton_Middle)) {
            const float share = 2 * std::tan(0.5f * camera.field) / io.DisplaySize.y;
            camera.pan(-share * io.MouseDelta.x, share * io.MouseDelta.y);
        }
        if (io.MouseWheel != 0) camera.zoom(std::pow(0.9f, io.MouseWheel));
    }
    if (io.WantTextInput) return;
    const auto down = [](int plus, int minus) {
        return static_cast<float>(ImGui::IsKeyDown(plus)) - static_cast<float>(ImGui::IsKeyDown(minus));
    };
    const glm::vec3 move{down(GLFW_KEY_D, GLFW_KEY_A), down(GLFW_KEY_W, GLFW_KEY_S), down(GLFW_KEY_E, GLFW_KEY_Q)};
    camera.fly(move * (camera.distance * 0.6f * static_cast<float>(seconds)));
}

void press_keys(Session& session) {
    if (ImGui::IsKeyPressed(GLFW_KEY_SPACE, false)) session.paused = !session.paused;
    if (ImGui::IsKeyPressed(GLFW_KEY_PERIOD)) {
        session.paused = true;
        session.single_step();
    }
    if (ImGui::IsKeyPressed(GLFW_KEY_R, false)) session.restart();
    if (ImGui::GetIO().KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_Z, true))
        ImGui::GetIO().KeyShift ? session.redo() : session.undo();
    if (ImGui::GetIO().KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_Y, true)) session.redo();
    if (ImGui::IsKeyPressed(GLFW_KEY_F5, false)) session.save();
    if (ImGui::IsKeyPressed(GLFW_KEY_F8, false)) session.load();
    if (ImGui::IsKeyPressed(GLFW_KEY_F12, false)) session.screenshot();
    if (ImGui::IsKeyPressed(GLFW_KEY_F9, false)) session.set_recording(!session.recording());
    const std::size_t behind = ImGui::GetIO().KeyShift ? 10 : 0;
    for (std::size_t n = 0; n < 10 && n + behind < std::size(tool_names); ++n) {
        if (ImGui::IsKeyPressed(n == 9 ? GLFW_KEY_0 : GLFW_KEY_1 + static_cast<int>(n), false))
            session.tools.tool = static_cast<Tool>(n + behind);
    }
}

} // namespace

void handle_input(Session& session, Gamepad& gamepad, const Pad& pad, double seconds) {
    const ImGuiIO& io = ImGui::GetIO();
    move_camera(session, seconds, io.WantCaptureMouse);
    try {
        if (io.MouseDelta.x != 0 || io.MouseDelta.y != 0 || ImGui::IsAnyMouseDown()) gamepad.rest();
        if (!ImGui::IsAnyMouseDown() && !pad.act) session.history().close(); // what one press did is undone as one
        if (!io.WantTextInput) press_keys(session);
        if (gamepad.apply(pad, session, seconds)) {
            session.point(static_cast<uint32_t>(io.DisplaySize.x / 2), static_cast<uint32_t>(io.DisplaySize.y / 2), pad.act);
            return;
        }
        const bool inside = ImGui::IsMousePosValid() && io.MousePos.x >= 0 && io.MousePos.y >= 0 &&
                            io.MousePos.x < io.DisplaySize.x && io.MousePos.y < io.DisplaySize.y;
        if (inside && !io.WantCaptureMouse) {
            session.point(static_cast<uint32_t>(io.MousePos.x), static_cast<uint32_t>(io.MousePos.y),
                          ImGui::IsMouseDown(ImGuiMouseButton_Left));
        } else {
            session.point_away();
        }
    } catch (const std::exception& error) {
        session.message = error.what();
    }
}

} // namespace viewer
