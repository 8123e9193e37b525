// What the window and the script act on: a world, how it is seen, and tools. Knows no window and no panel.
#pragma once
#include "budget.hpp"
#include "history.hpp"
#include "level_settings.hpp"
#include "level_watch.hpp"
#include "options.hpp"
#include "render_scale.hpp"
#include "renderer.hpp"
#include "tools.hpp"
#include <memory>
#include <optional>

namespace viewer {

/// One column of the section's profile [m].
struct ProfilePoint {
    float terrain, sand, water; // elevation of each top
};

class Session {
  public:
    Session(const Gpu& gpu, Renderer& renderer, const Options& options);

    /// Replaces the world; keeps the old one and throws where the new one cannot be made.
    void open(const std::string& level_name, const SimulationChoice& choice);
    void restart(); // the same level as at its start, with the forced effects of `settings` and the material as it is now
    /// The level file's text with its comments; empty for a map.
    std::string level_text() const;
    /// Begins again with another text of the level, from its own numbers of the material, seen as before. Throws
    /// std::runtime_error with the plugin's message, and the world that runs goes on.
    void try_level(const std::string& text);
    /// The same, and writes it to the level's file.
    void write_level_text(const std::string& text);
    /// The world as it is now as a level beside the pictures: write_level().
    void write_world();
    Simulation& simulation() { return *simulation_; }
    const SimulationChoice& choice() const { return choice_; }

    /// One frame of `seconds` of the host's time: edits, update, profile.
    void advance(double seconds);
    void draw(const Submission& swapchain, const std::function<void(VkCommandBuffer)>& after);
    void single_step() { steps_due_ += 1; }

    /// The world's timeline. Steps and commands of others than this class go past it: none do.
    History& history() { return *history_; }
    /// History::begin(), undo() ... with what the viewer shows beside the world.
    void undo();
    void redo();
    void go_to(uint64_t step); // and pauses
    void save();               // to save_file()
    void load();
    std::filesystem::path save_file() const;

    /// The pointer at a pixel of the picture, with the tool's button down or not.
    void point(uint32_t x, uint32_t y, bool pressed);
    void point_away();

    /// The material's numbers now, and as the level has them.
    std::vector<wadi_material_info> material() const;
    const std::vector<wadi_material_info>& level_material() const { return level_material_; }
    /// A kind of sand: several numbers, and how wet sand is poured. None is changed where one cannot be.
    void set_preset(const std::string& name);
    /// From the next step on; throws std::runtime_error naming number and range.
    void set_material(const std::string& name, double value);
    /// Whether there are numbers whose 0 switches the effect off while the world runs.
    static bool has_switch(const std::string& effect);
    /// By those numbers: 0, or what they were before, or the level's, or usual values.
    void switch_effect(const std::string& effect, bool on);

    /// Measures which settings of the level err least for `budget_ms` of each frame at 60 a second; the world stands still
    /// meanwhile and begins again with them. `minutes`: to measure for, about.
    void find_settings(double minutes);
    Budget& budget() { return budget_; }
    /// Begins again with what was found, if something was since the last call; every advance() does.
    void take_settings();

    void set_profiling(bool on);
    std::vector<wadi_stage_timing> stage_timings() const;

    void screenshot() { screenshot_due_ = true; } // of the next frame
    void set_recording(bool on);                  // pictures of equal simulated time, then an MP4

    std::string level_name;
    float budget_ms = 2;
    std::string found_settings; // in a sentence, or why none were
    Picture picture;
    bool paused = false;
    float speed = 1;
    Tools tools;
    RenderScale render_scale;
    LevelSettings settings;
    bool recording() const { return recording_; }
    /// The next frame becomes a file: nothing else should be drawn on it.
    bool picture_is_kept() const { return recording_ || screenshot_due_; }
    bool profiling = false;
    double real_time_factor = 0, steps_per_second = 0; // over the last second or so
    std::vector<ProfilePoint> profile;
    std::string message; // the newest thing worth telling

    const Gpu& gpu;
    Renderer& renderer;

  private:
    Options options_;
    SimulationChoice choice_;
    std::unique_ptr<Simulation> simulation_;
    std::unique_ptr<History> history_; // goes first
    std::vector<wadi_material_info> level_material_;
    Budget budget_;
    LevelWatch watch_;
    std::string untuned_variant_;                // of the level, ahead of the variant with found settings
    std::map<std::string, double> switched_off_; // by number: the value that switch_effect() took away
    uint32_t steps_due_ = 0;
    bool pressed_ = false;
    bool recording_ = false, screenshot_due_ = false;
    uint64_t recorded_ = 0, screenshots_ = 0;
    std::filesystem::path recording_folder_;
    uint64_t profile_ticket_ = 0;
    bool profile_asked_ = false;
    double host_seconds_ = 0, simulated_at_ = 0; // of the rates
    uint64_t steps_at_ = 0;

    enum class Anew { world, text, level }; // what is another than before
    void replace(const std::string& name, const SimulationChoice& choice, Anew anew);
    void follow_file(double seconds);
    void tell(const std::string& what);
    void went(const std::string& how); // to another step
    void take_over(const std::vector<wadi_material_info>& material);
    void use_tool(double seconds);
    void follow_section();
    void count_rates(double seconds);
};

} // namespace viewer
