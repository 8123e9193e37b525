// Edits as data: what a host queues for a running world, and what a level brings along with its times.
#pragma once
#include <array>
#include <cstdint>

namespace wadi {

enum class EditKind : std::uint8_t { brush, stamp, push };
enum class EditLayer : std::uint8_t { terrain, sand, water };

/// See wadi_edit in the plugin's header for meaning, units and ranges.
struct Edit {
    EditKind kind = EditKind::brush;
    EditLayer layer = EditLayer::terrain; // of brush and stamp
    bool capsule = false;                 // brush and push: from (x0, y0) to (x1, y1) instead of a disc round (x0, y0)
    std::uint64_t step = 0;               // 0 = the next one
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    double radius = 0, softness = 0;
    double amount = 0; // [m]; of a stamp: metres per unit of the image
    double strength = 0, velocity_x = 0, velocity_y = 0;
    std::uint32_t stamp = 0;
    std::uint32_t player = 0; // edits of one step act by rising player, then in the order of the calls
};

/// A brush or push that a level asks for. It acts ahead of the step nearest to each of its times: `time`, and with `every`
/// above 0 also every so often up to `until`.
struct ScriptedEdit {
    Edit edit;                           // its step is not used
    double time = 0;                     // [s], 0 ... 1e9
    double every = 0;                    // 0 = once, or 1e-3 ... 1e9 [s]
    double until = 0;                    // only with every [s], time ... 1e9
    std::array<double, 2> move = {0, 0}; // how fast its place moves from `time` on [m/s]
};

} // namespace wadi
