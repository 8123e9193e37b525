// What the viewer shows without a level: pictures of those that there are, to choose from.
#pragma once
#include "../common/levels.hpp"
#include "renderer.hpp"
#include <optional>

namespace viewer {

class StartScreen {
  public:
    /// Looks for levels and reads their pictures: picture.jpg beside the level, or the one that keep_picture() wrote.
    explicit StartScreen(const Gpu& gpu);

    /// Between ImGui::NewFrame() and ImGui::Render(): titles, and the level that was chosen.
    std::optional<common::LevelEntry> draw();
    /// Where the pictures of the last draw() belong.
    const std::vector<PlacedImage>& pictures() const { return placed_; }
    std::string message; // why the last choice did not open

    /// Keeps a picture of a level that has none beside it, in the user's cache folder.
    static void keep_picture(const std::filesystem::path& level_file, Renderer& renderer);

  private:
    struct Card {
        common::LevelEntry level;
        Image picture;
    };
    std::vector<Card> cards_;
    std::vector<PlacedImage> placed_;
};

} // namespace viewer
