// Pointer and keys, as ImGui has them, and a gamepad, to the camera and the tools.
#pragma once
#include "gamepad.hpp"
#include "session.hpp"

namespace viewer {

/// After ImGui::NewFrame(). Errors of the plugin become the session's message.
void handle_input(Session& session, Gamepad& gamepad, const Pad& pad, double seconds);

inline constexpr const char* controls_help =
    "left button: tool (look: orbit)   right: orbit   middle: pan   wheel: distance\n"
    "Shift + right: look round   W A S D Q E: fly   Space: pause   .: one step   R: restart\n"
    "Ctrl + Z, Y: undo, redo   F5, F8: save, load   F12: screenshot   F9: record a clip\n"
    "F1: this help   F2: the level's text   Tab: panel   Escape: other levels   1 ... 9, 0, with Shift: tools";

} // namespace viewer
