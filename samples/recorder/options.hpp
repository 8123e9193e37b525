// What the command line asks for.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace recorder {

enum ExitCode : int { EXIT_DONE = 0, EXIT_BAD_INPUT = 2, EXIT_DEVICE_FAULT = 3 };

/// An error that ends the program: one line of text and the exit code. No text = no error.
struct Failure {
    int exit_code = EXIT_DONE;
    std::string message;
    explicit operator bool() const { return !message.empty(); }
};

/// One field to be written at one time.
struct DumpRequest {
    int field = 0; // wadi_field
    std::string field_name;
    std::string time_text; // as the user wrote it; part of the file's name
    double time = 0;       // [s]
};

/// A gauge (`from` is `to`) or a section.
struct PointRequest {
    std::string option;                               // as the user wrote it, for messages
    std::array<double, 2> from = {0, 0}, to = {0, 0}; // [m]
};

struct Options {
    std::string level_name;
    std::string level_file; // level file or terrain map

    std::string backend = "auto";
    std::int32_t device = -1;
    std::int32_t threads = 0;
    bool validate = false;

    std::int32_t nx = 0, ny = 0; // 0 = the level's
    double dt = 0;               // [s], 0 = the level's
    std::string method;          // empty = the level's
    std::string variant;         // empty = the level as it is
    std::string accuracy;        // empty = what the level says

    std::int32_t active_tiles = 0; // 0 = the level's, -1 = off
    std::int32_t fused_stages = 0; // 0 = the level's, 1 = always, -1 = never

    bool any_files = false; // the level's maps may lie anywhere

    double seconds = -1;     // simulated time, -1 = the level's duration
    double every = 0;        // between frames [s], 0 = a tenth of the recording
    double calm_speed = 0;   // the recording ends once nothing is faster [m/s], 0 = it runs its seconds
    double calm_seconds = 0; // for so long [s]
    double water_scale = 0;  // depth drawn in deep blue [m], 0 = derived
    bool frames = true;
    bool jpeg = false; // of the contact sheet
    bool mp4 = false;
    int frames_per_second = 25; // of the MP4
    bool profile = false;
    bool check = false;
    bool print_plan = false;
    std::vector<DumpRequest> dumps;
    std::string dump_as = "npy"; // ending of their files
    std::vector<PointRequest> gauges, sections;
    bool map_coordinates = false; // of gauges and sections: those of the map that the level was cut from
    bool terrain_alone = false;   // level_file is a map
    std::string out;
    std::string summary; // file, empty = none
};

} // namespace recorder
