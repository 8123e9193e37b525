// Springs and drains placed by hand: sources of the world behind those of the level. The world alone knows them, so that they go
// back in time with it.
#pragma once
#include "simulation.hpp"
#include <glm/vec2.hpp>
#include <vector>

namespace viewer {

struct Spring {
    uint32_t index = 0; // among the world's sources
    bool sand = false;
    glm::vec2 middle{0};
    float radius = 1; // [m]
    float rate = 0;   // [m/s]; below 0 a drain, 0 closed
};

/// Those of index `first` and above, closed ones too.
std::vector<Spring> list_springs(const Simulation& simulation, uint32_t first);
/// The first closed one, or one more. Throws std::runtime_error where the world has room for no more.
uint32_t free_spring(const Simulation& simulation, uint32_t first);
/// From the next step on; throws std::runtime_error with the plugin's message.
void set_spring(const Simulation& simulation, const Spring& spring);

} // namespace viewer
