// What the command line asks for.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace import_map {

struct Request {
    std::string map;
    std::filesystem::path folder;
    std::string packed, flip, samples; // words of a level's map; empty = as the library guesses
    std::string holes = "outside";
    std::optional<std::pair<int, int>> size; // of a raw map
    std::optional<double> cell;              // [m]
    std::optional<double> black, white;      // of grey [m]
    bool preview = false;
};

/// Ends the program with a message.
[[noreturn]] void fail(const std::string& text);

} // namespace import_map
