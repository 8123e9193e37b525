// Force and torque of water on a floating body, from the state at points under it. Host arithmetic only: no world, no device.
#pragma once
#include "engine/compute/status.hpp"
#include <array>
#include <cstdint>
#include <functional>
#include <span>

namespace wadi {

using Vector3 = std::array<double, 3>;

enum class BodyShape : std::uint8_t { box, sphere };

/// SI units. Fields and ranges: wadi_body in the plugin's header.
struct Body {
    BodyShape shape = BodyShape::box;
    Vector3 position{};
    std::array<double, 4> orientation{0, 0, 0, 1}; // quaternion x, y, z, w
    Vector3 half_size{0.5, 0.5, 0.5};
    double radius = 0.5;
    Vector3 velocity{}, angular_velocity{};
    double water_density = 1000, gravity = 9.81, linear_drag = 0, quadratic_drag = 1;
    int samples = 4;
};

/// What the water is above or below one point.
struct WaterAt {
    bool inside = false;
    double surface = 0, depth = 0;         // [m]
    double velocity_x = 0, velocity_y = 0; // [m/s]
};

struct Wrench {
    Vector3 force{}, torque{}; // [N], [N m] about the body's position
};

constexpr int most_body_samples = 16; // per side

/// Checks every field; the message names it, its value and its range.
Status validate(const Body& body);

/// A body is cut into columns. Calls see(x, y) for the point of each that asks for the water, in a fixed order.
void for_body_points(const Body& body, const std::function<void(double x, double y)>& see);
std::uint32_t count_body_points(const Body& body);

/// Per column with volume V of which the share f lies between the bed and the surface: buoyancy water_density gravity f V upwards
/// at the middle of that part, and drag (f V / whole volume) (linear_drag du + water_density quadratic_drag area |du| du / 2)
/// there, du being the water's velocity less the body's. Area: pi r^2, or volume^(2/3) of a box.
Wrench buoyancy(const Body& body, const std::function<WaterAt(std::uint32_t point)>& water);

} // namespace wadi
