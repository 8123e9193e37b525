// From a level, a machine and a budget to settings: which runs to make, and what follows from them.
#pragma once
#include "candidates.hpp"

namespace tune {

struct Request {
    double budget_ms = 2; // of each frame
    double frames = 60;   // per second
    double minutes = 1;   // to measure for, about
    Device device;
    std::function<void(const std::string&)> tell; // what is being done, a line at a time; may be empty
    std::function<bool()> stop;                   // true ends it with Stopped; may be empty
};

/// What is known of the error of one surface.
struct Told {
    bool exists = false;    // the level has it
    bool moved = false;     // in the piece of its time
    bool converges = false; // runs come closer to each other with smaller cells so that an error can be told from them
    double order = 0;       // of the error in the size of a cell, of the reference's way
    double closing = 0;     // in which runs of a quarter, a half and all of the reference's cells come closer to each other
    double scatter = 0;     // of the differences about that order
    double reference = 0;   // error of the reference itself [percent]
    std::vector<ErrorPoint> differences;           // of coarser runs of the reference's way, from which all that follows
    int early = 0;                                 // where it does not converge: the checkpoints until which it does, or none
    double early_reference = 0, early_percent = 0; // as reference, and the error of the chosen settings until then
};

struct Outcome {
    Candidate predicted;         // of the model, before the settings were measured
    Candidate chosen;            // as measured
    double dearest_frame_ms = 0; // mean over the dearest sixteenth of the piece
    double spread = 0;           // (slowest - quickest) / quickest of the confirming runs
    int confirming_runs = 0;
    double measured_share = 0;    // of the level's time that those took
    bool errors_measured = false; // of the chosen settings themselves; else the model's
    std::vector<Candidate> frontier;
    Settings reference;
    Told sand, water;
    double piece = 0;      // [s] from the level's start, in which errors were measured
    int checkpoints = 0;   // at equal times of it
    double load = 1;       // time per step over the whole level, times that of the piece
    double tiles_gain = 1; // time with active_tiles 1 over that as the level has it
    double seconds = 0;    // that it took
    int runs = 0;
    std::string device_name, backend;
    std::vector<std::string> notes;    // sentences
    std::vector<std::string> warnings; // of the level with the chosen settings
};

/// Throws BadInput (also where the budget is too small: the message has the cheapest settings and their cost) and Stopped.
Outcome tune(const Level& level, const Request& request);

} // namespace tune
