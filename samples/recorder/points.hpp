// Gauges and sections: the state at points, frame by frame, as CSV.
#pragma once
#include "world.hpp"
#include <array>
#include <filesystem>
#include <fstream>

namespace recorder {

/// One CSV file with the lines of all its frames; under a temporary name until close().
class PointTable {
  public:
    /// `number_name` heads the column that tells gauges or sections apart.
    PointTable(std::filesystem::path path, const char* number_name) : path_(std::move(path)), number_name_(number_name) {}

    /// Adds gauge or section `number` (from 0): points along a line, its ends included, no further apart than a cell, or one
    /// point where `from` is `to` [m]; `on_map`: in coordinates of the map. A failure names the option where an end lies outside.
    Failure add(const wadi_world_info& info, std::uint32_t number, const PointRequest& request, bool on_map);
    bool empty() const { return points_.empty(); }

    Failure open();
    /// A line for every point, of the state after the steps so far.
    Failure sample(World& world, double time);
    /// Gives the file its name. Nothing where it was not opened.
    Failure close();

  private:
    struct TablePoint {
        std::uint32_t number;
        double x, y, distance;         // as given; distance from the section's start [m]
        std::array<double, 4> weights; // of the four cells around
    };
    static constexpr std::size_t QUERIES = 5; // a point: it, and the middles of the cells around
    /// Adds the queries of the four cells around a place, counted from the grid's corner; their weights.
    std::array<double, 4> add_cells_around(const wadi_world_info& info, double x, double y);
    double water_surface(std::size_t point) const;
    Failure unwritten() const;

    std::filesystem::path path_;
    const char* number_name_;
    std::vector<TablePoint> points_;
    std::vector<float> xy_; // as the query takes them, QUERIES a point
    std::vector<wadi_query_result> results_;
    std::ofstream file_;
};

} // namespace recorder
