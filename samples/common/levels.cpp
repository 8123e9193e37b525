#include "levels.hpp"
#include "platform.hpp"
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

namespace common {
namespace {

namespace fs = std::filesystem;

LevelEntry read_entry(const std::string& name, const fs::path& file) {
    LevelEntry entry{name, file, {}, {}};
    std::ifstream stream(file);
    const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false, true);
    if (!json.is_object()) return entry;
    if (json.contains("description") && json["description"].is_string())
        entry.description = json["description"].get<std::string>();
    if (json.contains("variants") && json["variants"].is_object()) {
        for (const auto& [variant, change] : json["variants"].items()) entry.variants.push_back(variant);
    }
    return entry;
}

/// Levenshtein distance, upper and lower case alike.
std::size_t edit_distance(const std::string& a, const std::string& b) {
    const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (lower(a[i]) == lower(b[j]) ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j + 1] + 1, row[j] + 1});
        }
    }
    return row.back();
}

std::string unknown_level(const std::string& name) {
    std::vector<LevelEntry> levels = list_levels();
    if (levels.empty()) {
        std::string searched;
        for (const fs::path& folder : level_folders()) searched += (searched.empty() ? "" : ", ") + folder.string();
        return "unknown level \"" + name + "\"; no level was found in " + searched +
               " (set WADI_LEVELS to the folder of the levels)";
    }
    std::stable_sort(levels.begin(), levels.end(), [&](const LevelEntry& a, const LevelEntry& b) {
        return edit_distance(name, a.name) < edit_distance(name, b.name);
    });
    std::string text = "unknown level \"" + name + "\"; the nearest names are ";
    const std::size_t shown = std::min<std::size_t>(levels.size(), 3);
    for (std::size_t k = 0; k < shown; ++k) text += (k == 0 ? "" : ", ") + levels[k].name;
    return text + " (--list-levels shows all)";
}

} // namespace

std::vector<fs::path> level_folders() {
    std::vector<fs::path> folders;
    if (const char* variable = std::getenv("WADI_LEVELS"); variable != nullptr && *variable != '\0')
        folders.emplace_back(variable);
    folders.emplace_back(WADI_LEVELS_DIR);
    if (const fs::path executable = executable_path(); !executable.empty()) {
        folders.push_back((executable.parent_path() / ".." / "share" / "wadi" / "levels").lexically_normal());
    }
    return folders;
}

std::vector<LevelEntry> list_levels() {
    std::map<std::string, LevelEntry> levels;
    for (const fs::path& folder : level_folders()) {
        std::error_code error;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
            const fs::path file = entry.path() / "level.json";
            const std::string name = entry.path().filename().string();
            if (!fs::is_regular_file(file, error) || levels.contains(name)) continue;
            levels[name] = read_entry(name, file);
        }
    }
    std::vector<LevelEntry> list;
    for (const auto& [name, entry] : levels) list.push_back(entry);
    return list;
}

FoundLevel find_level(const std::string& text) {
    const fs::path path(text);
    std::error_code error;
    if (path.extension() == ".json") {
        const std::string stem = path.stem().string();
        const fs::path folder = fs::absolute(path, error).parent_path().filename();
        const std::string name = stem == "level" && !folder.empty() ? folder.string() : stem;
        if (!fs::is_regular_file(path, error)) return {name, path, "no such file: " + text};
        return {name, path, {}};
    }
    if (path.has_parent_path()) { // a folder was meant, not a name
        const fs::path file = path / "level.json";
        if (!fs::is_regular_file(file, error)) return {text, file, "no such level file: " + file.string()};
        return {fs::absolute(path, error).lexically_normal().filename().string(), file, {}};
    }
    for (const fs::path& folder : level_folders()) {
        const fs::path file = folder / text / "level.json";
        if (fs::is_regular_file(file, error)) return {text, file, {}};
    }
    return {text, {}, unknown_level(text)};
}

} // namespace common
