// The panel: what runs, what it costs, what can be changed.
#pragma once
#include "level_editor.hpp"
#include <array>

namespace viewer {

class Panel {
  public:
    /// Between ImGui::NewFrame() and ImGui::Render(). Errors of the plugin become the session's message.
    void draw(Session& session, LevelEditor& editor, double frame_seconds);
    static constexpr float WIDTH = 330; // [pixels]

  private:
    float frame_milliseconds_ = 0;
    std::string replay_;
    std::array<char, 256> stamp_file_{};
    wadi_world_stats stats_{};
    double stats_age_ = 1e9; // [s]

    void simulation(Session& session, LevelEditor& editor);
    static void limits(const wadi_frame& frame);
    void budget(Session& session);
    void tools(Session& session);
    void springs(Session& session);
    void quality(Session& session);
    void costs(Session& session);
    void material(Session& session);
    void effects(Session& session);
    void ledger(Session& session, double seconds);
    void time_travel(Session& session);
    void profile(const Session& session);
};

} // namespace viewer
