// A level file on any grid and with any of the tuner's settings.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace tune {

using Json = nlohmann::ordered_json;

/// What the user asked for cannot be done: a level, number or device that is wrong. The message is one line.
struct BadInput : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// How a level is stepped, whatever its grid.
struct Way {
    int substeps = 2;      // T: sand substeps per water step
    int water_order = 1;   // method.water_transport_order
    int sand_order = 1;    // method.sand_transport_order
    int active_tiles = -1; // -1 = the level's; else a level's active_tiles
    bool operator==(const Way&) const = default;
};

struct Settings {
    int nx = 0, ny = 0;
    Way way;
    double cells() const { return static_cast<double>(nx) * ny; }
    bool operator==(const Settings&) const = default;
};

class Level {
  public:
    /// Throws BadInput. `variant`: one of the level's, empty = the level as it is.
    Level(const std::filesystem::path& file, const std::string& variant);
    /// From a level's text with the folder of its maps.
    Level(const std::string& text, const std::filesystem::path& folder, const std::string& variant);

    const Json& json() const { return json_; } // with the variant
    const Json& file_json() const { return file_json_; }
    const std::string& file_text() const { return text_; }
    const Json& variant_patch() const { return variant_patch_; }
    const std::filesystem::path& folder() const { return folder_; }

    int nx() const { return nx_; }
    int ny() const { return ny_; }
    double duration() const { return duration_; }
    Way own_way() const;

    /// The grid of nearly `nx` cells along x that keeps both sides' lengths best.
    Settings on_grid(double nx, const Way& way) const;
    double dx(const Settings& settings) const { return width_ / settings.nx; } // [m]
    /// [s]; in proportion to dx.
    double dt(const Settings& settings) const;
    /// What the level's file must have in it for these settings: a JSON merge patch.
    Json patch(const Settings& settings) const;
    /// The level's text with the patch.
    std::string text(const Settings& settings) const;

  private:
    void read(const std::string& variant);
    std::filesystem::path folder_;
    std::string text_;
    Json file_json_, variant_patch_, json_;
    int nx_ = 0, ny_ = 0;
    double width_ = 0, dt_ = 0, duration_ = 10;
};

} // namespace tune
