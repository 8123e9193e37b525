// The tools as a row of buttons with pictures.
#pragma once
#include "tools.hpp"

namespace viewer {

/// In the window that ImGui is in, with a sentence about the chosen one below.
void draw_tool_bar(Tool& chosen);

} // namespace viewer
