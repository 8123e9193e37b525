// Advice on flows thinner than the quantum of height can carry, and on sources that bring more than a cell takes.
#pragma once
#include "engine/settings/data/settings.hpp"
#include <string>
#include <vector>

namespace wadi {

/// What the rules need of the initial fields.
struct FilmGround {
    double highest_column = 0; // H + hs + W [m]
    bool mostly_dry = false;   // more than half of the cells have no water above their sand
};

/// Warns of rain, discharges and sources of water that bring less than one quantum through a face in a step (NUMERICS 2.2). All
/// of it enters and nothing is lost, but a film waits on dry ground until it is deep enough to move a whole one.
void warn_films(const Settings& settings, const FilmGround& ground, std::vector<std::string>& warnings);

/// Warns of sources whose discharge, shared by the cells that they cover, is beyond RATE_MOST.
void warn_discharges(const Settings& settings, std::vector<std::string>& warnings);

} // namespace wadi
