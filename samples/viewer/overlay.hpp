// Drawn over the picture: what the tool would change, a scale bar, help.
#pragma once
#include "session.hpp"

namespace viewer {

class Overlay {
  public:
    /// Between ImGui::NewFrame() and ImGui::Render().
    void draw(Session& session);
    bool shows_help = false;

  private:
    std::vector<wadi_query_result> heights_; // of the outline's points
    std::vector<glm::vec2> outline_, asked_;
    uint64_t ticket_ = 0;
    wadi_world_id world_{};

    void follow_ground(Session& session, const Footprint& footprint);
    void draw_footprint(Session& session);
};

} // namespace viewer
