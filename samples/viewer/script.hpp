// Input from a file instead of a person: what happens at which frame. One line each: FRAME COMMAND [WORDS]; # begins a comment.
#pragma once
#include "gamepad.hpp"
#include "session.hpp"
#include <filesystem>
#include <map>
#include <vector>

namespace viewer {

class Script {
  public:
    Script() = default;
    /// Throws std::runtime_error naming line and command.
    explicit Script(const std::filesystem::path& file);

    /// Between Gui::begin_frame() and ImGui::NewFrame(): pointer, buttons, wheel and keys into ImGui's IO.
    void apply_input(uint64_t frame);
    /// The gamepad: what the newest line "pad" up to this frame says.
    Pad pad(uint64_t frame) const;
    /// Before the session advances: everything else. What changes the window is left to the caller.
    void apply_commands(uint64_t frame, Session& session) const;

    struct Line {
        std::string command;
        std::vector<std::string> words;
    };
    /// The lines of a frame whose command is this one.
    std::vector<Line> lines(uint64_t frame, const std::string& command) const;
    bool empty() const { return frames_.empty(); }

  private:
    std::map<uint64_t, std::vector<Line>> frames_;
    float x_ = -1, y_ = -1;
    bool down_[3] = {};
};

} // namespace viewer
