// The world as it is now, as a level of its own.
#pragma once
#include "simulation.hpp"
#include <filesystem>

namespace viewer {

/// Writes level.json and its maps into `folder`: ground, sand, water and their velocities as they are, the material as it is now,
/// and what else the level says, of the variant that runs. `text` is the level file's. Sources placed by hand come along. The
/// strain of sand and the time do not: the level begins at 0 with sand in balance. Throws std::runtime_error.
void write_level(const Simulation& simulation, const SimulationChoice& choice, const std::string& text,
                 const std::filesystem::path& folder);

} // namespace viewer
