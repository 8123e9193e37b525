#include "start_screen.hpp"
#include "../common/read_picture.hpp"
#include "picture_file.hpp"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <imgui.h>

namespace viewer {
namespace {

constexpr int CARD_WIDTH = 320, CARD_HEIGHT = 180, MOST_SIDE = 4096; // [pixels]
constexpr float GAP = 12, TEXT_LINES = 3;

/// $XDG_CACHE_HOME, or .cache in the user's home; empty where there is neither.
std::filesystem::path cached_picture(const std::filesystem::path& level_file) {
    const char* cache = std::getenv("XDG_CACHE_HOME");
    const char* home = std::getenv("HOME");
    std::filesystem::path folder;
    if (cache != nullptr && *cache != 0) {
        folder = cache;
    } else if (home != nullptr && *home != 0) {
        folder = std::filesystem::path(home) / ".cache";
    } else {
        return {};
    }
    const std::size_t place = std::hash<std::string>()(std::filesystem::absolute(level_file).lexically_normal().string());
    return folder / "wadi" / "pictures" / (std::to_string(place) + ".png");
}

std::filesystem::path picture_beside(const std::filesystem::path& level_file) { return level_file.parent_path() / "picture.jpg"; }

/// The mean of the pixels that each of the card's covers; what is too high or too wide is cut off.
std::vector<uint8_t> shrunk(const common::Pixels& from) {
    const float scale = std::min(static_cast<float>(from.width) / CARD_WIDTH, static_cast<float>(from.height) / CARD_HEIGHT);
    const float left = 0.5f * (static_cast<float>(from.width) - scale * CARD_WIDTH),
                top = 0.5f * (static_cast<float>(from.height) - scale * CARD_HEIGHT);
    std::vector<uint8_t> to;
    const auto range = [&](float start, int n, int end) {
        const int first = std::clamp(static_cast<int>(start + scale * static_cast<float>(n)), 0, end - 1);
        return std::pair(first, std::clamp(static_cast<int>(start + scale * static_cast<float>(n + 1)), first + 1, end));
    };
    for (int y = 0; y < CARD_HEIGHT; ++y) {
        for (int x = 0; x < CARD_WIDTH; ++x) {
            const auto [x0, x1] = range(left, x, from.width);
            const auto [y0, y1] = range(top, y, from.height);
            for (int channel = 0; channel < 4; ++channel) {
                int sum = 0;
                for (int j = y0; j < y1; ++j) {
                    for (int i = x0; i < x1; ++i) sum += from.rgba[static_cast<std::size_t>(4 * (j * from.width + i) + channel)];
                }
                to.push_back(static_cast<uint8_t>(sum / ((x1 - x0) * (y1 - y0))));
            }
        }
    }
    return to;
}

Image read_card(const Gpu& gpu, const std::filesystem::path& level_file) {
    std::filesystem::path file = picture_beside(level_file);
    if (!std::filesystem::exists(file)) file = cached_picture(level_file);
    if (file.empty() || !std::filesystem::exists(file)) return {};
    const std::vector<uint8_t> pixels = shrunk(common::read_pixels(file, MOST_SIDE));
    Image image(gpu, CARD_WIDTH, CARD_HEIGHT, VK_FORMAT_R8G8B8A8_UNORM,
                VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    const Buffer staging(gpu, pixels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, true);
    std::copy(pixels.begin(), pixels.end(), static_cast<uint8_t*>(staging.mapped));
    gpu.run_once([&](VkCommandBuffer commands) {
        VkBufferImageCopy copy{};
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.imageExtent = {CARD_WIDTH, CARD_HEIGHT, 1};
        vkCmdCopyBufferToImage(commands, staging.handle, image.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
    });
    return image;
}

} // namespace

StartScreen::StartScreen(const Gpu& gpu) {
    for (common::LevelEntry& level : common::list_levels()) {
        Card card{std::move(level), {}};
        try {
            card.picture = read_card(gpu, card.level.file);
        } catch (const std::exception& error) {
            message = error.what(); // the level is there without its picture
        }
        cards_.push_back(std::move(card));
    }
    if (cards_.empty()) message = "no levels: set WADI_LEVELS to a folder of levels";
}

std::optional<common::LevelEntry> StartScreen::draw() {
    std::optional<common::LevelEntry> chosen;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float line = ImGui::GetTextLineHeightWithSpacing(), top = 2.5f * line;
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(size);
    ImGui::Begin("Start", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoMove);
    ImGui::TextWrapped("%s", message.empty() ? "Wadi: choose a level. Escape brings you back here, F1 shows the keys."
                                             : message.c_str());
    // As few columns as let all cards fit.
    const int count = std::max(static_cast<int>(cards_.size()), 1);
    int columns = 1;
    float width = 0, height = 0;
    for (;; ++columns) {
        width = (size.x - GAP) / static_cast<float>(columns) - GAP;
        height = width * CARD_HEIGHT / CARD_WIDTH;
        const auto rows = static_cast<float>((count + columns - 1) / columns);
        if (top + rows * (height + TEXT_LINES * line + GAP) <= size.y || columns == count) break;
    }
    placed_.clear();
    for (int n = 0; n < static_cast<int>(cards_.size()); ++n) {
        const Card& card = cards_[static_cast<std::size_t>(n)];
        const ImVec2 at(GAP + static_cast<float>(n % columns) * (width + GAP),
                        top + static_cast<float>(n / columns) * (height + TEXT_LINES * line + GAP));
        ImGui::SetCursorPos(at);
        if (ImGui::InvisibleButton(card.level.name.c_str(), ImVec2(width, height + TEXT_LINES * line))) chosen = card.level;
        const bool hovered = ImGui::IsItemHovered();
        if (card.picture.handle != VK_NULL_HANDLE)
            placed_.push_back({&card.picture, static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(width),
                               static_cast<int>(height)});
        ImDrawList* list = ImGui::GetWindowDrawList();
        list->AddRect(at, ImVec2(at.x + width, at.y + height), hovered ? IM_COL32(255, 215, 90, 255) : IM_COL32(90, 90, 90, 255),
                      0, 0, hovered ? 3.0f : 1.0f);
        list->AddText(ImVec2(at.x, at.y + height + 2), IM_COL32_WHITE, card.level.name.c_str());
        ImGui::PushClipRect(at, ImVec2(at.x + width, at.y + height + TEXT_LINES * line), true);
        list->AddText(ImGui::GetFont(), ImGui::GetFontSize(), ImVec2(at.x, at.y + height + 2 + line),
                      IM_COL32(190, 190, 190, 255), card.level.description.c_str(), nullptr, width);
        ImGui::PopClipRect();
    }
    ImGui::End();
    return chosen;
}

void StartScreen::keep_picture(const std::filesystem::path& level_file, Renderer& renderer) {
    const std::filesystem::path file = cached_picture(level_file);
    if (file.empty() || std::filesystem::exists(picture_beside(level_file))) return;
    std::filesystem::create_directories(file.parent_path());
    write_picture(file, renderer.read_picture(), renderer.width(), renderer.height());
}

} // namespace viewer
