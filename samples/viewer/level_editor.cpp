#include "level_editor.hpp"
#include "../common/files.hpp"
#include <imgui.h>

namespace viewer {

constexpr std::size_t ROOM = std::size_t{64} << 10; // for what is typed [bytes]

void LevelEditor::read(const Session& session) {
    const std::string text = session.level_text();
    text_.assign(text.begin(), text.end());
    text_.resize(text.size() + ROOM, 0);
    of_ = session.choice().level_file;
    error_.clear();
}

void LevelEditor::draw(Session& session, float left) {
    if (!shown) return;
    if (of_ != session.choice().level_file) read(session);
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(left + 10, 10), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(ImVec2(0.5f * (size.x - left), size.y - 60), ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Level", &shown)) {
        const auto attempt = [&](auto&& act) {
            try {
                act();
                error_.clear();
            } catch (const std::exception& error) {
                error_ = error.what(); // the world that runs goes on
            }
        };
        if (ImGui::Button("try it")) attempt([&] { session.try_level(text_.data()); });
        ImGui::SameLine();
        if (ImGui::Button("write file")) attempt([&] { session.write_level_text(text_.data()); });
        ImGui::SameLine();
        if (ImGui::Button("read again")) read(session);
        if (!error_.empty()) ImGui::TextWrapped("%s", error_.c_str());
        ImGui::InputTextMultiline("##text", text_.data(), text_.size(), ImVec2(-1, -1), ImGuiInputTextFlags_AllowTabInput);
    }
    ImGui::End();
}

} // namespace viewer
