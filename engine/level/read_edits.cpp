#include "engine/level/layers.hpp"
#include "engine/level/settings_reader.hpp"
#include "engine/settings/data/setting_table.hpp"
#include <cstddef>

namespace wadi {
namespace {

constexpr double RADIUS_LEAST = 1e-9;    // as wadi_edit
constexpr double AMOUNT_READ_MOST = 2e6; // validate() knows method.largest_height

void require_point(ObjectReader& reader, const char* key, double& x, double& y) {
    Point point = {0, 0};
    if (reader.require(key) != nullptr) reader.pair(key, point, -POSITION_MOST, POSITION_MOST);
    x = point[0];
    y = point[1];
}

void read_times(ObjectReader& reader, ScriptedEdit& script) {
    reader.required_number("time", script.time, 0, EDIT_TIME_MOST);
    const bool every = reader.find("every") != nullptr;
    if (every != (reader.find("until") != nullptr)) reader.require(every ? "until" : "every");
    reader.number("every", script.every, EDIT_EVERY_LEAST, EDIT_TIME_MOST);
    reader.number("until", script.until, script.time, EDIT_TIME_MOST);
    if (every) reader.pair("move", script.move, -SPEED_MOST, SPEED_MOST); // without, nothing could move
}

void read_shape(ObjectReader& reader, Edit& edit) {
    int shape = 0;
    reader.require("shape");
    reader.choice("shape", {"disc", "capsule"}, shape);
    edit.capsule = shape == 1;
    if (reader.failed()) return;
    require_point(reader, edit.capsule ? "from" : "center", edit.x0, edit.y0);
    if (edit.capsule) require_point(reader, "to", edit.x1, edit.y1);
    reader.required_number("radius", edit.radius, RADIUS_LEAST, POSITION_MOST);
    edit.softness = 0.5;
    reader.number("softness", edit.softness, 0, 1);
}

void read_effect(ObjectReader& reader, Edit& edit) {
    int kind = 0;
    reader.choice("kind", {"brush", "push"}, kind);
    if (kind == 0) {
        int layer = 0;
        reader.require("layer");
        reader.choice("layer", {"terrain", "sand", "water"}, layer);
        edit.layer = static_cast<EditLayer>(layer);
        reader.required_number("amount", edit.amount, -AMOUNT_READ_MOST, AMOUNT_READ_MOST);
        return;
    }
    edit.kind = EditKind::push;
    edit.strength = 1;
    reader.number("strength", edit.strength, 0, 1);
    Point velocity = {0, 0};
    if (reader.require("velocity") != nullptr) reader.pair("velocity", velocity, -SPEED_MOST, SPEED_MOST);
    edit.velocity_x = velocity[0];
    edit.velocity_y = velocity[1];
}

} // namespace

std::vector<ScriptedEdit> read_edits(const Json& value, Status& status) {
    std::vector<ScriptedEdit> scripts;
    const auto elements = read_array(value, "edits", EDITS_MOST, status);
    for (std::size_t n = 0; n < elements.size() && status; ++n) {
        ScriptedEdit script;
        ObjectReader reader(*elements[n], "edits[" + std::to_string(n) + "]", status);
        read_times(reader, script);
        read_effect(reader, script.edit);
        read_shape(reader, script.edit);
        reader.finish();
        scripts.push_back(script);
    }
    return scripts;
}

} // namespace wadi
