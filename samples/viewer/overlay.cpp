#include "overlay.hpp"
#include "controls.hpp"
#include <cmath>
#include <glm/geometric.hpp>
#include <imgui.h>

namespace viewer {
namespace {

constexpr int ROUND = 24; // points of half a circle
constexpr ImU32 LINE = IM_COL32(255, 215, 90, 255), GHOST = IM_COL32(255, 215, 90, 150);

/// Where a place of the world is in the picture [pixels]; none behind the eye.
std::optional<ImVec2> on_screen(const Picture& picture, glm::vec3 place) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const glm::vec3 away = place - picture.camera.eye();
    const float depth = glm::dot(away, picture.camera.forward());
    if (depth <= 1e-3f * picture.camera.distance) return std::nullopt;
    const float up = std::tan(0.5f * picture.camera.field), across = up * size.x / size.y;
    const float x = glm::dot(away, picture.camera.right()) / (depth * across) + picture.shift;
    const float y = glm::dot(away, picture.camera.up()) / (depth * up);
    return ImVec2(0.5f * size.x * (1 + x), 0.5f * size.y * (1 - y));
}

/// A closed line round the footprint, corners with points between them.
std::vector<glm::vec2> outline_of(const Footprint& footprint) {
    std::vector<glm::vec2> points;
    if (footprint.shape == Footprint::Shape::square) {
        const glm::vec2 corners[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        for (int side = 0; side < 4; ++side) {
            for (int n = 0; n < ROUND / 2; ++n) {
                const float share = static_cast<float>(n) / (ROUND / 2);
                points.push_back(footprint.from +
                                 footprint.radius * ((1 - share) * corners[side] + share * corners[(side + 1) % 4]));
            }
        }
        return points;
    }
    const glm::vec2 along = footprint.to - footprint.from;
    const float direction = std::atan2(along.y, along.x);
    for (int n = 0; n < 2 * ROUND; ++n) {
        const float angle = direction + 3.14159265f * (static_cast<float>(n) / ROUND - 0.5f);
        points.push_back((n < ROUND ? footprint.to : footprint.from) +
                         footprint.radius * glm::vec2(std::cos(angle), std::sin(angle)));
    }
    return points;
}

void draw_closed_line(const Picture& picture, const std::vector<glm::vec3>& points, ImU32 colour) {
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    std::optional<ImVec2> before = on_screen(picture, points.back());
    for (const glm::vec3& point : points) {
        const std::optional<ImVec2> here = on_screen(picture, point);
        if (before && here) list->AddLine(*before, *here, colour, 1.5f);
        before = here;
    }
}

void draw_text(ImVec2 at, const char* text) {
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    list->AddText(ImVec2(at.x + 1, at.y + 1), IM_COL32(0, 0, 0, 220), text);
    list->AddText(at, IM_COL32_WHITE, text);
}

/// 1, 2 or 5 times a power of ten metres, as long as a fifth of the picture at the distance of what is looked at.
void draw_scale_bar(const Picture& picture) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float metres_per_pixel = 2 * std::tan(0.5f * picture.camera.field) * picture.camera.distance / size.y;
    const float most = 0.2f * size.x * metres_per_pixel;
    const float power = std::pow(10.0f, std::floor(std::log10(most)));
    const float length = (most >= 5 * power ? 5.0f : most >= 2 * power ? 2.0f : 1.0f) * power;
    const float right = size.x - 20, left = right - length / metres_per_pixel, y = size.y - 20;
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    for (const auto& [colour, width] : {std::pair{IM_COL32(0, 0, 0, 220), 4.0f}, std::pair{IM_COL32_WHITE, 2.0f}}) {
        list->AddLine(ImVec2(left, y), ImVec2(right, y), colour, width);
        for (float x : {left, right}) list->AddLine(ImVec2(x, y - 5), ImVec2(x, y + 5), colour, width);
    }
    char text[48];
    if (length >= 1000) {
        std::snprintf(text, sizeof(text), "%g km", static_cast<double>(length) / 1000);
    } else if (length >= 1) {
        std::snprintf(text, sizeof(text), "%g m", static_cast<double>(length));
    } else {
        std::snprintf(text, sizeof(text), "%g cm", static_cast<double>(length) * 100);
    }
    draw_text(ImVec2(left, y - 22), text);
}

void draw_help() {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0.5f * size.x, 0.5f * size.y), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::Begin("Help", nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::TextUnformatted(controls_help);
    ImGui::Separator();
    for (std::size_t n = 0; n < std::size(tool_names); ++n) {
        char key[16];
        std::snprintf(key, sizeof(key), n < 10 ? "%zu" : "Shift %zu", (n % 10 + 1) % 10);
        ImGui::Text("%-8s %-13s %s", key, tool_names[n], tool_help(static_cast<Tool>(n)));
    }
    ImGui::End();
}

} // namespace

// The plugin answers a frame later: what has come is drawn.
void Overlay::follow_ground(Session& session, const Footprint& footprint) {
    const wadi_world_id world = session.simulation().world;
    if (world.index != world_.index || world.generation != world_.generation) {
        world_ = world;
        asked_.clear();
        heights_.clear();
    }
    if (!asked_.empty()) {
        std::vector<wadi_query_result> results(asked_.size());
        uint32_t count = 0;
        const wadi_result result =
            wadi_world_get_query(world, ticket_, results.data(), static_cast<uint32_t>(results.size()), &count, nullptr);
        if (result == WADI_NOT_READY) return;
        check(result, "the ground below the tool");
        heights_ = std::move(results);
        outline_ = std::exchange(asked_, {});
    }
    std::vector<glm::vec2> points = outline_of(footprint);
    const wadi_result result = wadi_world_query(world, &points[0].x, static_cast<uint32_t>(points.size()), &ticket_);
    if (result == WADI_NOT_READY) return;
    check(result, "asking for the ground below the tool");
    asked_ = std::move(points);
}

void Overlay::draw_footprint(Session& session) {
    const Footprint footprint = session.tools.footprint();
    if (footprint.shape == Footprint::Shape::none) return;
    follow_ground(session, footprint);
    std::vector<glm::vec3> ground, top;
    const float lift = 0.2f * session.simulation().grid.dx; // above what bilinear heights of the picture cut off
    for (std::size_t n = 0; n < heights_.size(); ++n) {
        if (!heights_[n].inside) continue;
        ground.emplace_back(outline_[n], heights_[n].surface + lift);
        top.emplace_back(outline_[n], heights_[n].terrain + heights_[n].sand_depth + footprint.height);
    }
    if (ground.empty()) return;
    draw_closed_line(session.picture, ground, LINE);
    if (footprint.height > 0) {
        draw_closed_line(session.picture, top, GHOST);
        for (std::size_t n = 0; n < top.size(); n += ROUND / 4) {
            const auto foot = on_screen(session.picture, ground[n]), head = on_screen(session.picture, top[n]);
            if (foot && head) ImGui::GetBackgroundDrawList()->AddLine(*foot, *head, GHOST, 1.0f);
        }
    }
    const ImVec2 pointer = ImGui::GetIO().MousePos;
    if (ImGui::IsMousePosValid()) draw_text(ImVec2(pointer.x + 14, pointer.y + 10), footprint.numbers.c_str());
}

void Overlay::draw(Session& session) {
    draw_scale_bar(session.picture);
    draw_footprint(session);
    if (shows_help) draw_help();
}

} // namespace viewer
