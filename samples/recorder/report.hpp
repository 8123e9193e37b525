// What a run did: as a table for people and as JSON for programs.
#pragma once
#include "world.hpp"
#include <optional>
#include <string>
#include <vector>

namespace recorder {

/// A count of the stats, at the last frame and its largest value over all frames.
struct Count {
    std::uint64_t last = 0, largest = 0;
    void sample(std::uint64_t value) {
        last = value;
        largest = value > largest ? value : largest;
    }
};

/// A share of the faces, at the last frame and its largest value over all frames.
struct Share {
    double last = 0, largest = 0;
    void sample(std::uint64_t part, std::uint64_t whole) {
        last = whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
        largest = last > largest ? last : largest;
    }
};

struct Report {
    std::string level;
    wadi_world_info info = {};
    std::vector<std::string> warnings;
    bool interrupted = false;
    double calm_speed = 0;            // asked for: the run ends once nothing is faster [m/s]; 0 = nobody did
    std::optional<double> calm_since; // [s]
    std::string fault;                // not empty: the device failed in mid-run
    double wall_seconds = 0;          // everything after creation: steps, pictures, files
    double loading_seconds = 0;       // the level and its world
    double stepping_seconds = 0;      // steps alone
    double processor_seconds = 0;     // processor time of all threads in them
    double figures_seconds = 0;       // ledger, extremes and hash at the frames' times
    double picture_seconds = 0;       // frames: read, drawn and written
    std::uint64_t timed_steps = 0;    // steps that stepping_seconds covers
    int frames = 0;
    unsigned clock_readings = 0, clock_last = 0, clock_least = 0; // of the GPU while it stepped [MHz]

    wadi_world_stats stats = {};                                                                 // of the last successful reading
    double largest_sand = 0, largest_water = 0, largest_water_speed = 0, largest_sand_speed = 0; // over all frames
    double smallest_depth = 0;
    Count clamped_faces, capped_faces, limited_cells, high_columns, not_finite;
    Share clamped_water, capped_water, clamped_sand, capped_sand; // of the faces that have water or sand
    std::vector<wadi_stage_timing> stages;                        // empty without profiling

    void sample(const wadi_world_stats& now);
    double ms_per_step() const;
    std::uint64_t passes_per_step() const;
};

/// (now - (initial + in - out)) / (initial + in), 0 for no volume at all.
double relative_drift(double initial, double in, double out, double now);

std::string hash_text(std::uint64_t hash);
std::string format_table(const Report& report);
std::string format_summary(const Report& report);

} // namespace recorder
