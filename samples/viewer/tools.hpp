// What the pointer does to the world. All of it is commands of the plugin, so that the log plays it to the same state.
#pragma once
#include "history.hpp"
#include "springs.hpp"
#include "stamps.hpp"
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>

namespace viewer {

/// Keys 1 ... 9, 0 are the first ten, with Shift those behind.
enum class Tool { look, water, sand, dig, smooth, flatten, wall, stamp, spring, drain, push, scoop, raise, lower, section };
inline constexpr const char* tool_names[] = {"look",    "pour water",  "pour sand",    "dig",          "smooth",
                                             "flatten", "wall",        "stamp",        "spring",       "drain",
                                             "push",    "scoop water", "raise ground", "lower ground", "section"};
/// One sentence each, for the panel.
const char* tool_help(Tool tool);

struct Brush {
    float radius = 1;      // [m]; half the side of a stamp
    float rate = 1;        // [m/s]
    float height = 1;      // of walls and stamps [m]
    float strength = 0.5f; // of a push, 0 ... 1
    float wetness = 0;     // of sand that comes: share of its pores that is full, 0 ... 1
};

/// What the tool would change, for drawing on the ground.
struct Footprint {
    enum class Shape { none, capsule, square } shape = Shape::none;
    glm::vec2 from{0}, to{0}; // [m]; of a square its middle twice
    float radius = 0;         // [m]; of a square half its side
    float height = 0;         // of what would stand there [m]; 0 = it grows with time
    std::string numbers;      // area, height, volume
};

class Tools {
  public:
    Tool tool = Tool::look;
    Brush brush;

    /// Of a world made anew; another level has brushes of its size.
    void enter(Simulation& simulation, History& history, bool other_level);
    /// What the tool "stamp" presses: stamp_image() says which names and files, and throws.
    void set_stamp(const std::string& name_or_file);
    const std::string& stamp() const { return stamp_; }
    /// The pointer's place in the world, if it is at one.
    void point(std::optional<glm::vec3> place, bool pressed);
    /// Ahead of a frame's steps: the commands of `seconds` of the pointer. True: some wait for a step. Throws std::runtime_error.
    bool act(double seconds);

    Footprint footprint() const;
    std::vector<Spring> springs() const { return list_springs(*simulation_, first_spring_); }
    /// Changes one of them, to be undone as one while a button is held.
    void change(const Spring& spring);
    std::optional<glm::vec3> place() const { return place_; }

  private:
    Simulation* simulation_ = nullptr;
    History* history_ = nullptr;
    uint32_t first_spring_ = 0;
    std::string stamp_;
    StampImage image_;
    std::map<int, uint32_t> stamps_; // of the image in this world: their numbers, by cells along a side
    std::optional<glm::vec3> place_, begun_, last_;
    bool pressed_ = false;
    bool done_ = false; // a tool of one act has acted, until the button is up
    float level_ = 0;   // that flattening brings sand to [m]
    double poured_ = 0; // by this stroke [m3]

    void begin();
    void edit(std::vector<wadi_edit> edits);
    wadi_edit brushed(wadi_layer layer, glm::vec2 from, glm::vec2 to, double amount, double softness) const;
    void add_sand(std::vector<wadi_edit>& edits, wadi_edit sand) const;
    bool stroke(double seconds);
    bool press_once();
    bool raise_wall();
    int stamp_cells() const;
    glm::vec2 stamp_corner() const; // on a corner of cells: the image's values are those of cells
    uint32_t made_stamp();
};

/// Volume of a brush of 1 m at its middle: a disc, and `length` [m] of a capsule beside it [m3].
double brush_volume(double radius, double softness, double length);

} // namespace viewer
