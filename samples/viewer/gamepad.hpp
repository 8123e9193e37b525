// A gamepad in the place of pointer and keys: the tool acts in the middle of the picture.
#pragma once
#include "session.hpp"

namespace viewer {

/// What is pressed. Axes: -1 ... 1, to the right and up; triggers: 0 ... 1.
struct Pad {
    float left_x = 0, left_y = 0, right_x = 0, right_y = 0;
    float away = 0, closer = 0; // triggers
    bool act = false, undo = false, redo = false, pause = false, last_tool = false, next_tool = false;
};

/// Of the first gamepad that GLFW knows; nothing is pressed where there is none.
Pad read_gamepad();

class Gamepad {
  public:
    /// Of a frame that takes so long. True while it is the pad that points; then the pointer must not.
    bool apply(const Pad& pad, Session& session, double seconds);
    /// The mouse has moved or pressed: it points again.
    void rest() { points_ = false; }

  private:
    Pad before_;
    bool points_ = false;
};

} // namespace viewer
