// The command line.
#pragma once
#include "look.hpp"
#include "simulation.hpp"
#include <cstdint>
#include <filesystem>
#include <string>

namespace viewer {

struct Options {
    std::string level_name; // empty: the start screen
    SimulationChoice simulation;
    int gpu = -1;
    bool validate = false;
    uint32_t width = 1280, height = 720;
    std::string camera = "overview";
    std::string quality = "medium";
    std::string view = "picture";
    bool arrows = false;
    std::string without; // features, see look.hpp
    bool block = false;
    double hold = 0; // [ms] that a picture may take: fewer pixels are drawn where it takes longer; 0 = all are drawn
    // offscreen
    bool offscreen = false;
    uint64_t frames = 1;
    double start = 0;        // [s]
    double every = 1.0 / 30; // [s]
    std::filesystem::path out;
    bool video = false;
    bool jpeg = false;
    bool panel = false;
    std::filesystem::path script;
};

/// Pictures as files, no window. Returns the exit code.
int run_offscreen(const Options& options);

} // namespace viewer
