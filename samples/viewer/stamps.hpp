// Pictures of heights that the tool "stamp" presses into the sand: built in, or from a file.
#pragma once
#include <glm/vec2.hpp>
#include <string>
#include <vector>

namespace viewer {

/// Heights from 0 to 1, row 0 in the south.
struct StampImage {
    int nx = 0, ny = 0;
    std::vector<float> values;
    /// Of the values whose places lie within `low` ... `high`, shares of the sides, over the number of all.
    double mean(glm::vec2 low, glm::vec2 high) const;
    /// Stretched or squeezed to cells * cells values, each the mean of what it covers.
    StampImage of_cells(int cells) const;
};

/// "castle", "cone", "crater", "ring": drawn by formulas.
const std::vector<std::string>& built_in_stamps();
/// One of them, or a picture of 8 or 16 bits (PNG, JPEG): black is 0, white 1.
/// Throws std::runtime_error naming the stamps, or what is wrong with the file: larger than 1024 x 1024 pixels, too.
StampImage stamp_image(const std::string& name_or_file);

} // namespace viewer
