// What of a level file can be changed from outside: effects, to start again with, and what its numbers mean, from
// level.schema.json.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace viewer {

struct EffectSetting {
    std::string name;
    int force; // index into effect_forces
};
inline constexpr const char* effect_forces[] = {"auto", "on", "off"};

/// The longer side of a level [m]; 0 for one that is no JSON file. `text` not empty: instead of the file's own.
double longest_side(const std::filesystem::path& level_file, const std::string& text);

class LevelSettings {
  public:
    LevelSettings() = default;
    /// Without effects for a level that is no JSON file (a terrain map) or where the schema is not found. `text` not empty:
    /// instead of the file's own.
    explicit LevelSettings(const std::filesystem::path& level_file, const std::string& text = {});
    std::vector<EffectSetting> effects;
    std::map<std::string, std::string> material_help; // by key; begins or ends with the unit
    /// A variant more, or another one of that name; `patch` as JSON.
    void set_variant(const std::string& name, const std::string& patch);
    /// The level file's text with these effects; empty where there are none.
    std::string text() const;

  private:
    std::string level_; // as JSON
};

} // namespace viewer
