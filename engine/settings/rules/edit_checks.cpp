#include "engine/settings/rules/edit_checks.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/messages.hpp"
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

void Stamp::set_range() {
    if (values.empty()) return;
    const auto found = std::minmax_element(values.begin(), values.end());
    least = *found.first;
    largest = *found.second;
}

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

} // namespace wadi
