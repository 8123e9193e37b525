#include "writers.hpp"
#include <sstream>

namespace stagec {

namespace {

std::string tile_bindings(const Stage& s) {
    const std::size_t slots = s.bindings.size();
    return "layout(std430, set = 0, binding = " + std::to_string(slots + 2) +
           ") readonly buffer active_list_block { uint active_list[]; };\nlayout(std430, set = 0, binding = " +
           std::to_string(slots + 3) + ") buffer activity_block { uint activity[]; };\n";
}

const char* const head = "#version 450\n#extension GL_GOOGLE_include_directive : require\n#include \"language/stage_glsl.h\"\n";

// Rows of a group begin at multiples of four elements, in memory as in shared rows: each buffer has a second name, for four
// floats at once.
const char* const four_floats =
    "#define WIDE 4\n#define COPY(TO, T, FROM, F) { vec4 four = wide_##FROM[(F) >> 2]; TO[T] = four.x; TO[(T) + 1] = four.y; "
    "TO[(T) + 2] = four.z; TO[(T) + 3] = four.w; }\n"
    "#define ZERO(TO, T) { TO[T] = 0.0f; TO[(T) + 1] = 0.0f; TO[(T) + 2] = 0.0f; TO[(T) + 3] = 0.0f; }\n#define COPIED\n"
    "#define HOLDS(FIELD, AT) any(notEqual(wide_##FIELD[(AT) >> 2], vec4(0.0f)))\n#define LOAD(FIELD, AT) FIELD[AT]\n"
    "#define KEEP_FOUR(PLACE, VALUE) { vec4 four = VALUE; if (look) changed = changed || any(notEqual(floatBitsToInt(PLACE), "
    "floatBitsToInt(four))); PLACE = four; }\n"
    "#define KEEP_ZEROS(FIELD, AT) KEEP_FOUR(wide_##FIELD[(AT) >> 2], vec4(0.0f))\n"
    "#define KEEP_COPY(FIELD, AT, FROM) KEEP_FOUR(wide_##FIELD[(AT) >> 2], wide_##FROM[(AT) >> 2])\n";

std::string wide_names(const Stage& s) {
    std::string text;
    for (const auto& b : s.bindings)
        text += "layout(std430, set = 0, binding = " + std::to_string(b.slot) + " + 2) " + (b.access == "IN" ? "readonly " : "") +
                "buffer " + b.name + "_wide_block { vec4 wide_" + b.name + "[]; };\n";
    return text;
}

} // namespace

std::string write_glsl(const Stage& s) {
    std::ostringstream o;
    o << head << stage_text(s);
    if (marks(s)) o << tile_bindings(s);
    o << "void main() {\n    int i = int(gl_GlobalInvocationID.x);\n    int j = int(gl_GlobalInvocationID.y);\n";
    if (!marks(s)) {
        o << "    if (" << guard(s.extent) << ") kernel(i, j);\n}\n";
        return o.str();
    }
    if (s.extent == "RIM") {
        o << "    if (!(" << guard(s.extent) << ")) return;\n" << rim_place(s);
    } else {
        o << "    int tile = 0;\n    if (ACTIVE_TILES != 0u) {\n        tile = int(active_list[gl_WorkGroupID.x]);\n"
          << "        int row = int(gl_WorkGroupID.y * gl_WorkGroupSize.y + gl_LocalInvocationID.y);\n"
          << "        if (row >= P.tile_size) return;\n"
          << "        i = (tile % P.tile_columns) * P.tile_size + int(gl_LocalInvocationID.x);\n"
          << "        j = (tile / P.tile_columns) * P.tile_size + row;\n    }\n"
          << "    if (!(" << guard(s.extent) << ")) return;\n    int at = IDX(i, j);\n";
    }
    o << "    bool look = false;\n    if (ACTIVE_TILES != 0u) look = activity[tile] != uint(S.step);\n    bool changed = false;\n"
      << marking(s, "") << marked << "}\n";
    return o.str();
}

std::string write_glsl(const FusedStage& whole, const Effects& effects) {
    FusedStage f = fitted(whole, shared_bytes_everywhere);
    // Vulkan has no word for how many groups are to share a multiprocessor: with two cells at once drivers give step_mixed_water
    // 96 registers a thread instead of 72, and it takes a third longer (tests/lab/results/ways_of_running.md).
    f.cells_each = 1;
    const Stage& s = f.stage;
    std::ostringstream o;
    o << head << physics_includes(f) << "#undef HAS\n#define HAS(BITS) (((EFFECTS | " << f.needs << "u) & (BITS)) == (BITS))\n"
      << "#define Place ivec2\n#define PLACE(X, Y) ivec2(X, Y)\n"
      << index_macros << shared_macros() << four_floats << wide_names(s)
      << "#define LANE int(gl_LocalInvocationIndex)\n#define LANES " << fused_group_x * fused_group_y
      << "\n#define BARRIER barrier()\n#define ROLLED\n#define APART(X)\n#define PART_FUNCTION\n#define NOT_KEPT(X)\n"
      << keep_stored;
    for (const auto& b : s.bindings) o << b.access << "(" << b.slot << ", " << b.type << ", " << b.name << ")\n";
    o << tile_bindings(s);
    for (const auto& rows : windows(f)) o << "shared float window_" << rows.field << "[" << rows.rows() * shared_pitch << "];\n";
    for (const auto& rows : staged(f)) o << "shared float staged_" << rows.field << "[" << rows.rows() * shared_pitch << "];\n";
    // The last barrier: the next call's first line must not come ahead of anyone's look.
    o << "shared uint group_holds;\nbool any_of_group(int holds) {\n    if (LANE == 0) group_holds = 0u;\n    barrier();\n"
         "    if (holds != 0) group_holds = 1u;\n    barrier();\n    bool any = group_holds != 0u;\n    barrier();\n"
         "    return any;\n}\n#define ANY(X) any_of_group(X)\n"
         "bool look = false;\n"
      << own_variables(f) << part_functions(f, effects, "(EFFECTS | " + std::to_string(f.needs) + "u)")
      << "void main() {\n    own_i0 = int(gl_WorkGroupID.x) * FUSED_COLUMNS;\n    own_j0 = int(gl_WorkGroupID.y) * FUSED_ROWS;\n"
      << "    own_i1 = own_i0 + FUSED_COLUMNS;\n    own_j1 = own_j0 + FUSED_ROWS;\n    int tile = 0;\n"
      << "    if (ACTIVE_TILES != 0u) {\n        tile = int(active_list[gl_WorkGroupID.x]);\n        int part = "
         "int(gl_WorkGroupID.y);\n"
         "        int across = (P.tile_size + FUSED_COLUMNS - 1) / FUSED_COLUMNS;\n"
      << tile_part("", "return") << "        look = activity[tile] != uint(S.step);\n    }\n"
      << phase_loops(f, effects) << "    if (changed) activity[tile] = uint(S.step);\n}\n";
    return o.str();
}

} // namespace stagec
