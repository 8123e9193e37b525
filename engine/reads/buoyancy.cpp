#include "engine/reads/buoyancy.hpp"
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace wadi {

namespace {

Vector3 operator+(const Vector3& a, const Vector3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector3 operator-(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector3 operator*(double s, const Vector3& a) { return {s * a[0], s * a[1], s * a[2]}; }
Vector3 cross(const Vector3& a, const Vector3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A thin prism: its middle relative to the body, and from there to its upper end; the latter's z is above 0.
struct Column {
    Vector3 middle, to_top;
    double volume;
};

double volume_of(const Body& body) {
    const auto& h = body.half_size;
    return body.shape == BodyShape::sphere ? 4.0 / 3.0 * std::numbers::pi * body.radius * body.radius * body.radius
                                           : 8 * h[0] * h[1] * h[2];
}

double area_of(const Body& body) {
    return body.shape == BodyShape::sphere ? std::numbers::pi * body.radius * body.radius
                                           : std::cbrt(std::pow(volume_of(body), 2));
}

// The body's axes in the world.
std::array<Vector3, 3> axes_of(const Body& body) {
    auto q = body.orientation;
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (auto& part : q) part /= length;
    const auto [x, y, z, w] = q;
    return {Vector3{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
            Vector3{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
            Vector3{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
}

// Middle of part k of n of -1 ... 1.
double middle(int k, int n) { return (2.0 * k + 1) / n - 1; }

// Columns stand along the axis nearest to the vertical, so that a box on its side is cut as well as an upright one.
template <class See> void box_columns(const Body& body, See see) {
    const auto axes = axes_of(body);
    std::size_t up = 0;
    for (std::size_t k = 1; k < 3; ++k) {
        if (std::abs(axes[k][2]) > std::abs(axes[up][2])) up = k;
    }
    const std::size_t a = (up + 1) % 3, b = (up + 2) % 3;
    const Vector3 to_top = std::copysign(body.half_size[up], axes[up][2]) * axes[up];
    const double volume = volume_of(body) / (body.samples * body.samples);
    for (int j = 0; j < body.samples; ++j) {
        for (int i = 0; i < body.samples; ++i) {
            see(Column{middle(i, body.samples) * body.half_size[a] * axes[a] +
                           middle(j, body.samples) * body.half_size[b] * axes[b],
                       to_top, volume});
        }
    }
}

// Vertical chords on a square lattice, weighted so that they make up the sphere's volume.
template <class See> void sphere_columns(const Body& body, See see) {
    const double r = body.radius;
    const auto chords = [&](const auto& use) {
        for (int j = 0; j < body.samples; ++j) {
            for (int i = 0; i < body.samples; ++i) {
                const double x = r * middle(i, body.samples), y = r * middle(j, body.samples), rest = r * r - x * x - y * y;
                if (rest > 0) use(x, y, std::sqrt(rest));
            }
        }
    };
    double sum = 0;
    chords([&](double, double, double half) { sum += half; });
    const double volume_per_length = volume_of(body) / sum;
    chords([&](double x, double y, double half) { see(Column{{x, y, 0}, {0, 0, half}, half * volume_per_length}); });
}

template <class See> void for_columns(const Body& body, See see) {
    body.shape == BodyShape::sphere ? sphere_columns(body, see) : box_columns(body, see);
}

} // namespace

Status validate(const Body& body) {
    const auto check = [](const char* name, double value, double least, double most) {
        if (std::isfinite(value) && value >= least && value <= most) return ok_status();
        return error(Code::bad_argument, std::string("body: ") + name + " is " + std::to_string(value) + ", allowed are " +
                                             std::to_string(least) + " ... " + std::to_string(most));
    };
    constexpr double far = 1e9, small = 1e-6;
    auto status = ok_status();
    const auto all = [&](const char* name, std::span<const double> values, double least, double most) {
        for (const double value : values) {
            if (status) status = check(name, value, least, most);
        }
    };
    all("position", body.position, -far, far);
    all("velocity", body.velocity, -far, far);
    all("angular_velocity", body.angular_velocity, -far, far);
    all("orientation", body.orientation, -1.001, 1.001);
    if (body.shape == BodyShape::box) all("half_size", body.half_size, small, far);
    if (body.shape == BodyShape::sphere) all("radius", std::span(&body.radius, 1), small, far);
    all("water_density", std::span(&body.water_density, 1), 0, far);
    all("gravity", std::span(&body.gravity, 1), 0, far);
    all("linear_drag", std::span(&body.linear_drag, 1), 0, far);
    all("quadratic_drag", std::span(&body.quadratic_drag, 1), 0, far);
    if (status) status = check("samples", body.samples, 1, most_body_samples);
    double length = 0;
    for (const double part : body.orientation) length += part * part;
    if (status && std::abs(length - 1) > 0.01)
        return error(Code::bad_argument,
                     "body: orientation is no unit quaternion, its squared length is " + std::to_string(length));
    return status;
}

void for_body_points(const Body& body, const std::function<void(double x, double y)>& see) {
    for_columns(body, [&](const Column& c) { see(body.position[0] + c.middle[0], body.position[1] + c.middle[1]); });
}

std::uint32_t count_body_points(const Body& body) {
    std::uint32_t count = 0;
    for_columns(body, [&](const Column&) { ++count; });
    return count;
}

Wrench buoyancy(const Body& body, const std::function<WaterAt(std::uint32_t point)>& water) {
    Wrench sum;
    std::uint32_t point = 0;
    const double whole = volume_of(body), area = area_of(body);
    for_columns(body, [&](const Column& column) {
        const WaterAt w = water(point++);
        const double z = body.position[2] + column.middle[2], half = column.to_top[2];
        const double low = std::max(z - half, w.surface - w.depth), high = std::min(z + half, w.surface);
        if (!w.inside || !(high > low)) return;
        const double wet = column.volume * (high - low) / (2 * half);
        const Vector3 arm = column.middle + ((low + high) / 2 - z) / half * column.to_top;
        const Vector3 moving = Vector3{w.velocity_x, w.velocity_y, 0} - (body.velocity + cross(body.angular_velocity, arm));
        const double speed = std::sqrt(moving[0] * moving[0] + moving[1] * moving[1] + moving[2] * moving[2]);
        const double drag = body.linear_drag + 0.5 * body.water_density * body.quadratic_drag * area * speed;
        const Vector3 force = Vector3{0, 0, body.water_density * body.gravity * wet} + (wet / whole * drag) * moving;
        sum.force = sum.force + force;
        sum.torque = sum.torque + cross(arm, force);
    });
    return sum;
}

} // namespace wadi
