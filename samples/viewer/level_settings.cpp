#include "level_settings.hpp"
#include "../common/levels.hpp"
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

namespace viewer {
namespace {

using Json = nlohmann::ordered_json;

Json read_json(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return Json::parse(stream, nullptr, false,
                       true); // no exceptions, comments allowed
}

Json read_schema() {
    for (const std::filesystem::path& folder : common::level_folders()) {
        Json schema = read_json(folder / "level.schema.json");
        if (schema.is_object()) return schema;
    }
    return {};
}

Json read_level(const std::filesystem::path& level_file, const std::string& text) {
    if (!text.empty()) return Json::parse(text, nullptr, false, true);
    return level_file.extension() == ".json" ? read_json(level_file) : Json();
}

} // namespace

double longest_side(const std::filesystem::path& level_file, const std::string& text) {
    const Json level = read_level(level_file, text);
    if (!level.is_object() || !level.contains("grid") || !level["grid"].is_object()) return 0;
    const auto number = [&](const char* key) {
        const auto found = level["grid"].find(key);
        return found != level["grid"].end() && found->is_number() ? found->get<double>() : 0;
    };
    return std::max(number("nx"), number("ny")) * number("dx");
}

LevelSettings::LevelSettings(const std::filesystem::path& level_file, const std::string& text) {
    const Json level = read_level(level_file, text);
    const Json schema = read_schema();
    if (!level.is_object() || !schema.is_object()) return;
    level_ = level.dump();
    for (const auto& [key, property] : schema["properties"]["material"]["properties"].items())
        material_help[key] = property.value("description", "");
    const Json forced = level.value("effects", Json::object());
    for (const auto& entry : schema["properties"]["effects"]["properties"].items()) {
        const std::string force = forced.value(entry.key(), "auto");
        const auto* found = std::find(std::begin(effect_forces), std::end(effect_forces), force);
        effects.push_back(
            {entry.key(), found == std::end(effect_forces) ? 0 : static_cast<int>(found - std::begin(effect_forces))});
    }
}

void LevelSettings::set_variant(const std::string& name, const std::string& patch) {
    Json level = Json::parse(level_);
    level["variants"][name] = Json::parse(patch);
    level_ = level.dump();
}

std::string LevelSettings::text() const {
    if (effects.empty()) return {};
    Json level = Json::parse(level_);
    for (const EffectSetting& effect : effects) level["effects"][effect.name] = effect_forces[effect.force];
    return level.dump();
}

} // namespace viewer
