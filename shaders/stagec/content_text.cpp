#include "fused_file.hpp"
#include "writers.hpp"
#include <algorithm>
#include <sstream>

namespace stagec {
namespace {

// Rows `south` below a group's own ones and so many in all, as far as shared rows reach to the sides, WIDE of them at a
// time.
std::string each_row(int south, int rows) {
    return "    ROLLED for (int n = LANE; n < SHARED_PITCH / WIDE * " + std::to_string(rows) +
           "; n += LANES) {\n        int i = own_i0 - SHARED_BESIDE + n % (SHARED_PITCH / WIDE) * WIDE;\n"
           "        int j = own_j0 + n / (SHARED_PITCH / WIDE) - " +
           std::to_string(south) + ";\n";
}

// Ahead of a statement that touches a buffer which some masks lack.
std::string where_bound(const Binding& b) { return b.condition == "0u" ? "" : "if (HAS(" + b.condition + ")) "; }

// Stores for WIDE of a group's own cells: `from` is a field that a kept one copies, or empty, which is 0.
std::string kept_store(const Binding& b, const std::string& from) {
    return "        " + where_bound(b) +
           (from.empty() ? "KEEP_ZEROS(" + b.name + ", at);\n" : "KEEP_COPY(" + b.name + ", at, " + from + ");\n");
}

// Tiles of active cells are as wide as some multiple of WIDE.
std::string own_cells(const std::string& stores) {
    return "    ROLLED for (int n = LANE; n < FUSED_COLUMNS / WIDE * FUSED_ROWS; n += LANES) {\n"
           "        int i = own_i0 + n % (FUSED_COLUMNS / WIDE) * WIDE;\n        int j = own_j0 + n / (FUSED_COLUMNS / WIDE);\n"
           "        if (i >= own_i1 || j >= own_j1) continue;\n        int at = IN_MEMORY(IDX(i, j));\n" +
           stores + "    }\n";
}

// What is kept of the outer faces only is nothing to groups that do not touch them.
bool kept_of_all(const FusedStage& fused, const Binding& b) {
    const auto kept = fused.kept.find(b.name);
    return b.access != "IN" && kept != fused.kept.end() && !kept->second.rim;
}

} // namespace

// Rows that the parts read beyond the ghosts are those of cells that count for nothing: the nearest ghosts stand in for them.
std::string staging(const FusedStage& fused, const std::vector<std::string>& zero) {
    const auto copies = staged(fused);
    if (copies.empty()) return "";
    std::string text = each_row(copies.front().south, copies.front().rows()) +
                       "        int row = j < -GHOST ? -GHOST : j > P.ny + GHOST ? P.ny + GHOST : j;\n"
                       "        int from = IN_MEMORY(IDX(i, row));\n";
    for (const auto& copy : copies) {
        const bool known = std::find(zero.begin(), zero.end(), copy.field) != zero.end();
        const std::string to = "(staged_" + copy.field + ", n * WIDE";
        text += "        " + where_bound(binding_of(fused.stage, copy.field)) +
                (known ? "ZERO" + to + ");\n" : "COPY" + to + ", " + copy.field + ", from);\n");
    }
    return text + "    }\n    COPIED;\n    BARRIER;\n";
}

// Where a thread looks at one element at a time, one each is looked at first: where there is something, that mostly tells.
std::string content_look(const FusedStage& fused, const Content& content, const std::string& name) {
    const Margins m = read_margins(fused);
    std::string holds = "        some |= ";
    for (const auto& field : content.without)
        holds += (field == content.without.front() ? "HOLDS(" : " || HOLDS(") + field + ", at)";
    holds += " ? 1 : 0;\n";
    std::ostringstream o;
    o << "    bool " << name << " = own_i0 >= SHARED_BESIDE && own_j0 >= " << m.south
      << " && own_i0 + FUSED_COLUMNS + SHARED_BESIDE <= P.nx && own_j0 + " << FUSED_ROWS + m.north << " <= P.ny";
    if (&content == &fused.empty && fused.empty.never != 0) o << " && !HAS(" << fused.empty.never << "u)";
    o << ";\n    if (WIDE == 1 && " << name << ") {\n        int some = 0;\n        int cell = LANE * ("
      << FUSED_COLUMNS * FUSED_ROWS << " / LANES);\n        int at = IN_MEMORY(IDX(own_i0 + cell % " << FUSED_COLUMNS
      << ", own_j0 + cell / " << FUSED_COLUMNS << "));\n"
      << holds << "        " << name << " = !ANY(some);\n    }\n    if (" << name << ") {\n        int some = 0;\n"
      << each_row(m.south, FUSED_ROWS + m.south + m.north) << "        int at = IN_MEMORY(IDX(i, j));\n"
      << holds << "    }\n    " << name << " = !ANY(some);\n    }\n";
    return o.str();
}

std::string empty_writes(const FusedStage& fused) {
    std::string stores;
    for (const auto& b : fused.stage.bindings) {
        const auto copy = fused.empty.copies.find(b.name);
        const bool copied = copy != fused.empty.copies.end();
        if (kept_of_all(fused, b)) stores += kept_store(b, copied ? copy->second : "");
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
                stores += kept_store(b, "");
    }
    return own_cells(stores);
}

} // namespace stagec
