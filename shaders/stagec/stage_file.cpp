#include "stage_file.hpp"
#include "repeats.hpp"
#include "shaders/effect_rows.hpp"
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <sstream>

namespace stagec {
namespace {

const std::set<std::string> extents = {"CELLS",        "FACES",  "RIM",   "STRIPS",    "SOURCE_PIECES",
                                       "SOURCE_CELLS", "POINTS", "TILES", "TILE_ROWS", "TILE_LINES"};
const std::set<std::string> types = {"float", "uint", "int", "vec2", "vec4", "uvec2"};

std::string joined(const std::set<std::string>& words) {
    std::string text;
    for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
}

// shaders/, from the path of a file in it.
std::string shaders_of(const std::string& path) {
    const auto at = path.rfind("stages/");
    if (at == std::string::npos) fail(path + ": not in a folder stages/");
    return path.substr(0, at);
}

// What the #include lines of a file bring, files that those include as well.
std::string included(const std::string& shaders, const std::string& text, std::set<std::string>& seen) {
    std::string all;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const auto at = line.find("physics/");
        if (!line.starts_with("#include") || at == std::string::npos) continue;
        const std::string path = shaders + line.substr(at, line.rfind('"') - at);
        if (!seen.insert(path).second) continue;
        const std::string inner = read_source(path).text;
        all += included(shaders, inner, seen) + inner;
    }
    return all;
}

void note_defines(const std::string& text, std::set<std::string>& known) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string define, name;
        if (words >> define >> name && define == "#define") known.insert(word_at(name, 0));
    }
}

bool upper_case(const std::string& word) {
    const auto upper = [](char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; };
    const auto fits = [&](char c) { return upper(c) || c == '_' || std::isdigit(static_cast<unsigned char>(c)) != 0; };
    return word.size() > 1 && std::count_if(word.begin(), word.end(), upper) > 1 && std::all_of(word.begin(), word.end(), fits);
}

// Words in capitals belong to the language, to step_params.h and effects.h, or to what the stage includes.
void check_words(const Source& source, const std::string& shaders, const std::string& reads) {
    static const std::set<std::string> language = {
        "STAGE",  "END_STAGE", "EXTENT",  "REACH",         "FAR_IF",       "IN",          "OUT",    "INOUT",        "IN_IF",
        "OUT_IF", "INOUT_IF",  "HAS",     "UNIFORM",       "FN",           "REF",         "HELPER", "HELPER_CONST", "KERNEL",
        "IDX",    "EACH_AXIS", "EACH_OF", "EMPTY_WITHOUT", "EMPTY_WRITES", "LEAN_WITHOUT"};
    std::set<std::string> known = language;
    known.insert(extents.begin(), extents.end());
    for (const char* header : {"step_params.h", "effects.h"}) note_defines(read_text(shaders + header), known);
    note_defines(reads + source.text, known);
    for_each_word(source.text, [&](const std::string& word, std::size_t at) {
        if (upper_case(word) && !known.count(word)) source.fail(at, word + " is no word of the stage language");
    });
}

// "i - 1" and its like widen the reach along an axis; of anything else REACH must tell.
void widen(int& low, int& high, const std::string& index, char axis) {
    if (index.empty() || index[0] != axis || (index.size() > 1 && index[1] != '-' && index[1] != '+')) return;
    const int offset = index.size() > 1 ? std::atoi(index.c_str() + 1) : 0;
    low = std::max(low, -offset);
    high = std::max(high, offset);
}

Binding binding_at(const Source& source, std::size_t at, const std::string& word, std::size_t slot) {
    const bool conditional = word.ends_with("_IF");
    const auto a = arguments(source, at + word.size());
    if (a.size() != (conditional ? 4u : 3u))
        source.fail(at, word + " takes " + (conditional ? "(EFFECTS, slot, type, name)" : "(slot, type, name)"));
    Binding b;
    const std::size_t shift = conditional ? 1 : 0;
    b.condition = conditional ? a[0] : "0u";
    b.slot = static_cast<int>(slot);
    b.type = a[shift + 1];
    b.name = a[shift + 2];
    b.access = word.substr(0, word.find('_'));
    if (a[shift] != std::to_string(slot))
        source.fail(at, "slot of " + b.name + " is " + a[shift] + ", expected " + std::to_string(slot));
    if (!types.count(b.type)) source.fail(at, "type " + b.type + " of " + b.name + " is none of " + joined(types));
    return b;
}

// The one argument of a word.
std::string argument_of(const Source& source, std::size_t at, const std::string& word) {
    const auto a = arguments(source, at + word.size());
    if (a.size() != 1 || a[0].empty()) source.fail(at, word + " takes one argument");
    return a[0];
}

void check_shape(const Stage& stage, const std::map<std::string, std::vector<std::size_t>>& found) {
    const Source& source = stage.source;
    for (const char* word : {"STAGE", "EXTENT", "KERNEL", "END_STAGE"}) {
        const auto at = found.find(word);
        if (at == found.end()) source.fail(source.text.size(), std::string("no ") + word);
        if (at->second.size() > 1) source.fail(at->second[1], std::string("a second ") + word);
    }
    if (!extents.count(stage.extent))
        source.fail(found.at("EXTENT")[0], "EXTENT " + stage.extent + " is none of " + joined(extents));
    for (const int n : {stage.reach.west, stage.reach.south, stage.reach.east, stage.reach.north})
        if (n > 2) source.fail(found.at("KERNEL")[0], "reads more than 2 cells away, the width of the ghosts");
}

// EMPTY_WITHOUT(fields), LEAN_WITHOUT(EFFECTS, fields), EMPTY_WRITES(field = value).
void read_content(Stage& stage, const std::string& word, std::size_t at) {
    const Source& source = stage.source;
    const auto binding = [&](const std::string& name) -> Binding& {
        const auto found =
            std::find_if(stage.bindings.begin(), stage.bindings.end(), [&](const Binding& b) { return b.name == name; });
        if (found == stage.bindings.end()) source.fail(at, word + " names " + name + ", which the stage does not bind");
        return *found;
    };
    auto a = arguments(source, at + word.size());
    if (a.empty()) source.fail(at, word + " takes arguments in parentheses");
    if (stage.extent != "CELLS" && stage.extent != "FACES") source.fail(at, word + " is for stages of cells and faces");
    if (word == "EMPTY_WRITES") {
        const auto equals = a[0].find('=');
        if (a.size() != 1 || equals == std::string::npos) source.fail(at, word + " takes (field = value)");
        Binding& b = binding(a[0].substr(0, equals));
        if (b.access != "OUT") source.fail(at, word + " names " + b.name + ", which is no OUT");
        b.empty = a[0].substr(equals + 1);
        return;
    }
    Lack lack{{}, "0u"};
    if (word == "LEAN_WITHOUT") {
        lack.less = a[0];
        a.erase(a.begin());
    }
    for (const auto& name : a) {
        if (binding(name).access == "OUT") source.fail(at, word + " names " + name + ", which is an OUT");
    }
    lack.fields = std::move(a);
    stage.lacks.push_back(std::move(lack));
}

// What stands behind END_STAGE is for the table alone: no compiler sees it.
void read_contents(Stage& stage, std::size_t end) {
    for_each_word(stage.source.text.substr(end), [&](const std::string& word, std::size_t at) {
        if (word == "EMPTY_WITHOUT" || word == "LEAN_WITHOUT" || word == "EMPTY_WRITES") read_content(stage, word, end + at);
    });
    stage.source.text.erase(std::min(end + 1, stage.source.text.size()));
}

// A file that only says STAGE_LIKE(Name, stage, word = other) is that stage's text under its own name, with a word replaced.
Source own_or_like(const Source& file, const std::string& shaders) {
    const std::size_t begin = skip_blanks(file.text, 0);
    if (word_at(file.text, begin) != "STAGE_LIKE") return file;
    const auto a = arguments(file, begin + 10);
    const auto equals = a.size() == 3 ? a[2].find('=') : std::string::npos;
    if (equals == std::string::npos) file.fail(begin, "STAGE_LIKE takes (Name, stage, word = other)");
    const std::string path = find_stage(shaders + "stages", a[1]);
    if (path.empty()) file.fail(begin, "no stage \"" + a[1] + "\"");
    const Source like = read_source(path);
    const std::string word = a[2].substr(0, equals), other = a[2].substr(equals + 1);
    Source source{path, {}};
    bool met = false;
    for (std::size_t at = 0; at < like.text.size();) {
        const std::string here_word = word_at(like.text, at);
        met |= here_word == word;
        if (here_word == "STAGE") {
            source.text += "STAGE(" + a[0] + ")";
            at = behind_bracket(like, skip_blanks(like.text, at + 5));
            continue;
        }
        source.text += here_word.empty() ? std::string(1, like.text[at]) : here_word == word ? other : here_word;
        at += here_word.empty() ? 1 : here_word.size();
    }
    if (!met) file.fail(begin, a[1] + " has no word " + word);
    return source;
}

} // namespace

Stage parse_stage(const std::string& path) {
    Stage stage;
    stage.path = path;
    stage.name = stem(path);
    const std::string shaders = shaders_of(path);
    const Source file = own_or_like(read_source(path), shaders);
    std::set<std::string> seen;
    const std::string reads = included(shaders, file.text, seen);
    check_words(file, shaders, reads);
    stage.source = written_out(file, reads);
    const Source& source = stage.source;
    std::set<std::string> tested;
    std::map<std::string, std::vector<std::size_t>> found; // where words stand that a stage has once
    std::vector<std::pair<std::size_t, std::vector<std::string>>> indices;
    for_each_word(source.text, [&](const std::string& word, std::size_t at) {
        static const std::set<std::string> access = {"IN", "OUT", "INOUT", "IN_IF", "OUT_IF", "INOUT_IF"};
        if (word == "STAGE" || word == "EXTENT" || word == "KERNEL" || word == "END_STAGE") found[word].push_back(at);
        if (word == "STAGE") stage.struct_name = argument_of(source, at, word);
        if (word == "EXTENT") stage.extent = argument_of(source, at, word);
        if (word == "FAR_IF") stage.far = argument_of(source, at, word);
        if (word == "HAS") tested.merge(effects_in(argument_of(source, at, word)));
        if (word == "IDX") indices.emplace_back(at, arguments(source, at + word.size()));
        if (word == "REACH") {
            const int n = std::atoi(argument_of(source, at, word).c_str());
            stage.reach = {n, n, n, n};
        }
        if (access.count(word)) {
            stage.bindings.push_back(binding_at(source, at, word, stage.bindings.size()));
            tested.merge(effects_in(stage.bindings.back().condition));
        }
    });
    for (const auto& [at, a] : indices) {
        if (a.size() != 2) source.fail(at, "IDX takes (i, j)");
        if (stage.extent != "CELLS" && stage.extent != "FACES") continue;
        widen(stage.reach.west, stage.reach.east, a[0], 'i');
        widen(stage.reach.south, stage.reach.north, a[1], 'j');
    }
    check_shape(stage, found);
    read_contents(stage, found["END_STAGE"][0] + std::string("END_STAGE").size());
    for (std::size_t at = 0; (at = stage.source.text.find("\"../../physics/", at)) != std::string::npos;)
        stage.source.text.erase(at + 1, 6);
    stage.tested.assign(tested.begin(), tested.end());
    return stage;
}

std::string stage_text(const Stage& stage) { return "#line 1 \"" + stage.source.path + "\"\n" + stage.source.text + here; }

std::string find_stage(const std::string& folder, const std::string& name) {
    for (const auto& room : std::filesystem::directory_iterator(folder)) {
        const auto path = room.path() / (name + ".stage");
        if (std::filesystem::is_regular_file(path)) return path.lexically_normal().generic_string();
    }
    return "";
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

unsigned effect_bits(const std::string& expression, const Effects& effects, const std::string& place) {
    unsigned bits = 0;
    for (const auto& name : effects_in(expression)) {
        const auto found = effects.find(name);
        if (found == effects.end()) fail(place + ": unknown effect " + name);
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
