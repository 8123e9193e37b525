// The level's text in a window: changed there, tried, and written back.
#pragma once
#include "session.hpp"

namespace viewer {

class LevelEditor {
  public:
    bool shown = false;
    /// Between ImGui::NewFrame() and ImGui::Render(). `left`: where there is room [pixels].
    void draw(Session& session, float left);

  private:
    std::string of_; // whose text it is
    std::vector<char> text_;
    std::string error_;

    void read(const Session& session);
};

} // namespace viewer
