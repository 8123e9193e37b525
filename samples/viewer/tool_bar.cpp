#include "tool_bar.hpp"
#include <array>
#include <cstdlib>
#include <imgui.h>
#include <string>
#include <vector>

namespace viewer {
namespace {

constexpr float SIDE = 34, GAP = 4, RIM = 5; // [pixels]
constexpr int COLUMNS = 8;

constexpr ImU32 VIEW = IM_COL32(225, 225, 225, 255), WATER = IM_COL32(110, 190, 235, 255), SAND = IM_COL32(240, 205, 135, 255),
                GROUND = IM_COL32(200, 170, 150, 255);

/// Lines on 16 x 16, y down: points joined by "-", lines parted by blanks.
struct Icon {
    const char* lines;
    ImU32 colour;
};
constexpr std::array<Icon, std::size(tool_names)> icons = {{
    {"1,8-4,5-8,4-12,5-15,8-12,11-8,12-4,11-1,8 6,8-7,6-9,6-10,8-9,10-7,10-6,8", VIEW},       // look: an eye
    {"8,1-5,6-4,9-5,11-8,12-11,11-12,9-11,6-8,1 2,15-14,15", WATER},                          // pour water: a drop
    {"1,15-8,8-15,15-1,15 8,1-8,3 5,3-5,5 11,3-11,5 8,5-8,6", SAND},                          // pour sand: grains on a heap
    {"1,8-4,8-6,14-10,14-12,8-15,8 8,11-8,2 5,5-8,2-11,5", SAND},                             // dig: out of a hole
    {"1,9-4,4-7,10-10,7-13,9-15,8 1,14-15,14", SAND},                                         // smooth: a wave that ends
    {"1,12-15,12 1,15-15,15 8,2-8,9 5,6-8,9-11,6", SAND},                                     // flatten: down to a line
    {"1,4-15,4-15,14-1,14-1,4 1,9-15,9 8,4-8,9 5,9-5,14 11,9-11,14", SAND},                   // wall: bricks
    {"2,14-2,4-5,4-5,7-7,7-7,4-9,4-9,7-11,7-11,4-14,4-14,14-2,14 7,14-7,11-9,11-9,14", SAND}, // stamp: a castle
    {"1,14-5,14 11,14-15,14 8,14-8,3 5,6-8,3-11,6 4,10-2,8 12,10-14,8", WATER},               // spring: up out of the ground
    {"1,5-5,5 11,5-15,5 8,2-8,13 5,10-8,13-11,10", WATER},                                    // drain: down into it
    {"5,8-14,8 10,4-14,8-10,12 2,3-2,13", VIEW},                                              // push
    {"2,4-4,14-12,14-14,4 3,8-6,9-10,7-13,8", WATER},                                         // scoop water: a cup
    {"1,15-5,10-11,10-15,15 8,8-8,1 5,4-8,1-11,4", GROUND},                                   // raise ground
    {"1,9-4,9-8,14-12,9-15,9 8,1-8,9 5,6-8,9-11,6", GROUND},                                  // lower ground
    {"1,12-4,7-7,9-11,3-15,6 1,15-15,15 1,15-1,1", VIEW},                                     // section: a profile
}};

void draw_icon(const Icon& icon, ImVec2 corner) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    std::vector<ImVec2> line;
    const auto end_line = [&] {
        list->AddPolyline(line.data(), static_cast<int>(line.size()), icon.colour, ImDrawFlags_None, 1.6f);
        line.clear();
    };
    for (const char* at = icon.lines; *at != '\0';) {
        char* after = nullptr;
        const float x = std::strtof(at, &after), y = std::strtof(after + 1, &after); // "x,y"
        line.emplace_back(corner.x + RIM + x * (SIDE - 2 * RIM) / 16, corner.y + RIM + y * (SIDE - 2 * RIM) / 16);
        if (*after == ' ') end_line();
        at = *after == '\0' ? after : after + 1;
    }
    end_line();
}

/// The key that chooses it, see controls.cpp.
std::string key_of(std::size_t tool) {
    const std::string digit = std::to_string((tool + 1) % 10);
    return tool < 10 ? digit : "Shift + " + digit;
}

} // namespace

void draw_tool_bar(Tool& chosen) {
    const ImVec2 start = ImGui::GetCursorScreenPos();
    for (std::size_t n = 0; n < icons.size(); ++n) {
        const auto column = static_cast<float>(n % COLUMNS), row = static_cast<float>(n / COLUMNS);
        const ImVec2 corner(start.x + column * (SIDE + GAP), start.y + row * (SIDE + GAP));
        ImGui::SetCursorScreenPos(corner);
        if (ImGui::InvisibleButton(tool_names[n], ImVec2(SIDE, SIDE))) chosen = static_cast<Tool>(n);
        const bool on = chosen == static_cast<Tool>(n), under = ImGui::IsItemHovered();
        const ImU32 back = ImGui::GetColorU32(on ? ImGuiCol_ButtonActive : under ? ImGuiCol_ButtonHovered : ImGuiCol_FrameBg);
        ImGui::GetWindowDrawList()->AddRectFilled(corner, ImVec2(corner.x + SIDE, corner.y + SIDE), back, 3);
        draw_icon(icons[n], corner);
        if (under) ImGui::SetTooltip("%s (%s): %s", tool_names[n], key_of(n).c_str(), tool_help(static_cast<Tool>(n)));
    }
    const float rows = static_cast<float>((icons.size() + COLUMNS - 1) / COLUMNS);
    ImGui::SetCursorScreenPos(ImVec2(start.x, start.y + rows * (SIDE + GAP)));
    ImGui::TextWrapped("%s: %s", tool_names[static_cast<std::size_t>(chosen)], tool_help(chosen));
}

} // namespace viewer
