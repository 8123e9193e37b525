#include "writers.hpp"
#include <array>
#include <sstream>

namespace stagec {

std::string length(const std::string& extent) {
    if (extent == "POINTS") return "S.point_count";
    if (extent == "SOURCE_PIECES") return "P.source_pieces";
    return extent == "SOURCE_CELLS" ? "P.source_pieces * P.source_rows" : "";
}

std::string guard(const std::string& extent) {
    if (extent == "CELLS") return "i < P.nx && j < P.ny";
    if (extent == "FACES") return "i <= P.nx && j <= P.ny";
    if (extent == "RIM") return "i < 2 * (P.nx + P.ny) && j < 1";
    if (extent == "STRIPS") return "i <= P.nx && j < P.strips";
    if (extent == "TILES") return "i < P.tile_columns && j < P.tile_rows";
    if (extent == "TILE_ROWS") return "i < 1 && j < P.tile_rows";
    if (extent == "TILE_LINES") return "i < P.tile_columns && j <= P.ny";
    return "i < POINT_ROW && j * POINT_ROW + i < " + length(extent);
}

bool marks(const Stage& s) {
    bool marks = s.extent == "CELLS" || s.extent == "FACES" || s.extent == "RIM";
    for (const auto& b : s.bindings)
        marks &= b.access == "IN" || b.type == "float" || (s.extent == "RIM" && (b.type == "uint" || b.type == "vec4"));
    return marks;
}

// What of a buffer a kernel at (i, j) writes. RIM: at its face and the ghost outside, the low words of its counts in and out, the
// four numbers that it remembers.
static std::vector<std::string> written(const Stage& s, const Binding& b) {
    if (s.extent != "RIM") return {"[at]"};
    if (b.type == "uint") return {"[i]", "[4 * (P.nx + P.ny) + i]"};
    if (b.type == "vec4") return {"[i].x", "[i].y", "[i].z", "[i].w"};
    return {"[at]", "[ghost]"};
}

std::string marking(const Stage& s, const std::string& member) {
    std::ostringstream before, after;
    int count = 0;
    for (const auto& b : s.bindings) {
        if (b.access == "IN") continue;
        const std::string has = b.condition == "0u" ? "" : "if (HAS(" + b.condition + ")) ";
        for (const std::string& at : written(s, b)) {
            const bool is_float = b.type != "uint";
            const std::string old = "old" + std::to_string(count++), value = member + b.name + at;
            before << "    " << (is_float ? "float" : "uint") << " " << old << " = " << (is_float ? "0.0f" : "0u")
                   << ";\n    if (look) {\n        " << has << old << " = " << value << ";\n    }\n";
            after << "        " << has << "changed = changed || "
                  << (is_float ? "float_bits(" + value + ") != float_bits(" + old + ")" : value + " != " + old) << ";\n";
        }
    }
    return before.str() + "    " + member + "kernel(i, j);\n    if (look) {\n" + after.str() + "    }\n";
}

std::string shared_macros() {
    return "#define SHARED_PITCH " + std::to_string(shared_pitch) + "\n#define SHARED_BESIDE " + std::to_string(shared_beside) +
           "\nFN int nearest_index(int at, int last) { return at < 0 ? 0 : at > last ? last : at; }\n";
}

std::string tile_part(const std::string& m, const std::string& skip) {
    std::string text;
    for (const auto& [axis, place, size, part] : {std::array{"i", "tile % P.tile_columns", "FUSED_COLUMNS", "part % across"},
                                                  std::array{"j", "tile / P.tile_columns", "FUSED_ROWS", "part / across"}}) {
        const std::string low = m + "own_" + axis + "0", high = m + "own_" + axis + "1", first = std::string("first_") + axis;
        text += "        int " + first + " = (" + place + ") * P.tile_size;\n        " + low + " = " + first + " + (" + part +
                ") * " + size + ";\n        " + high + " = " + low + " + " + size + " < " + first + " + P.tile_size ? " + low +
                " + " + size + " : " + first + " + P.tile_size;\n";
    }
    return text + "        if (" + m + "own_i0 > P.nx || " + m + "own_j0 > P.ny) " + skip + ";\n";
}

std::string rim_place(const Stage& s) {
    bool ghosts = false;
    for (const auto& b : s.bindings) ghosts |= b.access != "IN" && b.type == "float";
    return std::string("    int west_east = 2 * P.ny;\n    bool along_y = i < west_east;\n"
                       "    bool low = along_y ? i < P.ny : i < west_east + P.nx;\n"
                       "    int along = along_y ? (low ? i : i - P.ny) : (low ? i - west_east : i - west_east - P.nx);\n"
                       "    int x = along_y ? (low ? 0 : P.nx) : along;\n    int y = along_y ? along : (low ? 0 : P.ny);\n") +
           (ghosts ? "    int at = IDX(x, y);\n    int ghost = low ? (along_y ? at - 1 : at - P.pitch) : at;\n" : "") +
           "    int size = P.tile_size > 0 ? P.tile_size : 1;\n    int tile = (y / size) * P.tile_columns + x / size;\n";
}

} // namespace stagec
