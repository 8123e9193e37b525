// Small level files for the tests of engine/level.
#pragma once
#include "engine/level/level.hpp"
#include <cstddef>
#include <doctest/doctest.h>
#include <filesystem>
#include <numeric>
#include <string>

namespace level_text {

/// A 10 x 8 m level of 1 m cells; `rest` is more JSON, without a leading comma.
inline std::string level(const std::string& rest, const std::string& grid = R"({"nx": 10, "ny": 8, "dx": 1})") {
    return R"({"format_version": 1, "name": "test", "grid": )" + grid + R"(, "dt": 0.01)" + (rest.empty() ? "" : ", " + rest) +
           "}";
}

inline wadi::Result<wadi::Level> parse(const std::string& rest, const std::string& folder = "",
                                       const wadi::LevelOverrides& overrides = {}) {
    return wadi::parse_level(level(rest), folder, overrides);
}

template <class T> std::string message(const wadi::Result<T>& result) {
    return result ? std::string("no error") : result.status().message;
}

/// The level, or a failed check and an empty one.
inline wadi::Level must(const wadi::Result<wadi::Level>& result) {
    CHECK_MESSAGE(result, message(result));
    return result ? result.value() : wadi::Level{};
}

inline bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Value of a field in cell (i, j).
inline double at(const wadi::Level& level, const std::vector<float>& field, int i, int j) {
    return static_cast<double>(
        field.at(static_cast<std::size_t>(j) * static_cast<std::size_t>(level.settings.grid.nx) + static_cast<std::size_t>(i)));
}

/// The level of 10 m x 8 m on cells of 1/`fine` m.
inline wadi::Level drawn(const std::string& layers, int fine) {
    wadi::LevelOverrides overrides;
    overrides.size = {10 * fine, 8 * fine};
    return must(parse(layers, "", overrides));
}

/// What a field holds [m3].
inline double volume(const wadi::Level& level, const std::vector<float>& field) {
    return std::accumulate(field.begin(), field.end(), 0.0) * level.settings.grid.dx * level.settings.grid.dx;
}

inline std::filesystem::path samples() { return std::filesystem::path(WADI_SOURCE_DIR) / "samples" / "levels"; }

} // namespace level_text
