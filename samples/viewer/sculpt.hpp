// Smoothing and flattening sand: read on the host, changed there and written back. Waits for the steps, while the tool is used.
#pragma once
#include "simulation.hpp"
#include <glm/vec2.hpp>

namespace viewer {

/// Lets sand within `radius` of `middle` [m] run from higher cells to lower ones; `share` 0 ... 0.2 of each difference of
/// surfaces. Moves sand in whole quanta: none is made or lost. The ground stays.
void smooth_sand(Simulation& simulation, glm::vec2 middle, float radius, float share);
/// Brings the sand's surface within `radius` towards the elevation `level` [m], by at most `most` [m]: adds and takes sand.
/// Returns the volume that was added less that which was taken [m3].
double flatten_sand(Simulation& simulation, glm::vec2 middle, float radius, float level, float most);
/// Elevation of the solid surface in the cell at `place` [m].
float surface_at(const Simulation& simulation, glm::vec2 place);

} // namespace viewer
