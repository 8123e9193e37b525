// A level file's materials and effects, to change and start again with. Ranges, units and defaults come from level.schema.json.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace viewer {

struct MaterialSetting {
    std::string key, description; // the description begins or ends with the unit
    float least, most, value;
};
struct EffectSetting {
    std::string name;
    int force; // index into effect_forces
};
inline constexpr const char* effect_forces[] = {"auto", "on", "off"};

class LevelSettings {
  public:
    LevelSettings() = default;
    /// Empty for a level that is no JSON file (a terrain map) or where the schema is not found.
    explicit LevelSettings(const std::filesystem::path& level_file);
    std::vector<MaterialSetting> materials;
    std::vector<EffectSetting> effects;
    /// The level file's text with these values.
    std::string text() const;

  private:
    std::string level_; // as JSON
};

} // namespace viewer
