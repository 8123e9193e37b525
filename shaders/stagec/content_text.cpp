#include "fused_file.hpp"
#include "writers.hpp"
#include <algorithm>
#include <sstream>

namespace stagec {
namespace {

// Cells around a group's own ones from which a part reads.
Margins read_margins(const FusedStage& fused) {
    Margins most;
    for (const auto& part : fused.parts) {
        const Margins& m = fused.phases[part.phase];
        const Reach& r = part.reach;
        most = {std::max(most.west, m.west + r.west), std::max(most.south, m.south + r.south),
                std::max(most.east, m.east + r.east), std::max(most.north, m.north + r.north)};
    }
    return most;
}

std::string each_place(int width, int height, const std::string& i0, const std::string& j0) {
    return "    ROLLED for (int n = LANE; n < " + std::to_string(width * height) + "; n += LANES) {\n        int i = " + i0 +
           " + n % " + std::to_string(width) + ";\n        int j = " + j0 + " + n / " + std::to_string(width) + ";\n";
}

// Stores `value` as what a group keeps of a binding at its own cell.
std::string kept_store(const Binding& b, const std::string& value) {
    const std::string store =
        "        stored = " + value + ";\n        KEEP_STORED(" + b.name + ", IN_MEMORY(at), " + b.type + ");\n";
    return b.condition == "0u" ? store : "        if (HAS(" + b.condition + ")) {\n" + store + "        }\n";
}

std::string own_cells(const std::string& stores) {
    return each_place(FUSED_COLUMNS, FUSED_ROWS, "own_i0", "own_j0") +
           "        if (i >= own_i1 || j >= own_j1) continue;\n        Place at = IDX(i, j);\n        float stored = 0.0f;\n" +
           stores + "    }\n";
}

// What is kept of the outer faces only is nothing to groups that do not touch them.
bool kept_of_all(const FusedStage& fused, const Binding& b) {
    const auto kept = fused.kept.find(b.name);
    return b.access != "IN" && kept != fused.kept.end() && !kept->second.rim;
}

} // namespace

// One cell a thread is looked at first: where there is something, that mostly tells.
std::string content_look(const FusedStage& fused, const Content& content, const std::string& name) {
    const Margins m = read_margins(fused);
    std::string holds = "        holds |= ";
    for (const auto& field : content.without)
        holds += (field == content.without.front() ? "float(" : " || float(") + field + "[IN_MEMORY(at)]) != 0.0f";
    holds += " ? 1 : 0;\n";
    std::ostringstream o;
    o << "    bool " << name << " = own_i0 >= " << m.west << " && own_j0 >= " << m.south << " && own_i0 + "
      << FUSED_COLUMNS + m.east << " <= P.nx && own_j0 + " << FUSED_ROWS + m.north << " <= P.ny";
    if (&content == &fused.empty && fused.empty.never != 0) o << " && !HAS(" << fused.empty.never << "u)";
    o << ";\n    if (" << name << ") {\n        int holds = 0;\n        int cell = LANE * (" << FUSED_COLUMNS * FUSED_ROWS
      << " / LANES);\n        Place at = IDX(own_i0 + cell % " << FUSED_COLUMNS << ", own_j0 + cell / " << FUSED_COLUMNS << ");\n"
      << holds << "        " << name << " = !ANY(holds);\n    }\n    if (" << name << ") {\n        int holds = 0;\n"
      << each_place(FUSED_COLUMNS + m.west + m.east, FUSED_ROWS + m.south + m.north, "own_i0 - " + std::to_string(m.west),
                    "own_j0 - " + std::to_string(m.south))
      << "        Place at = IDX(i, j);\n"
      << holds << "    }\n    " << name << " = !ANY(holds);\n    }\n";
    return o.str();
}

std::string empty_writes(const FusedStage& fused) {
    std::string stores;
    for (const auto& b : fused.stage.bindings) {
        const auto copy = fused.empty.copies.find(b.name);
        const bool copied = copy != fused.empty.copies.end();
        if (kept_of_all(fused, b)) stores += kept_store(b, copied ? "float(" + copy->second + "[IN_MEMORY(at)])" : "0.0f");
    }
    return own_cells(stores);
}

std::string lean_writes(const FusedStage& fused, const Effects& effects) {
    std::string stores;
    for (const auto& b : fused.stage.bindings) {
        if (!kept_of_all(fused, b)) continue;
        const FusedPart& part = fused.parts[last_writer(fused, b.name)];
        for (const auto& [name, field] : part.writes)
            if (field == b.name &&
                (effect_bits(binding_of(part.stage, name).condition, effects, part.stage.path) & fused.lean.less) != 0)
                stores += kept_store(b, "0.0f");
    }
    return own_cells(stores);
}

} // namespace stagec
