#include "stage_file.hpp"
#include "engine/settings/effects.hpp"
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

namespace stagec {
namespace {
const std::set<std::string> extents = {"CELLS",  "FACES", "RIM",       "STRIPS",    "SOURCE_BOX",
                                       "POINTS", "TILES", "TILE_ROWS", "TILE_LINES"};

// "i - 1" and its like widen the reach along an axis; of anything else REACH must tell.
void widen(int& low, int& high, const std::string& index, char axis) {
    if (index.empty() || index[0] != axis || (index.size() > 1 && index[1] != '-' && index[1] != '+')) return;
    const int offset = index.size() > 1 ? std::atoi(index.c_str() + 1) : 0;
    low = std::max(low, -offset);
    high = std::max(high, offset);
}

} // namespace

void fail(const std::string& message) {
    std::cerr << "stagec: " << message << "\n";
    std::exit(1);
}

std::string read_text(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) fail("cannot read " + path);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

void write_text(const std::string& path, const std::string& text) {
    std::ofstream out(path, std::ios::binary);
    out << text;
    if (!out) fail("cannot write " + path);
}

std::string stem(const std::string& path) {
    const auto slash = path.find_last_of('/');
    const std::string file = slash == std::string::npos ? path : path.substr(slash + 1);
    return file.substr(0, file.find('.'));
}

std::string strip_comments(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '/' && i + 1 < text.size() && text[i + 1] == '/') {
            while (i < text.size() && text[i] != '\n') ++i;
        }
        if (i < text.size()) out += text[i];
    }
    return out;
}

std::string word_at(const std::string& text, std::size_t at) {
    std::size_t end = at;
    while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_')) ++end;
    return text.substr(at, end - at);
}

std::set<std::string> effects_in(const std::string& expression) {
    std::set<std::string> found;
    for (std::size_t at = 0; (at = expression.find("EFFECT_", at)) != std::string::npos;) {
        const std::string name = word_at(expression, at);
        found.insert(name);
        at += name.size();
    }
    return found;
}

std::vector<std::string> arguments(const std::string& text, std::size_t at) {
    while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at]))) ++at;
    if (at >= text.size() || text[at] != '(') return {};
    std::vector<std::string> result(1);
    int depth = 1;
    for (++at; at < text.size(); ++at) {
        const char c = text[at];
        if (c == '(') ++depth;
        if (c == ')' && --depth == 0) return result;
        if (c == ',' && depth == 1) {
            result.emplace_back();
        } else if (!std::isspace(static_cast<unsigned char>(c))) {
            result.back() += c;
        }
    }
    fail("unbalanced parenthesis");
}

Stage parse_stage(const std::string& path) {
    Stage stage;
    stage.path = path;
    stage.name = stem(path);
    const std::string text = strip_comments(read_text(path));
    std::set<std::string> tested;
    const auto note_effects = [&](const std::string& expression) { tested.merge(effects_in(expression)); };
    std::size_t at = 0;
    bool grid = false;
    while (at < text.size()) {
        if (!std::isalpha(static_cast<unsigned char>(text[at]))) {
            ++at;
            continue;
        }
        const std::string word = word_at(text, at);
        at += word.size();
        const std::size_t end = at;
        const bool conditional = word == "IN_IF" || word == "OUT_IF" || word == "INOUT_IF";
        if (word == "STAGE") {
            stage.struct_name = arguments(text, end).at(0);
        } else if (word == "EXTENT") {
            stage.extent = arguments(text, end).at(0);
            grid = stage.extent == "CELLS" || stage.extent == "FACES";
        } else if (word == "REACH") {
            const int n = std::atoi(arguments(text, end).at(0).c_str());
            stage.reach = {n, n, n, n};
        } else if (word == "FAR_IF") {
            stage.far = arguments(text, end).at(0);
        } else if (word == "IDX" && grid) {
            const auto a = arguments(text, end);
            widen(stage.reach.west, stage.reach.east, a.at(0), 'i');
            widen(stage.reach.south, stage.reach.north, a.at(1), 'j');
        } else if (word == "HAS") {
            note_effects(arguments(text, end).at(0));
        } else if (conditional || word == "IN" || word == "OUT" || word == "INOUT") {
            const auto a = arguments(text, end);
            if (a.size() != (conditional ? 4u : 3u))
                fail(path + ": " + word + " takes " + (conditional ? "(EFFECTS, slot, type, name)" : "(slot, type, name)"));
            Binding b;
            const std::size_t shift = conditional ? 1 : 0;
            b.condition = conditional ? a[0] : "0u";
            note_effects(b.condition);
            b.slot = std::atoi(a[shift].c_str());
            b.type = a[shift + 1];
            b.name = a[shift + 2];
            b.access = word.substr(0, word.find('_'));
            if (b.narrow()) tested.insert(half_storage);
            if (b.slot != static_cast<int>(stage.bindings.size()))
                fail(path + ": slot of " + b.name + " is " + a[shift] + ", expected " + std::to_string(stage.bindings.size()));
            stage.bindings.push_back(b);
        }
    }
    if (stage.struct_name.empty()) fail(path + ": no STAGE(Name)");
    if (!extents.count(stage.extent))
        fail(path + ": EXTENT must be CELLS, FACES, RIM, STRIPS, SOURCE_BOX, POINTS, TILES, TILE_ROWS or TILE_LINES");
    for (const int n : {stage.reach.west, stage.reach.south, stage.reach.east, stage.reach.north})
        if (n > 2) fail(path + ": reads more than 2 cells away, the width of the ghosts");
    stage.tested.assign(tested.begin(), tested.end());
    return stage;
}

std::string include_path(const Stage& stage) { return stage.path.substr(stage.path.rfind("stages/")); }

std::string find_stage(const std::string& folder, const std::string& name, const std::string& asker) {
    for (const auto& room : std::filesystem::directory_iterator(folder)) {
        const auto path = room.path() / (name + ".stage");
        if (std::filesystem::is_regular_file(path)) return path.lexically_normal().generic_string();
    }
    fail(asker + ": no stage " + name);
}

Effects parse_effects(const std::string& path) {
    Effects effects;
    std::istringstream in(read_text(path));
    std::string define, name, value;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        if (words >> define >> name >> value && define == "#define" && name.rfind("EFFECT_", 0) == 0) {
            effects[name] = static_cast<unsigned>(std::strtoul(value.c_str(), nullptr, 10));
        }
    }
    return effects;
}

unsigned effect_bits(const std::string& expression, const Effects& effects, const std::string& path) {
    unsigned bits = 0;
    for (const auto& name : effects_in(expression)) {
        const auto found = effects.find(name);
        if (found == effects.end()) fail(path + ": unknown effect " + name);
        bits |= found->second;
    }
    return bits;
}

unsigned tested_bits(const Stage& stage, const Effects& effects) {
    unsigned bits = 0;
    for (const auto& name : stage.tested) bits |= effect_bits(name, effects, stage.path);
    return bits;
}

std::vector<unsigned> masks(unsigned tested, unsigned needs, unsigned without) {
    std::vector<unsigned> result;
    unsigned mask = 0;
    do {
        const unsigned least = wadi::with_needs(mask | needs); // of the worlds that have these bits
        if ((least & tested) == mask && (least & without) == 0 && wadi::is_legal(least)) result.push_back(mask);
        mask = (mask - tested) & tested;
    } while (mask != 0);
    return result;
}

std::vector<unsigned> largest(const std::vector<unsigned>& masks, unsigned apart) {
    std::vector<unsigned> result;
    for (const unsigned mask : masks) {
        const bool included = std::any_of(masks.begin(), masks.end(), [&](unsigned other) {
            return other != mask && (other & mask) == mask && (other & apart) == (mask & apart);
        });
        if (!included) result.push_back(mask);
    }
    return result;
}

} // namespace stagec
