#include "tools.hpp"
#include "sculpt.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace viewer {
namespace {

constexpr double SOFT = 1, WALL_SOFT = 0.25; // shares of the radius over which a brush falls to 0
constexpr int MOST_STAMP_CELLS = 1024;
constexpr double PI = 3.14159265358979323846;

std::string text_of(const char* format, double a, double b, double c, double d = 0) {
    char text[160];
    std::snprintf(text, sizeof(text), format, a, b, c, d);
    return text;
}

/// Share of sand's volume that water can fill.
double porosity(const Simulation& simulation) {
    uint32_t count = 0;
    check(wadi_world_get_material(simulation.world, nullptr, &count), "the material");
    std::vector<wadi_material_info> infos(count);
    check(wadi_world_get_material(simulation.world, infos.data(), &count), "the material");
    for (const wadi_material_info& info : infos) {
        if (std::strcmp(info.name, "porosity") == 0) return info.value;
    }
    return 1;
}

} // namespace

double brush_volume(double radius, double softness, double length) {
    constexpr int parts = 64;
    double disc = 0, across = 0;
    for (int n = 0; n < parts; ++n) {
        const double r = (n + 0.5) / parts;
        const double s = softness > 0 ? std::clamp((1 - r) / softness, 0.0, 1.0) : 1;
        const double height = s * s * (3 - 2 * s);
        disc += 2 * PI * r * height / parts;
        across += 2 * height / parts;
    }
    return disc * radius * radius + across * radius * length;
}

const char* tool_help(Tool tool) {
    static const char* const help[] = {"turns the view",
                                       "pours water while the button is down",
                                       "pours sand, as wet as you say",
                                       "takes sand away; water in it stays",
                                       "lets sand run from high to low; none is made or lost",
                                       "brings sand to the height at which you pressed",
                                       "drag: a wall of sand from press to release",
                                       "presses a castle, cone, crater, ring or a picture of heights onto the sand",
                                       "a source of water, until you close it below",
                                       "takes water away, until you close it below",
                                       "drags sand and water along",
                                       "takes water away while the button is down",
                                       "raises the ground under sand and water",
                                       "lowers the ground under sand and water",
                                       "drag: the line of the profile"};
    static_assert(std::size(help) == std::size(tool_names));
    return help[static_cast<std::size_t>(tool)];
}

void Tools::enter(Simulation& simulation, History& history, bool other_level) {
    simulation_ = &simulation;
    history_ = &history;
    stamps_.clear();
    if (stamp_.empty()) set_stamp(built_in_stamps().front());
    place_ = begun_ = last_ = std::nullopt;
    pressed_ = false;
    first_spring_ = static_cast<uint32_t>(simulation.info.source_count);
    if (!other_level) return;
    const glm::vec2 lengths = simulation.grid.lengths();
    brush.radius = 0.04f * std::max(lengths.x, lengths.y);
    brush.rate = 0.5f * brush.radius;
    brush.height = 0.5f * brush.radius;
}

void Tools::point(std::optional<glm::vec3> place, bool pressed) {
    if (pressed && !pressed_) {
        begun_ = place;
        done_ = false;
        poured_ = 0;
    }
    pressed_ = pressed && begun_;
    if (place || !pressed) place_ = place;
}

void Tools::begin() { history_->begin(tool_names[static_cast<std::size_t>(tool)]); }

void Tools::edit(std::vector<wadi_edit> edits) {
    begin();
    check(wadi_world_edit(simulation_->world, edits.data(), static_cast<uint32_t>(edits.size())),
          tool_names[static_cast<std::size_t>(tool)]);
}

wadi_edit Tools::brushed(wadi_layer layer, glm::vec2 from, glm::vec2 to, double amount, double softness) const {
    wadi_edit edit = wadi_default_edit();
    edit.layer = layer;
    edit.capsule = 1;
    edit.x0 = static_cast<double>(from.x);
    edit.y0 = static_cast<double>(from.y);
    edit.x1 = static_cast<double>(to.x);
    edit.y1 = static_cast<double>(to.y);
    edit.radius = static_cast<double>(brush.radius);
    edit.softness = softness;
    edit.amount = amount;
    return edit;
}

void Tools::add_sand(std::vector<wadi_edit>& edits, wadi_edit sand) const {
    edits.push_back(sand);
    if (brush.wetness <= 0) return;
    sand.layer = WADI_LAYER_WATER;
    sand.amount *= static_cast<double>(brush.wetness) * porosity(*simulation_);
    edits.push_back(sand);
}

bool Tools::act(double seconds) {
    const bool up = !pressed_ && begun_;
    bool acted = false;
    if (up && tool == Tool::wall && place_) acted = raise_wall();
    if (up) begun_ = last_ = std::nullopt;
    if (!pressed_ || !place_ || tool == Tool::look || tool == Tool::section) return acted;
    acted = stroke(seconds);
    last_ = place_;
    return acted;
}

bool Tools::stroke(double seconds) {
    const glm::vec2 to(*place_), from(last_.value_or(*place_));
    const double amount = static_cast<double>(brush.rate) * seconds;
    std::vector<wadi_edit> edits;
    switch (tool) {
    case Tool::water:
        edits.push_back(brushed(WADI_LAYER_WATER, from, to, amount, SOFT));
        break;
    case Tool::sand:
        add_sand(edits, brushed(WADI_LAYER_SAND, from, to, amount, SOFT));
        break;
    case Tool::dig:
        edits.push_back(brushed(WADI_LAYER_SAND, from, to, -amount, SOFT));
        break;
    case Tool::scoop:
        edits.push_back(brushed(WADI_LAYER_WATER, from, to, -amount, SOFT));
        break;
    case Tool::raise:
    case Tool::lower:
        edits.push_back(brushed(WADI_LAYER_TERRAIN, from, to, tool == Tool::raise ? amount : -amount, SOFT));
        break;
    case Tool::push: {
        wadi_edit edit = brushed(WADI_LAYER_SAND, from, to, 0, SOFT);
        edit.kind = WADI_EDIT_PUSH;
        edit.strength = static_cast<double>(std::clamp(brush.strength, 0.0f, 1.0f));
        edit.velocity_x = (edit.x1 - edit.x0) / std::max(seconds, 1e-3);
        edit.velocity_y = (edit.y1 - edit.y0) / std::max(seconds, 1e-3);
        edits.push_back(edit);
        break;
    }
    case Tool::smooth:
        begin();
        smooth_sand(*simulation_, to, brush.radius, std::min(0.2f, 6 * static_cast<float>(seconds)));
        return true;
    case Tool::flatten:
        begin();
        if (!last_) level_ = surface_at(*simulation_, to);
        poured_ += flatten_sand(*simulation_, to, brush.radius, level_, static_cast<float>(amount));
        return true;
    case Tool::stamp:
    case Tool::spring:
    case Tool::drain:
        return !std::exchange(done_, true) && press_once();
    default:
        return false;
    }
    poured_ += edits.front().amount * brush_volume(edits.front().radius, SOFT, static_cast<double>(glm::distance(from, to)));
    edit(edits);
    return true;
}

bool Tools::press_once() {
    if (tool == Tool::stamp) {
        wadi_edit edit = wadi_default_edit();
        edit.kind = WADI_EDIT_STAMP;
        edit.layer = WADI_LAYER_SAND;
        edit.stamp = made_stamp();
        const double side = stamp_cells() * simulation_->info.dx;
        edit.x0 = static_cast<double>(stamp_corner().x);
        edit.y0 = static_cast<double>(stamp_corner().y);
        edit.x1 = edit.x0 + side;
        edit.y1 = edit.y0 + side;
        edit.amount = static_cast<double>(brush.height);
        std::vector<wadi_edit> edits;
        add_sand(edits, edit);
        this->edit(edits);
    } else {
        begin();
        const float rate = tool == Tool::spring ? brush.rate : -brush.rate;
        set_spring(*simulation_, {free_spring(*simulation_, first_spring_), false, glm::vec2(*place_), brush.radius, rate});
    }
    return true;
}

bool Tools::raise_wall() {
    std::vector<wadi_edit> edits;
    add_sand(edits,
             brushed(WADI_LAYER_SAND, glm::vec2(*begun_), glm::vec2(*place_), static_cast<double>(brush.height), WALL_SOFT));
    edit(edits);
    history_->close();
    return true;
}

void Tools::set_stamp(const std::string& name_or_file) {
    image_ = stamp_image(name_or_file);
    stamp_ = name_or_file;
    stamps_.clear();
}

int Tools::stamp_cells() const {
    return std::clamp(static_cast<int>(std::lround(2 * brush.radius / simulation_->grid.dx)), 2, MOST_STAMP_CELLS);
}

glm::vec2 Tools::stamp_corner() const {
    const float dx = simulation_->grid.dx;
    return glm::round(glm::vec2(*place_) / dx - 0.5f * static_cast<float>(stamp_cells())) * dx;
}

uint32_t Tools::made_stamp() {
    if (const auto known = stamps_.find(stamp_cells()); known != stamps_.end()) return known->second;
    const StampImage image = image_.of_cells(stamp_cells());
    uint32_t number = 0;
    check(wadi_world_create_stamp(simulation_->world, image.nx, image.ny, image.values.data(), &number), "the stamp");
    return stamps_[stamp_cells()] = number;
}

void Tools::change(const Spring& spring) {
    history_->begin("spring " + std::to_string(spring.index));
    set_spring(*simulation_, spring);
}

Footprint Tools::footprint() const {
    Footprint footprint;
    if (!place_ || tool == Tool::look || tool == Tool::section) return footprint;
    footprint.shape = Footprint::Shape::capsule;
    footprint.from = footprint.to = glm::vec2(*place_);
    footprint.radius = brush.radius;
    const auto radius = static_cast<double>(brush.radius), rate = static_cast<double>(brush.rate),
               height = static_cast<double>(brush.height);
    const double area = PI * radius * radius;
    switch (tool) {
    case Tool::wall: {
        footprint.height = brush.height;
        if (pressed_) footprint.from = glm::vec2(*begun_);
        const auto length = static_cast<double>(glm::distance(footprint.from, footprint.to));
        footprint.numbers = text_of("wall %.2f m long, %.2f m high: %.2f m3", length + 2 * radius, height,
                                    height * brush_volume(radius, WALL_SOFT, length));
        break;
    }
    case Tool::stamp: {
        const float side = static_cast<float>(stamp_cells()) * simulation_->grid.dx;
        const auto length = static_cast<double>(side);
        footprint.shape = Footprint::Shape::square;
        footprint.radius = 0.5f * side;
        footprint.from = footprint.to = stamp_corner() + footprint.radius;
        footprint.height = brush.height;
        const glm::vec2 low = -stamp_corner() / side, high = low + simulation_->grid.lengths() / side; // the world's rim
        footprint.numbers = text_of("%.2f x %.2f m, %.2f m high: %.2f m3", length, length, height,
                                    length * length * height * image_.mean(low, high));
        break;
    }
    case Tool::spring:
    case Tool::drain:
        footprint.numbers = text_of("%.2f m/s over %.2f m2: %.2f m3/s", rate, area, rate * area);
        break;
    case Tool::smooth:
    case Tool::push:
        footprint.numbers = text_of("over %.2f m2", area, 0, 0);
        break;
    case Tool::flatten:
        footprint.numbers = text_of(poured_ != 0 ? "to %.2f m over %.2f m2; so far %+.2f m3" : "to the height of where you press",
                                    static_cast<double>(level_), area, poured_);
        break;
    default:
        footprint.numbers = text_of("%.2f m/s over %.2f m2: %.2f m3/s; this stroke %+.2f m3", rate, area,
                                    rate * brush_volume(radius, SOFT, 0), poured_);
    }
    return footprint;
}

} // namespace viewer
