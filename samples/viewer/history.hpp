// The world's timeline: every command is in its log and states are kept, so that each step of it can be gone to, to the bit.
#pragma once
#include "simulation.hpp"
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace viewer {

class History {
  public:
    /// Begins with the state now.
    explicit History(Simulation& simulation);
    ~History();
    History(const History&) = delete;
    History& operator=(const History&) = delete;

    /// Ahead of commands that undo() takes back as one, such as a stroke of a brush: until close() the same name adds to it.
    /// What lies ahead of the world's step is dropped. Where commands wait for the next step, it is taken first.
    void begin(const std::string& what);
    void close() { open_.clear(); }
    /// Ahead of steps: what was recorded for later steps happens again.
    void follow();
    /// After steps: keeps a state now and then.
    void keep();

    /// What undo() and redo() would take back or bring again; empty: nothing.
    std::string undoable() const;
    std::string redoable() const { return redo_.empty() ? std::string() : redo_.back().points.front().what; }
    /// The state at the beginning of the newest action before the world's step. Throws where there is none.
    void undo();
    /// The state that undo() left.
    void redo();

    uint64_t first() const { return states_.front().step; }
    uint64_t last() const;
    /// To the state of step `step`, first() ... last(), ahead of what was done in it. Throws std::runtime_error outside.
    void go_to(uint64_t step);
    std::size_t kept_states() const { return states_.size(); }
    std::size_t kept_bytes() const;

    /// Plays the whole log from the first state to the present step, and tells whether the state and its ground are the same.
    std::string replay();
    /// A snapshot in a file; and back, where the timeline begins anew. Throw std::runtime_error, the world as it was.
    void save(const std::filesystem::path& file);
    void load(const std::filesystem::path& file);

  private:
    using Bytes = std::vector<char>;
    struct State {
        uint64_t step = 0;
        Bytes bytes;
    };
    struct Point { // where an action began
        std::string what;
        uint64_t step = 0;
    };
    struct Undone {
        std::vector<Point> points; // the first is the action itself
        std::vector<State> states;
        Bytes commands;
        uint64_t reached = 0, last = 0;
    };
    struct Saving { // on its way from the device
        uint64_t ticket = 0;
        State state;
    };

    Simulation& simulation_;
    std::vector<State> states_; // by step
    std::vector<Point> points_; // by step
    std::vector<Undone> redo_;
    Bytes ahead_;       // commands of later steps than the world's, while they do not wait in the world
    uint64_t last_ = 0; // step that was reached before going back
    std::string open_;
    std::optional<Saving> saving_;

    uint64_t now() const;
    Bytes commands_since(uint64_t step) const;
    bool has_commands_since(uint64_t step) const;
    void play(const Bytes& commands);
    Bytes save_now() const;
    void load_bytes(const Bytes& state);
    void restart_log();
    void begin_saving();
    bool try_to_finish_saving();
    void finish_saving();
    void drop_states(uint64_t after);
    void thin();
    const State& newest_state(uint64_t up_to) const;
    void arrive(uint64_t step);
};

} // namespace viewer
