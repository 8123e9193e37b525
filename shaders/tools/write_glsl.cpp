#include "writers.hpp"
#include <sstream>

namespace stagec {

std::string write_glsl(const Stage& s) {
    std::ostringstream o;
    o << "#version 450\n#extension GL_GOOGLE_include_directive : require\n#include \"stage_glsl.h\"\n#include \"stages/" << s.name
      << ".stage\"\n";
    const std::size_t slots = s.bindings.size();
    if (marks(s)) {
        o << "layout(std430, set = 0, binding = " << slots + 2 << ") readonly buffer active_list_block { uint active_list[]; };\n"
          << "layout(std430, set = 0, binding = " << slots + 3 << ") buffer activity_block { uint activity[]; };\n";
    }
    o << "void main() {\n    int i = int(gl_GlobalInvocationID.x)" << origin(s.extent, "i")
      << ";\n    int j = int(gl_GlobalInvocationID.y)" << origin(s.extent, "j") << ";\n";
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
    o << "    bool look = false;\n    if (ACTIVE_TILES != 0u) look = activity[tile] != uint(S.step);\n"
      << marking(s, "") << "}\n";
    return o.str();
}

std::string write_glsl(const FusedStage& f, const Effects& effects) {
    const Stage& s = f.stage;
    std::ostringstream o;
    o << "#version 450\n#extension GL_GOOGLE_include_directive : require\n#include \"stage_glsl.h\"\n"
      << physics_includes(f) << "#undef HAS\n#define HAS(BITS) (((EFFECTS | " << f.needs << "u) & (BITS)) == (BITS))\n"
      << index_macros(f) << "#define FIRST_X int(gl_LocalInvocationID.x)\n#define STEP_X " << fused_group_x
      << "\n#define FIRST_Y int(gl_LocalInvocationID.y)\n#define STEP_Y " << fused_group_y
      << "\n#define BARRIER barrier()\n#define PART_FUNCTION\n#define NOT_KEPT(X)\n";
    for (const auto& b : s.bindings) o << b.access << "(" << b.slot << ", float, " << b.name << ")\n";
    for (const auto& name : fields_kept(f, Keeping::tile)) o << "shared float tile_" << name << "[" << tile_floats(f) << "];\n";
    for (const auto& name : fields_kept(f, Keeping::own_index)) o << "float own_" << name << ";\n";
    o << "int tile_i0, tile_j0, tile_base;\nbool owned;\n"
      << part_functions(f, effects) << "void main() {\n    int own_i0 = int(gl_WorkGroupID.x) * " << columns_of(f)
      << ";\n    int own_j0 = int(gl_WorkGroupID.y) * " << f.rows << ";\n    int own_i1 = own_i0 + " << columns_of(f)
      << ";\n    int own_j1 = own_j0 + " << f.rows << ";\n    PLACE_TILE(own_i0, own_j0);\n"
      << phase_loops(f) << "}\n";
    return o.str();
}

} // namespace stagec
