#include "fused_file.hpp"
#include "writers.hpp"
#include <algorithm>
#include <cctype>
#include <sstream>

namespace stagec {
namespace {

struct Rewriter {
    const FusedStage& fused;
    const FusedPart& part;
    std::size_t index;
    const Effects& effects;
    std::string prefix; // of its functions
    std::set<std::string> functions;

    bool absent(const std::string& binding) const {
        bool never = false;
        condition_of(fused, part, binding_of(part.stage, binding), effects, never);
        return never;
    }

    std::string load(const std::string& binding, const std::string& at) const {
        if (absent(binding)) return "0.0f";
        const std::string& field = part.reads.at(binding);
        if (!writes_before(fused, index, field)) {
            const auto copy = find(staged(fused), field);
            return copy.empty() ? "LOAD(" + field + ", IN_MEMORY(" + at + "))" : "staged_" + field + copy + at + ")]";
        }
        const auto window = find(windows(fused), field);
        return window.empty() || written_in_phase(field) ? "own_" + field : "window_" + field + window + at + ")]";
    }

    // The index of a place in a field's shared rows, but for the place; empty where none of `all` is the field's.
    static std::string find(const std::vector<SharedRows>& all, const std::string& field) {
        for (const auto& rows : all)
            if (rows.field == field) return "[IN_ROWS(" + std::to_string(rows.south) + ", ";
        return "";
    }

    // Written ahead of this part in the same phase: rows that a phase shares are stored when a thread has computed all of its
    // own.
    bool written_in_phase(const std::string& field) const {
        for (std::size_t n = index; n-- > 0;)
            for (const auto& [name, written] : fused.parts[n].writes)
                if (written == field) return fused.parts[n].phase == part.phase;
        return false;
    }

    std::string store(const std::string& binding, const std::string& at, const std::string& value) const {
        if (absent(binding)) return "NOT_KEPT(" + value + ");";
        const std::string& field = part.writes.at(binding);
        std::string out = "{ float stored = " + value + ";";
        const Keeping keeping = fused.fields.at(field);
        if (keeping != Keeping::nowhere) out += " own_" + field + " = stored;";
        const auto kept = fused.kept.find(field);
        if (kept != fused.kept.end() && last_writer(fused, field) == index) {
            const Kept& k = kept->second;
            const std::string rim = k.rim ? " && (i == 0 || j == 0 || i == P.nx || j == P.ny)" : "";
            const std::string on = k.condition != 0 ? " && HAS(" + std::to_string(k.condition) + "u)" : "";
            out += " if (owned" + rim + on + ") KEEP_STORED(" + field + ", IN_MEMORY(" + at + "));";
        }
        return out + " }";
    }

    // The part's text from `at` to `stop`, line for line.
    std::string run(std::size_t at, std::size_t stop) {
        static const std::set<std::string> dropped = {"STAGE", "EXTENT", "REACH", "FAR_IF", "IN",
                                                      "OUT",   "INOUT",  "IN_IF", "OUT_IF", "INOUT_IF"};
        const std::string& text = part.stage.source.text;
        std::string out;
        while (at < stop) {
            if (text[at] == '#') { // includes are gathered by physics_includes
                const std::size_t end = text.find('\n', at);
                if (text.compare(at, 5, "#line") == 0) out += text.substr(at, end - at);
                at = end;
                continue;
            }
            if (!is_word(text[at])) {
                out += text[at++];
                continue;
            }
            const std::size_t begin = at;
            const std::string word = word_at(text, at);
            const bool number = std::isdigit(static_cast<unsigned char>(word[0])) != 0;
            at += word.size();
            if (dropped.count(word)) {
                at = behind_bracket(part.stage.source, skip_blanks(text, at));
            } else if (word == "END_STAGE") {
            } else if (word == "KERNEL") {
                out += "PART_FUNCTION void " + prefix + part.stage.name + "_kernel(int i, int j)";
            } else if (word == "int" && is_place(text, begin)) {
                out += "Place";
            } else if (functions.count(word)) {
                out += prefix + part.stage.name + "_" + word;
            } else if (!number && at < stop && text[at] == '[' && is_binding(word)) {
                out += access(word, begin, at);
            } else {
                out += word;
            }
        }
        return out;
    }

    // A declaration from IDX(i, j), or a parameter of a helper: the stages' only other integers are the kernel's own i and j.
    static bool is_place(const std::string& text, std::size_t at) {
        const std::size_t name_at = skip_blanks(text, at + 3);
        const std::string name = word_at(text, name_at);
        if (text.compare(name_at + name.size(), 7, " = IDX(") == 0) return true;
        if (name == "i" || name == "j") return false;
        const std::size_t helper = text.rfind("HELPER ", at);
        return helper != std::string::npos && text.find_first_of("{};", helper) > at;
    }

    bool is_binding(const std::string& word) const { return part.reads.count(word) || part.writes.count(word); }

    // `at`: behind the binding's name, and then behind what is written in its place.
    std::string access(const std::string& binding, std::size_t begin, std::size_t& at) {
        const Source& source = part.stage.source;
        const std::size_t end = behind_bracket(source, at), next = skip_blanks(source.text, end);
        const std::string place = run(at + 1, end - 1), mark = source.text.substr(next, 2);
        if (mark.size() == 2 && mark[1] == '=' && std::string("+-*/").find(mark[0]) != std::string::npos)
            source.fail(begin, binding + "[...] " + mark + " cannot be fused");
        if (mark[0] != '=' || mark == "==") {
            at = end;
            return load(binding, place);
        }
        const std::size_t stop = source.text.find(';', next);
        at = stop + 1;
        return store(binding, place, run(next + 1, stop));
    }

    void find_functions() {
        const std::string& text = part.stage.source.text;
        for_each_word(text, [&](const std::string& word, std::size_t at) {
            if (word != "FN" && word != "HELPER") return;
            at = skip_blanks(text, at + word.size());
            at = skip_blanks(text, at + word_at(text, at).size()); // behind the type
            functions.insert(word_at(text, at));
        });
    }
};

} // namespace

static std::string functions_of(const FusedStage& fused, const Effects& effects, const std::string& prefix) {
    std::string out;
    for (std::size_t n = 0; n < fused.parts.size(); ++n) {
        Rewriter rewriter{fused, fused.parts[n], n, effects, prefix, {}};
        const Source& source = fused.parts[n].stage.source;
        rewriter.find_functions();
        out += "#line 1 \"" + source.path + "\"\n" + rewriter.run(0, source.text.size()) + here;
    }
    return out;
}

std::string part_functions(const FusedStage& fused, const Effects& effects, const std::string& mask) {
    const std::string outside = "#undef OUTSIDE\n#define OUTSIDE outside\n", none = "#undef OUTSIDE\n#define OUTSIDE 0\n";
    std::string out = outside + functions_of(fused, effects, "");
    if (fused.lean.without.empty()) return out + none;
    const auto has = [](const std::string& bits) {
        return "#undef HAS\n#define HAS(BITS) ((" + bits + " & (BITS)) == (BITS))\n";
    };
    return out + has(mask + " & ~" + std::to_string(fused.lean.less) + "u") + functions_of(fused, effects, "lean_") + has(mask) +
           none;
}

std::string physics_includes(const FusedStage& fused) {
    std::set<std::string> lines;
    for (const auto& part : fused.parts) {
        std::istringstream text(part.stage.source.text);
        for (std::string line; std::getline(text, line);) {
            const auto at = line.find("physics/");
            if (line.rfind("#include", 0) == 0 && at != std::string::npos) lines.insert("#include \"" + line.substr(at));
        }
    }
    std::string out;
    for (const auto& line : lines) out += line + "\n";
    return out;
}

// Two numbers a place: compilers then see that neighbours lie at fixed distances, in memory as in shared rows. OUTSIDE: from a
// cell beyond the grid to the nearest one in it, for memory alone: shared rows have room around the grid, and two cells of a
// column are neighbours in them for compilers only if neither is moved.
const char* const index_macros =
    "#undef IDX\n#define IDX(I, J) PLACE(((J) + GHOST) * P.pitch + (I) + LEAD + OUTSIDE, ((J) - own_j0) * SHARED_PITCH + (I) - "
    "own_i0)\n#define OUTSIDE 0\n"
    "#define IN_MEMORY(C) (C).x\n#define IN_ROWS(SOUTH, C) ((C).y + (SOUTH) * SHARED_PITCH + SHARED_BESIDE)\n";

std::string own_variables(const FusedStage& fused) {
    std::string out = "int own_i0 = 0, own_j0 = 0, own_i1 = 0, own_j1 = 0, outside = 0;\nbool owned = false, changed = false;\n";
    for (const auto& [field, keeping] : fused.fields)
        if (keeping != Keeping::nowhere) out += "float own_" + field + " = 0.0f;\n";
    return out;
}

// A thread computes one or two cells of a column at once, so that compilers load what both read once, and stores what it shares
// behind both. Cells beyond the grid are computed, too, without a branch, from the memory of the nearest one in it, and are 0, as
// ghosts are.
namespace {

struct Phase {
    const Margins& margins;
    std::vector<const FusedPart*> parts;
};

std::string effects_on(unsigned condition) { return condition == 0 ? "" : "if (HAS(" + std::to_string(condition) + "u)) "; }

// The parts for the cell (i, j), which is a FACES or CELLS stage's (at_i, at_j) where that lies in the grid.
std::string cell_text(const FusedStage& fused, const Phase& phase, const std::string& prefix) {
    std::string out;
    for (const auto* part : phase.parts) {
        const std::string at = part->stage.extent == "FACES" ? "face" : "cell", in = "in_" + at;
        out += "        " + effects_on(part->condition) + "{\n            owned = own && " + in + ";\n            outside = (" +
               at + "_j - j) * P.pitch + " + at + "_i - i;\n            " + prefix + part->stage.name + "_kernel(i, j);\n";
        for (const auto& [name, field] : part->writes) {
            const auto found = fused.fields.find(field);
            if (found == fused.fields.end() || found->second == Keeping::nowhere) continue;
            out += "            own_" + field + " = " + in + " ? own_" + field + " : 0.0f;\n";
        }
        out += "        }\n";
    }
    return out;
}

// Shared rows that the phase writes, each field once and under the weakest condition.
std::map<std::string, unsigned> shared_by(const FusedStage& fused, const Phase& phase) {
    std::map<std::string, unsigned> fields;
    for (const auto* part : phase.parts)
        for (const auto& [name, field] : part->writes) {
            const auto found = fused.fields.find(field);
            if (found == fused.fields.end() || found->second != Keeping::window) continue;
            const auto [at, first] = fields.emplace(field, part->condition);
            if (!first) at->second &= part->condition;
        }
    return fields;
}

// Whether a thread's cells are computed as if they were no neighbours: what both read or share would be held in registers that a
// phase which keeps many fields does not have. Lean groups (which have a prefix) hold less.
bool apart(const FusedStage& fused, const Phase& phase, const std::string& prefix) {
    if (!prefix.empty()) return false;
    constexpr int many = 6;
    int fields = 0;
    for (const auto* part : phase.parts)
        for (const auto& [name, field] : part->writes) {
            const auto kept = fused.kept.find(field);
            if (kept != fused.kept.end() && !kept->second.rim && &fused.parts[last_writer(fused, field)] == part) ++fields;
        }
    return fields >= many;
}

std::string phase_text(const FusedStage& fused, const Phase& phase, const std::string& prefix) {
    const Margins& m = phase.margins;
    const int width = FUSED_COLUMNS + m.west + m.east, height = FUSED_ROWS + m.south + m.north;
    const auto shared = shared_by(fused, phase);
    const std::string top = "own_j0 + " + std::to_string(height - m.south);
    std::ostringstream o;
    o << "    ROLLED for (int n = LANE; n < " << width * ((height + fused.cells_each - 1) / fused.cells_each)
      << "; n += LANES) {\n"
      << "        int i = own_i0 + n % " << width << " - " << m.west << ";\n        int j0 = own_j0 + n / " << width << " * "
      << fused.cells_each << " - " << m.south << ";\n"
      << "        bool own_column = i >= own_i0 && i < own_i1;\n";
    std::set<std::string> extents;
    for (const auto* part : phase.parts) extents.insert(part->stage.extent == "FACES" ? "face" : "cell");
    for (const auto& at : extents) {
        const std::string less = at == "face" ? "" : " - 1";
        o << "        int last_" << at << "_i = P.nx" << less << ", last_" << at << "_j = P.ny" << less << ";\n"
          << "        int " << at << "_i = nearest_index(i, last_" << at << "_i);\n";
    }
    for (int row = 0; row < fused.cells_each; ++row) {
        const bool within = row == 0 || height % fused.cells_each == 0; // else the last row is computed twice
        o << "        int j_" << row << " = j0 + " << row
          << (within ? "" : " < " + top + " ? j0 + " + std::to_string(row) + " : j0") << ";\n        {\n        int j = j_" << row
          << (row > 0 && apart(fused, phase, prefix) ? ";\n        APART(j);\n" : ";\n")
          << "        bool own = own_column && j >= own_j0 && j < own_j1, inside = i >= 0 && j >= 0;\n";
        for (const auto& at : extents)
            o << "        bool in_" << at << " = inside && i <= last_" << at << "_i && j <= last_" << at << "_j;\n        int "
              << at << "_j = nearest_index(j, last_" << at << "_j);\n";
        o << cell_text(fused, phase, prefix) << "        }\n";
        for (const auto& [field, condition] : shared) o << "        float " << field << "_" << row << " = own_" << field << ";\n";
    }
    for (int row = 0; row < fused.cells_each; ++row) {
        for (const auto& rows : windows(fused)) {
            const auto found = shared.find(rows.field);
            if (found == shared.end()) continue;
            o << "        " << effects_on(found->second) << "window_" << rows.field << "[IN_ROWS(" << rows.south << ", IDX(i, j_"
              << row << "))] = " << rows.field << "_" << row << ";\n";
        }
    }
    o << "    }\n";
    return o.str();
}

// `less`: effects that are off.
std::string loops(const FusedStage& fused, const std::string& prefix, unsigned less) {
    std::string out;
    for (std::size_t p = 0; p < fused.phases.size(); ++p) {
        Phase phase{fused.phases[p], {}};
        for (const auto& part : fused.parts)
            if (part.phase == p && (part.condition & less) == 0) phase.parts.push_back(&part);
        if (phase.parts.empty()) continue;
        if (!out.empty()) out += "    BARRIER;\n";
        out += phase_text(fused, phase, prefix);
    }
    return out;
}

} // namespace

std::string phase_loops(const FusedStage& fused, const Effects& effects) {
    const bool empties = !fused.empty.without.empty(), leans = !fused.lean.without.empty();
    std::string out;
    if (empties) out += content_look(fused, fused.empty, "empty") + "    if (empty) {\n" + empty_writes(fused) + "    } else {\n";
    if (leans)
        out += content_look(fused, fused.lean, "lean") + "    if (lean) {\n" + staging(fused, fused.lean.without) +
               loops(fused, "lean_", fused.lean.less) + lean_writes(fused, effects) + "    } else {\n";
    out += staging(fused, {}) + loops(fused, "", 0);
    if (leans) out += "    }\n";
    if (empties) out += "    }\n";
    return out;
}

} // namespace stagec
