// A level whose text is read, ahead of its maps: what drawing it and what its cost begin with.
#pragma once
#include "engine/level/layers.hpp"
#include "engine/level/level.hpp"
#include <cstdint>

namespace wadi {

struct LevelLayers : LayerLists {
    std::vector<VelocityLayer> velocities;
    std::vector<Layer> roughness, rain;
};

struct ReadLevel {
    Level level; // without fields
    LevelLayers layers;
    LevelGrid grid;
};

inline constexpr std::uint64_t LEVEL_BYTES_MOST = 16u << 20;

/// Series come from `files`, which gets the room and the work that the level's grid allows.
Result<ReadLevel> read_level(const std::string& text, LevelFiles& files, LevelOverrides overrides);

/// Bytes of the host's memory that a world of a map alone takes to load, at most.
std::uint64_t load_bytes(const MapCost& map, std::uint64_t cells);

/// The names of files as the level's author may write them; refers to `read`.
FileReader within(const FileReader& read, FilesFrom from);

} // namespace wadi
