// Edits checked, and packed for the device.
#include "engine/edits.hpp"
#include "engine/level/setting_fields.hpp"
#include "engine/level/text.hpp"
#include <algorithm>
#include <cmath>
#include <optional>

namespace wadi {

namespace {

constexpr double LENGTH_MOST = 1e9; // [m]

Status refuse(const std::string& message) { return error(Code::bad_argument, message); }

// Finds the first of some numbers outside its range; NaN is outside every range. Words are put together only when they are
// needed: edits come every frame.
class Ranges {
  public:
    explicit Ranges(const char* function, std::optional<std::size_t> edit = {}) : function_(function), edit_(edit) {}
    std::string path() const {
        const std::string function = *function_ == '\0' ? "" : std::string(function_) + ": ";
        return function + (edit_ ? "edits[" + std::to_string(*edit_) + "]." : "");
    }
    void require(const char* name, double value, double least, double most) {
        if (status_ && !(value >= least && value <= most)) status_ = refuse(outside_text(path() + name, value, least, most));
    }
    template <class Words> void require(bool holds, Words otherwise) {
        if (status_ && !holds) status_ = refuse(path() + otherwise());
    }
    const Status& status() const { return status_; }

  private:
    const char* function_;
    std::optional<std::size_t> edit_;
    Status status_;
};

void check_stamp_edit(Ranges& ranges, const Edit& edit, std::span<const Stamp> stamps, double most) {
    ranges.require("amount", edit.amount, -1e12, 1e12);
    ranges.require(edit.x1 > edit.x0 && edit.y1 > edit.y0, [] { return "x1, y1: not greater than x0, y0"; });
    ranges.require(edit.stamp >= 1 && edit.stamp <= stamps.size(), [&] {
        return "stamp: " + std::to_string(edit.stamp) + " is not one of this world's " + std::to_string(stamps.size());
    });
    if (!ranges.status()) return;
    const auto& stamp = stamps[edit.stamp - 1];
    const double value = static_cast<double>(std::max(std::abs(stamp.least), std::abs(stamp.largest)));
    ranges.require("amount times the image's largest value", value * std::abs(edit.amount), 0, most);
}

void check_shape_edit(Ranges& ranges, const Edit& edit, double most) {
    ranges.require("radius", edit.radius, 1e-9, LENGTH_MOST);
    ranges.require("softness", edit.softness, 0, 1);
    if (edit.kind == EditKind::brush) {
        ranges.require("amount", edit.amount, -most, most);
    } else {
        ranges.require("strength", edit.strength, 0, 1);
        ranges.require("velocity_x", edit.velocity_x, -SPEED_MOST, SPEED_MOST);
        ranges.require("velocity_y", edit.velocity_y, -SPEED_MOST, SPEED_MOST);
    }
}

} // namespace

Status check_edit(const char* function, std::size_t index, const Edit& edit, const Settings& settings,
                  std::span<const Stamp> stamps, std::uint64_t next_step) {
    const double most = 2 * settings.method.largest_height;
    Ranges ranges(function, index);
    ranges.require("x0", edit.x0, -LENGTH_MOST, LENGTH_MOST);
    ranges.require("y0", edit.y0, -LENGTH_MOST, LENGTH_MOST);
    if (edit.capsule || edit.kind == EditKind::stamp) {
        ranges.require("x1", edit.x1, -LENGTH_MOST, LENGTH_MOST);
        ranges.require("y1", edit.y1, -LENGTH_MOST, LENGTH_MOST);
    }
    edit.kind == EditKind::stamp ? check_stamp_edit(ranges, edit, stamps, most) : check_shape_edit(ranges, edit, most);
    ranges.require(edit.step == 0 || edit.step >= next_step, [&] {
        return "step: " + std::to_string(edit.step) + " has been simulated or is under way; the next one is " +
               std::to_string(next_step) + ", or 0";
    });
    if (!ranges.status()) return ranges.status();
    if (auto status = check_allowed(settings, content_brought(edit, stamps)); !status)
        return refuse(ranges.path() + "layer: " + status.message);
    return ok_status();
}

Content content_brought(const Edit& edit, std::span<const Stamp> stamps) {
    if (edit.kind == EditKind::push) return {};
    double most = edit.amount;
    if (edit.kind == EditKind::stamp) {
        const auto& stamp = stamps[edit.stamp - 1];
        most = std::max(static_cast<double>(stamp.largest) * edit.amount, static_cast<double>(stamp.least) * edit.amount);
    }
    return {most > 0 && edit.layer == EditLayer::sand, most > 0 && edit.layer == EditLayer::water};
}

Status check_stamp(const char* function, int nx, int ny, std::span<const float> values) {
    Ranges ranges(function);
    ranges.require("nx", nx, 1, STAMP_MOST);
    ranges.require("ny", ny, 1, STAMP_MOST);
    const auto pixels = static_cast<std::int64_t>(nx) * ny;
    ranges.require(static_cast<std::int64_t>(values.size()) == pixels, [&] {
        return "values: " + std::to_string(values.size()) + " for " + std::to_string(nx) + " x " + std::to_string(ny) + " pixels";
    });
    if (!ranges.status()) return ranges.status();
    const auto bad = std::find_if(values.begin(), values.end(), [](float v) { return !(std::abs(v) <= 1e12F); });
    if (bad != values.end())
        ranges.require(("values[" + std::to_string(bad - values.begin()) + "]").c_str(), static_cast<double>(*bad), -1e12, 1e12);
    return ranges.status();
}

bool pack_edit(const Edit& edit, std::span<const Stamp> stamps, const Grid& grid, vec4* to) {
    const auto f = [](double x) { return static_cast<float>(x); };
    // Whole 1/256 cells: distances to cell centres are then exact (shaders/physics/edit.glsl).
    const auto cells = [&](double metres) { return std::nearbyint(metres / grid.dx * 256) / 256; };
    const bool is_stamp = edit.kind == EditKind::stamp, line = is_stamp || edit.capsule;
    const double x = cells(edit.x0), y = cells(edit.y0), along_x = line ? cells(edit.x1) - x : 0,
                 along_y = line ? cells(edit.y1) - y : 0;
    const double radius = is_stamp ? 0 : edit.radius / grid.dx;
    if (std::max(x, x + along_x) + radius < 0 || std::min(x, x + along_x) - radius > grid.nx ||
        std::max(y, y + along_y) + radius < 0 || std::min(y, y + along_y) - radius > grid.ny)
        return false;
    const float kind = static_cast<float>(edit.kind), layer = static_cast<float>(edit.layer);
    to[0] = {f(x), f(y), f(along_x), f(along_y)};
    if (is_stamp) {
        if (along_x <= 0 || along_y <= 0) return false; // narrower than 1/256 cell
        const auto& stamp = stamps[edit.stamp - 1];
        to[1] = {f(stamp.nx), f(stamp.ny), static_cast<float>(stamp.page), kind};
        to[2] = {f(edit.amount), layer, f(stamp.nx / along_x), f(stamp.ny / along_y)};
        return true;
    }
    const double length2 = along_x * along_x + along_y * along_y;
    constexpr double sharp = 1e30; // no falloff: weight 1 up to the radius
    to[1] = {f(radius), edit.softness > 0 ? f(std::min(sharp, 1 / (edit.softness * radius))) : f(sharp),
             length2 > 0 ? f(1 / length2) : 0.0F, kind};
    if (edit.kind == EditKind::brush) {
        to[2] = {f(edit.amount), layer, 0, 0};
    } else {
        to[2] = {f(edit.strength), f(edit.velocity_x), f(edit.velocity_y), 0};
    }
    return true;
}

} // namespace wadi
