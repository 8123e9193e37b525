#include "script.hpp"
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <imgui.h>
#include <sstream>
#include <stdexcept>

namespace viewer {
namespace {

/// Commands and how many words follow.
const std::map<std::string, std::size_t> commands = {
    {"pointer", 2},  {"press", 1},   {"release", 1},     {"wheel", 1},      {"key", 1},    {"tool", 1},     {"radius", 1},
    {"strength", 1}, {"rate", 1},    {"height", 1},      {"wet", 1},        {"stamp", 1},  {"numbers", 0},  {"preset", 1},
    {"hold", 1},     {"scale", 0},   {"write-world", 0}, {"message", 0},    {"close", 0},  {"speed", 1},    {"pause", 0},
    {"resume", 0},   {"step", 0},    {"restart", 0},     {"screenshot", 0}, {"record", 1}, {"view", 1},     {"quality", 1},
    {"arrows", 0},   {"section", 4}, {"backend", 1},     {"level", 2},      {"undo", 0},   {"redo", 0},     {"scrub", 1},
    {"save", 0},     {"load", 0},    {"replay", 0},      {"print", 0},      {"resize", 2}, {"minimise", 0}, {"restore", 0},
    {"material", 2}, {"effect", 2},  {"accuracy", 1},    {"device", 1},     {"budget", 2}, {"pad", 7},
};

std::size_t button_number(const std::string& name) {
    for (std::size_t n = 0; n < 3; ++n) {
        if (name == (const char*[]){"left", "right", "middle"}[n]) return n;
    }
    throw std::runtime_error("script: button \"" + name + "\" is none of left, right, middle");
}

/// A letter, "Tab", "Escape", "F1" ... "F12"; "ctrl+" ahead of it is heeded by the caller.
int key_number(const std::string& name) {
    if (name.size() == 1) return static_cast<unsigned char>(name[0]);
    if (name == "Tab") return GLFW_KEY_TAB;
    if (name == "Escape") return GLFW_KEY_ESCAPE;
    for (int n = 1; n <= 12; ++n) {
        if (name == "F" + std::to_string(n)) return GLFW_KEY_F1 + n - 1;
    }
    throw std::runtime_error("script: key \"" + name + "\" is no letter, Tab, Escape or F1 ... F12, with or without ctrl+ ahead");
}

void close_springs(Session& session) {
    for (Spring spring : session.tools.springs()) {
        spring.rate = 0;
        session.tools.change(spring);
    }
}

void print_state(Session& session) {
    wadi_world_stats stats = wadi_default_world_stats();
    check(wadi_world_get_stats(session.simulation().world, &stats), "statistics");
    const Simulation& simulation = session.simulation();
    std::vector<float> heights(static_cast<std::size_t>(simulation.info.nx) * static_cast<std::size_t>(simulation.info.ny));
    check(wadi_world_read_field(simulation.world, WADI_FIELD_TERRAIN, heights.data(), heights.size()), "reading the ground");
    double ground = 0; // [m3]
    for (float height : heights) ground += static_cast<double>(height) * simulation.info.dx * simulation.info.dx;
    std::printf(
        "state step %llu sand %.6f water %.6f sand_in %.6f water_in %.6f water_out %.6f kept %zu hash %016llx ground %.6f\n",
        static_cast<unsigned long long>(stats.steps), stats.sand_volume, stats.water_volume, stats.sand_in, stats.water_in,
        stats.water_out, session.history().kept_states(), static_cast<unsigned long long>(stats.hash), ground);
    std::fflush(stdout);
}

void run(const Script::Line& line, Session& session) {
    const std::string& command = line.command;
    const auto number = [&](std::size_t n) { return std::stof(line.words[n]); };
    if (command == "tool") {
        for (std::size_t n = 0; n < std::size(tool_names); ++n) {
            std::string name = tool_names[n];
            for (char& c : name) c = c == ' ' ? '-' : c;
            if (name == line.words[0]) {
                session.tools.tool = static_cast<Tool>(n);
                return;
            }
        }
        throw std::runtime_error("script: unknown tool \"" + line.words[0] + "\"");
    }
    Brush& brush = session.tools.brush;
    if (command == "radius") brush.radius = number(0);
    if (command == "rate") brush.rate = number(0);
    if (command == "height") brush.height = number(0);
    if (command == "strength") brush.strength = number(0);
    if (command == "wet") brush.wetness = number(0);
    if (command == "stamp") session.tools.set_stamp(line.words[0]);
    if (command == "numbers") std::printf("numbers %s\n", session.tools.footprint().numbers.c_str());
    if (command == "preset") session.set_preset(line.words[0]);
    if (command == "close") close_springs(session);
    if (command == "speed") session.speed = number(0);
    if (command == "pause") session.paused = true;
    if (command == "resume") session.paused = false;
    if (command == "step") session.single_step();
    if (command == "restart") session.restart();
    if (command == "screenshot") session.screenshot();
    if (command == "record") session.set_recording(line.words[0] == "on");
    if (command == "view") {
        session.picture.view = view_number(line.words[0]);
        session.picture.low = views()[static_cast<std::size_t>(session.picture.view)].low;
        session.picture.high = views()[static_cast<std::size_t>(session.picture.view)].high;
    }
    if (command == "quality") session.picture.quality = quality_preset(line.words[0]);
    if (command == "arrows") session.picture.arrows = true;
    if (command == "section") {
        session.picture.section.ends = {number(0), number(1), number(2), number(3)};
        session.picture.section.shown = true;
    }
    if (command == "backend") {
        SimulationChoice choice = session.choice();
        choice.backend = line.words[0];
        session.open(session.level_name, choice);
    }
    if (command == "device") {
        SimulationChoice choice = session.choice();
        choice.device = std::stoi(line.words[0]);
        session.open(session.level_name, choice);
    }
    if (command == "accuracy") {
        SimulationChoice choice = session.choice();
        choice.accuracy = line.words[0];
        session.open(session.level_name, choice);
    }
    if (command == "level") {
        SimulationChoice choice = session.choice();
        choice.level_file = line.words[1];
        choice.text.clear();
        choice.variant.clear();
        session.open(line.words[0], choice);
    }
    if (command == "budget") { // milliseconds, minutes
        session.budget_ms = number(0);
        session.find_settings(std::stod(line.words[1]));
        session.budget().wait();
        session.take_settings();
        std::printf("budget %s\n", session.found_settings.c_str());
    }
    if (command == "material") session.set_material(line.words[0], std::stod(line.words[1]));
    if (command == "effect") session.switch_effect(line.words[0], line.words[1] == "on");
    if (command == "undo") session.undo();
    if (command == "redo") session.redo();
    if (command == "scrub") session.go_to(std::stoull(line.words[0]));
    if (command == "save") session.save();
    if (command == "load") session.load();
    if (command == "replay") std::printf("replay %s\n", session.history().replay().c_str());
    if (command == "hold") session.render_scale.target = std::stod(line.words[0]);
    if (command == "scale") std::printf("scale %g\n", static_cast<double>(session.render_scale.value()));
    if (command == "write-world") session.write_world();
    if (command == "message") {
        std::printf("message %s\n", session.message.c_str());
        std::fflush(stdout);
    }
    if (command == "print") print_state(session);
}

} // namespace

Script::Script(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!stream) throw std::runtime_error("script: cannot read " + file.string());
    std::string text;
    for (int row = 1; std::getline(stream, text); ++row) {
        std::istringstream words(text.substr(0, text.find('#')));
        std::string first, word;
        if (!(words >> first)) continue;
        const std::string where = file.string() + ", line " + std::to_string(row) + ": ";
        Line line;
        words >> line.command;
        while (words >> word) line.words.push_back(word);
        if (first.find_first_not_of("0123456789") != std::string::npos)
            throw std::runtime_error(where + "a line begins with a frame number, not \"" + first + "\"");
        const auto known = commands.find(line.command);
        if (known == commands.end()) throw std::runtime_error(where + "unknown command \"" + line.command + "\"");
        if (known->second != line.words.size())
            throw std::runtime_error(where + line.command + " takes " + std::to_string(known->second) + " words");
        frames_[std::stoull(first)].push_back(line);
    }
}

std::vector<Script::Line> Script::lines(uint64_t frame, const std::string& command) const {
    std::vector<Line> found;
    const auto at = frames_.find(frame);
    if (at == frames_.end()) return found;
    for (const Line& line : at->second) {
        if (line.command == command) found.push_back(line);
    }
    return found;
}

void Script::apply_input(uint64_t frame) {
    if (empty()) return;
    ImGuiIO& io = ImGui::GetIO();
    for (const Line& line : lines(frame, "pointer")) {
        x_ = std::stof(line.words[0]);
        y_ = std::stof(line.words[1]);
    }
    for (const Line& line : lines(frame, "press")) down_[button_number(line.words[0])] = true;
    for (const Line& line : lines(frame, "release")) down_[button_number(line.words[0])] = false;
    for (const Line& line : lines(frame, "wheel")) io.MouseWheel += std::stof(line.words[0]);
    if (x_ >= 0) io.MousePos = ImVec2(x_, y_);
    for (int n = 0; n < 3; ++n) {
        if (x_ >= 0) io.MouseDown[n] = down_[n];
    }
    // A key is down for one frame.
    const auto set_keys = [&](uint64_t at, bool down) {
        for (const Line& line : lines(at, "key")) {
            const bool with_control = line.words[0].starts_with("ctrl+");
            io.KeysDown[key_number(line.words[0].substr(with_control ? 5 : 0))] = down;
            if (with_control) io.KeyCtrl = down;
        }
    };
    if (frame > 0) set_keys(frame - 1, false);
    set_keys(frame, true);
}

// Both sticks, both triggers, and letters of what is pressed, "-" for nothing.
Pad Script::pad(uint64_t frame) const {
    Pad pad;
    for (auto at = frames_.upper_bound(frame); at != frames_.begin();) {
        --at;
        const auto line =
            std::find_if(at->second.rbegin(), at->second.rend(), [](const Line& one) { return one.command == "pad"; });
        if (line == at->second.rend()) continue;
        const auto axis = [&](std::size_t n) { return std::stof(line->words[n]); };
        const auto pressed = [&](char letter) { return line->words[6].find(letter) != std::string::npos; };
        pad = {axis(0),      axis(1),      axis(2),      axis(3),      axis(4),      axis(5),
               pressed('a'), pressed('u'), pressed('r'), pressed('p'), pressed('<'), pressed('>')};
        break;
    }
    return pad;
}

void Script::apply_commands(uint64_t frame, Session& session) const {
    const auto at = frames_.find(frame);
    if (at == frames_.end()) return;
    for (const Line& line : at->second) run(line, session);
}

} // namespace viewer
