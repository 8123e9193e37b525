#include "heights.hpp"
#include "request.hpp"
#include <cmath>
#include <fstream>

namespace import_map {

void check_sides(const std::string& name, std::int64_t nx, std::int64_t ny) {
    if (nx >= 1 && ny >= 1 && nx <= MOST_SAMPLES && ny <= MOST_SAMPLES) return;
    fail(name + ": " + std::to_string(nx) + " x " + std::to_string(ny) + " samples are outside 1 ... " +
         std::to_string(MOST_SAMPLES) + " a side");
}

void write_grid(const Heights& heights, const std::string& path) {
    std::ofstream file(path);
    file.precision(12);
    file << "ncols " << heights.nx << "\nnrows " << heights.ny << "\nxllcorner " << heights.west << "\nyllcorner "
         << heights.south;
    file << "\ndx " << heights.dx << "\ndy " << heights.dy << "\nNODATA_value nan\n";
    file.precision(9); // each float back to its bits
    for (std::size_t n = 0; n < heights.rows.size(); ++n) {
        if (std::isnan(heights.rows[n]))
            file << "nan";
        else
            file << heights.rows[n];
        file << ((n + 1) % heights.nx == 0 ? '\n' : ' ');
    }
    if (!file.flush()) fail(path + ": cannot be written");
}

} // namespace import_map
