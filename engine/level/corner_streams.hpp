// Streams one cell wide whose cells touch at a corner alone. Water passes the sides of cells and no corner: there it stands until
// it runs over the bank.
#pragma once
#include "engine/level/level.hpp"

namespace wadi {

/// Warns of such corners in the ground (terrain and sand) of a level into which water comes: how many there are, and where water
/// stands deepest. Banks lower than a quarter of a cell's width count as none, and so do corners round which a way leads that is
/// not higher than that.
void warn_corner_streams(const Settings& settings, const InitialFields& fields, std::vector<std::string>& warnings);

} // namespace wadi
