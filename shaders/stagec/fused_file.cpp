#include "fused_file.hpp"
#include "writers.hpp"
#include <algorithm>
#include <cctype>
#include <sstream>

namespace stagec {
namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

Margins margins_of(const std::vector<std::string>& a, const std::string& path) {
    if (a.size() != 4) fail(path + ": PHASE takes (west, south, east, north)");
    Margins m{std::stoi(a[0]), std::stoi(a[1]), std::stoi(a[2]), std::stoi(a[3])};
    for (const int n : {m.west, m.south, m.east, m.north})
        if (n < 0 || n > 2) fail(path + ": a phase reaches 0 to 2 cells around a group's own");
    return m;
}

// "name=field" reads and writes another field than the binding's name says, "name>field" only writes it.
FusedPart part_of(const std::vector<std::string>& a, std::size_t first, const std::string& folder, const std::string& path) {
    FusedPart part;
    part.stage = parse_stage(find_stage(folder + "/../stages", a.at(first), path));
    for (const auto& b : part.stage.bindings) {
        if (b.access != "OUT") part.reads[b.name] = b.name;
        if (b.access != "IN") part.writes[b.name] = b.name;
    }
    for (std::size_t n = first + 1; n < a.size(); ++n) {
        const auto at = a[n].find_first_of("=>");
        if (at == std::string::npos) fail(path + ": \"" + a[n] + "\" is neither binding = field nor binding > field");
        const std::string name = a[n].substr(0, at), field = a[n].substr(at + 1);
        if (!part.reads.count(name) && !part.writes.count(name)) fail(path + ": " + part.stage.name + " has no binding " + name);
        if (a[n][at] == '=' && part.reads.count(name)) part.reads[name] = field;
        if (part.writes.count(name)) part.writes[name] = field;
    }
    return part;
}

const Binding& binding_of(const Stage& stage, const std::string& name) {
    const auto found =
        std::find_if(stage.bindings.begin(), stage.bindings.end(), [&](const Binding& b) { return b.name == name; });
    if (found == stage.bindings.end()) fail(stage.path + ": no binding " + name);
    return *found;
}

// What of a binding's condition is still open in a fused stage; `never` where the binding cannot exist.
unsigned condition_of(const FusedStage& fused, const FusedPart& part, const Binding& b, const Effects& effects, bool& never) {
    const unsigned bits = effect_bits(b.condition, effects, part.stage.path) | part.condition;
    never = (bits & fused.without) != 0;
    return bits & ~fused.needs;
}

bool writes_before(const FusedStage& fused, std::size_t part, const std::string& field) {
    for (std::size_t n = 0; n < part; ++n)
        for (const auto& [name, written] : fused.parts[n].writes)
            if (written == field) return true;
    return false;
}

std::size_t last_writer(const FusedStage& fused, const std::string& field) {
    std::size_t last = fused.parts.size();
    for (std::size_t n = 0; n < fused.parts.size(); ++n)
        for (const auto& [name, written] : fused.parts[n].writes)
            if (written == field) last = n;
    return last;
}

void add_binding(FusedStage& fused, const std::string& field, const std::string& type, const char* access, unsigned condition) {
    for (auto& b : fused.stage.bindings) {
        if (b.name != field) continue;
        if (b.type != type) fail(fused.stage.path + ": " + field + " is bound as " + b.type + " and as " + type);
        if (b.access != access)
            fail(fused.stage.path + ": " + field + " is read from memory and kept: another group may have written it");
        if (b.condition != std::to_string(condition) + "u") {
            if (b.condition != "0u" && condition != 0) fail(fused.stage.path + ": " + field + " exists under two conditions");
            b.condition = "0u";
        }
        return;
    }
    Binding b;
    b.name = field;
    b.type = type;
    b.access = access;
    b.condition = std::to_string(condition) + "u";
    b.slot = static_cast<int>(fused.stage.bindings.size());
    fused.stage.bindings.push_back(b);
}

// Finds out what is read from memory, what is kept there, and where the rest lives.
// `tested`: effects that the file itself asks.
void resolve(FusedStage& fused, const Effects& effects, std::set<std::string> tested) {
    for (std::size_t n = 0; n < fused.parts.size(); ++n) {
        const auto& part = fused.parts[n];
        for (const auto& b : part.stage.bindings) {
            if (b.type != "float" && !b.narrow())
                fail(fused.stage.path + ": " + part.stage.name + " has a binding that is no float");
        }
        tested.insert(part.stage.tested.begin(), part.stage.tested.end());
        for (const auto& [name, field] : part.reads) {
            bool never = false;
            const unsigned condition = condition_of(fused, part, binding_of(part.stage, name), effects, never);
            if (never) continue;
            if (!writes_before(fused, n, field)) {
                add_binding(fused, field, binding_of(part.stage, name).type, "IN", condition);
                continue;
            }
            auto& keeping = fused.fields[field];
            bool same_phase = true;
            for (std::size_t w = 0; w < n; ++w)
                for (const auto& [other, written] : fused.parts[w].writes)
                    if (written == field) same_phase &= fused.parts[w].phase == part.phase;
            keeping = std::max(keeping, same_phase ? Keeping::own_index : Keeping::tile);
        }
        for (const auto& [name, field] : part.writes) {
            bool never = false;
            condition_of(fused, part, binding_of(part.stage, name), effects, never);
            if (!never) fused.fields.emplace(field, Keeping::nowhere);
        }
    }
    for (const auto& [field, keeping] : fused.fields) {
        if (!fused.kept.count(field) && keeping == Keeping::nowhere) fail(fused.stage.path + ": nobody reads " + field);
    }
    for (const auto& [field, kept] : fused.kept) {
        if (!fused.fields.count(field)) fail(fused.stage.path + ": KEEP names " + field + ", which no part writes");
        const FusedPart& part = fused.parts[last_writer(fused, field)];
        for (const auto& [name, written] : part.writes) {
            bool never = false;
            const unsigned condition = condition_of(fused, part, binding_of(part.stage, name), effects, never);
            if (written == field && !never)
                add_binding(fused, field, binding_of(part.stage, name).type, "OUT", condition | (kept.condition & ~fused.needs));
        }
    }
    for (const auto& name : tested) {
        if ((effects.at(name) & (fused.needs | fused.without)) == 0) fused.stage.tested.push_back(name);
    }
    for (const auto& part : fused.parts) {
        auto add = part.stage.reach;
        const bool far = (effect_bits(part.stage.far, effects, part.stage.path) & ~fused.needs) == 0;
        for (int* n : {&add.west, &add.south, &add.east, &add.north})
            if (!far) *n = std::min(*n, 1);
        auto& sum = fused.stage.reach;
        sum = {sum.west + add.west, sum.south + add.south, sum.east + add.east, sum.north + add.north};
    }
}

struct Rewriter {
    const FusedStage& fused;
    const FusedPart& part;
    std::size_t index;
    const Effects& effects;
    std::set<std::string> functions;

    bool absent(const std::string& binding) const {
        bool never = false;
        condition_of(fused, part, binding_of(part.stage, binding), effects, never);
        return never;
    }

    std::string load(const std::string& binding, const std::string& at) const {
        if (absent(binding)) return "0.0f";
        const std::string& field = part.reads.at(binding);
        if (!writes_before(fused, index, field)) return "float(" + field + "[IN_MEMORY(" + at + ")])";
        return fused.fields.at(field) == Keeping::tile ? "tile_" + field + "[IN_TILE(" + at + ")]" : "own_" + field;
    }

    std::string store(const std::string& binding, const std::string& at, const std::string& value) const {
        if (absent(binding)) return "NOT_KEPT(" + value + ");";
        const std::string& field = part.writes.at(binding);
        const bool narrow = binding_of(part.stage, binding).narrow();
        std::string out = "{ float stored = " + (narrow ? "to_stored(" + value + ")" : value) + ";";
        const Keeping keeping = fused.fields.at(field);
        if (keeping == Keeping::tile) out += " tile_" + field + "[IN_TILE(" + at + ")] = stored;";
        if (keeping == Keeping::own_index) out += " own_" + field + " = stored;";
        const auto kept = fused.kept.find(field);
        if (kept != fused.kept.end() && last_writer(fused, field) == index) {
            const Kept& k = kept->second;
            const std::string rim = k.rim ? " && (i == 0 || j == 0 || i == P.nx || j == P.ny)" : "";
            const std::string on = k.condition != 0 ? " && HAS(" + std::to_string(k.condition) + "u)" : "";
            out += " if (owned" + rim + on + ") KEEP_STORED(" + field + ", IN_MEMORY(" + at + "), " +
                   (narrow ? "float_or_half" : "float") + ");";
        }
        return out + " }";
    }

    // The part's text from its stage file.
    std::string run(const std::string& text) {
        static const std::set<std::string> dropped = {"STAGE", "EXTENT", "REACH", "FAR_IF", "IN",
                                                      "OUT",   "INOUT",  "IN_IF", "OUT_IF", "INOUT_IF"};
        std::string out;
        for (std::size_t at = 0; at < text.size();) {
            if (text[at] == '#') { // includes, gathered by physics_includes
                at = text.find('\n', at);
                continue;
            }
            if (!is_word(text[at])) {
                out += text[at++];
                continue;
            }
            const std::string word = word_at(text, at);
            const bool number = std::isdigit(static_cast<unsigned char>(word[0])) != 0;
            at += word.size();
            if (dropped.count(word)) {
                at = text.find(')', at) + 1;
            } else if (word == "END_STAGE") {
            } else if (word == "KERNEL") {
                out += "PART_FUNCTION void " + part.stage.name + "_kernel(int i, int j)";
            } else if (word == "int" && is_place(text, at)) {
                out += "Place";
            } else if (functions.count(word)) {
                out += part.stage.name + "_" + word;
            } else if (!number && at < text.size() && text[at] == '[' && is_binding(word)) {
                out += access(text, word, at);
            } else {
                out += word;
            }
        }
        return out;
    }

    // A declaration from IDX(i, j), or a parameter of a helper: the stages' only other integers are the kernel's own i and j.
    static bool is_place(const std::string& text, std::size_t at) {
        std::size_t end = text.find_first_not_of(' ', at);
        end += word_at(text, end).size();
        if (text.compare(end, 7, " = IDX(") == 0) return true;
        const std::size_t line = text.rfind('\n', at) + 1, brace = text.find('{', line);
        return text.compare(line, 7, "HELPER ") == 0 && at < brace;
    }

    bool is_binding(const std::string& word) const { return part.reads.count(word) || part.writes.count(word); }

    std::string access(const std::string& text, const std::string& binding, std::size_t& at) {
        std::size_t end = at + 1;
        for (int depth = 1; depth > 0; ++end) depth += text[end] == '[' ? 1 : text[end] == ']' ? -1 : 0;
        const std::string place = run(text.substr(at + 1, end - at - 2));
        std::size_t next = text.find_first_not_of(' ', end);
        const std::string mark = text.substr(next, 2);
        if (mark.size() == 2 && mark[1] == '=' && std::string("+-*/").find(mark[0]) != std::string::npos)
            fail(part.stage.path + ": " + binding + "[...] " + mark + " cannot be fused");
        if (mark[0] != '=' || mark == "==") {
            at = end;
            return load(binding, place);
        }
        const std::size_t stop = text.find(';', next);
        const std::string value = run(text.substr(next + 1, stop - next - 1));
        at = stop + 1;
        return store(binding, place, value);
    }

    void find_functions(const std::string& text) {
        for (std::size_t at = 0; at < text.size();) {
            if (!is_word(text[at])) {
                ++at;
                continue;
            }
            const std::string word = word_at(text, at);
            at += word.size();
            if (word != "FN" && word != "HELPER") continue;
            at = text.find_first_not_of(' ', at);
            at = text.find_first_not_of(' ', at + word_at(text, at).size()); // behind the type
            functions.insert(word_at(text, at));
        }
    }
};

} // namespace

Margins tile_margins(const FusedStage& fused) {
    Margins most;
    for (const auto& m : fused.phases) {
        most = {std::max(most.west, m.west), std::max(most.south, m.south), std::max(most.east, m.east),
                std::max(most.north, m.north)};
    }
    return most;
}

int tile_pitch(const FusedStage& fused) {
    const Margins m = tile_margins(fused);
    return FUSED_COLUMNS + m.west + m.east;
}

int tile_floats(const FusedStage& fused) {
    const Margins m = tile_margins(fused);
    return tile_pitch(fused) * (FUSED_ROWS + m.south + m.north);
}

std::vector<std::string> fields_kept(const FusedStage& fused, Keeping keeping) {
    std::vector<std::string> names;
    for (const auto& [name, where] : fused.fields)
        if (where == keeping) names.push_back(name);
    return names;
}

FusedStage parse_fused(const std::string& path, const Effects& effects) {
    FusedStage fused;
    fused.stage.path = path;
    fused.stage.name = stem(path);
    fused.stage.extent = "FACES";
    fused.stage.fused = true;
    const auto slash = path.find_last_of('/');
    const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash);
    const std::string text = strip_comments(read_text(path));
    std::set<std::string> keep_conditions;
    for (std::size_t at = 0; at < text.size();) {
        if (!is_word(text[at])) {
            ++at;
            continue;
        }
        const std::string word = word_at(text, at);
        const auto a = arguments(text, at + word.size());
        at = text.find('(', at);
        for (int depth = 0; at < text.size();) {
            depth += text[at] == '(' ? 1 : text[at] == ')' ? -1 : 0;
            ++at;
            if (depth == 0) break;
        }
        if (word == "FUSED") {
            fused.stage.struct_name = a.at(0);
        } else if (word == "NEEDS") {
            fused.needs = effect_bits(a.at(0), effects, path);
        } else if (word == "WITHOUT") {
            fused.without = effect_bits(a.at(0), effects, path);
        } else if (word == "PHASE") {
            fused.phases.push_back(margins_of(a, path));
        } else if (word == "RUN" || word == "RUN_IF") {
            if (fused.phases.empty()) fail(path + ": RUN ahead of the first PHASE");
            const bool conditional = word == "RUN_IF";
            FusedPart part = part_of(a, conditional ? 1 : 0, folder, path);
            part.condition = conditional ? effect_bits(a.at(0), effects, path) & ~fused.needs : 0;
            if (conditional)
                for (const auto& name : effects_in(a[0])) part.stage.tested.push_back(name);
            part.phase = fused.phases.size() - 1;
            fused.parts.push_back(part);
        } else if (word == "KEEP") {
            for (const auto& field : a) fused.kept[field] = {};
        } else if (word == "KEEP_RIM_IF") {
            for (const auto& name : effects_in(a.at(0))) keep_conditions.insert(name);
            for (std::size_t n = 1; n < a.size(); ++n) fused.kept[a[n]] = {true, effect_bits(a[0], effects, path) & ~fused.needs};
        } else {
            fail(path + ": unknown word " + word);
        }
    }
    if (fused.stage.struct_name.empty()) fail(path + ": no FUSED(Name)");
    resolve(fused, effects, keep_conditions);
    const std::size_t bytes = 4 * fields_kept(fused, Keeping::tile).size() * static_cast<std::size_t>(tile_floats(fused));
    if (bytes > wadi::compute::fused_shared_bytes) {
        fail(path + ": tiles of " + std::to_string(bytes) + " bytes, at most " +
             std::to_string(wadi::compute::fused_shared_bytes) + " are shared");
    }
    return fused;
}

std::string part_functions(const FusedStage& fused, const Effects& effects) {
    std::string out;
    for (std::size_t n = 0; n < fused.parts.size(); ++n) {
        Rewriter rewriter{fused, fused.parts[n], n, effects, {}};
        const std::string text = strip_comments(read_text(fused.parts[n].stage.path));
        rewriter.find_functions(text);
        out += "// " + fused.parts[n].stage.name + "\n" + rewriter.run(text.substr(text.find("STAGE("))) + "\n";
    }
    return out;
}

std::string physics_includes(const FusedStage& fused) {
    std::set<std::string> lines;
    for (const auto& part : fused.parts) {
        std::istringstream text(read_text(part.stage.path));
        for (std::string line; std::getline(text, line);) {
            const auto at = line.find("physics/");
            if (line.rfind("#include", 0) == 0 && at != std::string::npos) lines.insert("#include \"" + line.substr(at));
        }
    }
    std::string out;
    for (const auto& line : lines) out += line + "\n";
    return out;
}

std::string index_macros(const FusedStage& fused) {
    const Margins m = tile_margins(fused);
    std::ostringstream o;
    // Two numbers a place: compilers then see that neighbours lie at fixed distances, in memory as in the tile.
    o << "#undef IDX\n#define IDX(I, J) PLACE(((J) + GHOST) * P.pitch + (I) + GHOST, ((J) - tile_j0) * " << tile_pitch(fused)
      << " + (I) - tile_i0)\n#define IN_MEMORY(C) (C).x\n#define IN_TILE(C) (C).y\n"
      << "#define PLACE_TILE tile_i0 = own_i0 - " << m.west << "; tile_j0 = own_j0 - " << m.south << "\n";
    return o.str();
}

std::string phase_loops(const FusedStage& fused) {
    std::ostringstream o;
    for (std::size_t p = 0; p < fused.phases.size(); ++p) {
        const Margins& m = fused.phases[p];
        const int width = FUSED_COLUMNS + m.west + m.east, height = FUSED_ROWS + m.south + m.north;
        if (p > 0) o << "    BARRIER;\n";
        o << "    for (int n = LANE; n < " << width * height << "; n += LANES) {\n"
          << "        int i = own_i0 + n % " << width << " - " << m.west << ";\n        int j = own_j0 + n / " << width << " - "
          << m.south << ";\n"
          << "        owned = i >= own_i0 && i < own_i1 && j >= own_j0 && j < own_j1;\n"
          << "        bool inside = i >= 0 && j >= 0;\n";
        for (const auto& part : fused.parts) {
            if (part.phase != p) continue;
            if (part.condition != 0) o << "        if (HAS(" << part.condition << "u)) {\n";
            o << "        if (inside && " << guard(part.stage.extent) << ") {\n            " << part.stage.name
              << "_kernel(i, j);\n        } else {\n"; // beyond the grid fields are 0, as ghosts are
            for (const auto& [name, field] : part.writes) {
                const auto found = fused.fields.find(field);
                if (found == fused.fields.end()) continue;
                if (found->second == Keeping::tile) o << "            tile_" << field << "[IN_TILE(IDX(i, j))] = 0.0f;\n";
                if (found->second == Keeping::own_index) o << "            own_" << field << " = 0.0f;\n";
            }
            o << "        }\n";
            if (part.condition != 0) o << "        }\n";
        }
        o << "    }\n";
    }
    return o.str();
}

} // namespace stagec
