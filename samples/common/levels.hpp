// Level names: folders with a level.json, looked up in a few places.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace common {

struct LevelEntry {
    std::string name;
    std::filesystem::path file;
    std::string description;
    std::vector<std::string> variants;
};

/// Folders that are searched, in order: $WADI_LEVELS, the source tree's samples/levels, ../share/wadi/levels beside the
/// executable.
std::vector<std::filesystem::path> level_folders();

/// All levels by name; where two folders have the same name the first counts.
std::vector<LevelEntry> list_levels();

struct FoundLevel {
    std::string name;
    std::filesystem::path file;
    std::string error; // not empty: no such level; names the nearest ones
};
/// `text` is a level's name, a level file (.json) or a folder with a level.json.
FoundLevel find_level(const std::string& text);

} // namespace common
