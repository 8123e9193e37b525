#include "writers.hpp"
#include <algorithm>
#include <sstream>

namespace stagec {

namespace {

// The buffers behind the slots, as the stage's members take them.
std::string buffer_members(const Stage& s) {
    std::ostringstream o;
    o << "#ifdef WADI_STAGE_CHECKED\n";
    for (const auto& b : s.bindings) {
        const std::string type = (b.access == "IN" ? "const " : "") + b.type;
        o << ",\n        {static_cast<" << type << "*>(b[" << b.slot << "]), sizes[" << b.slot << "] / sizeof(" << b.type
          << "), \"" << s.name << "\", \"" << b.name << "\"}";
    }
    o << "\n#else\n";
    for (const auto& b : s.bindings)
        o << ",\n        static_cast<" << (b.access == "IN" ? "const " : "") << b.type << "*>(b[" << b.slot << "])";
    o << "\n#endif\n";
    return o.str();
}

std::string block_head() {
    return "template <unsigned E> static void block(void* const* b, const unsigned long long* sizes, const void* params, const "
           "void* "
           "input,"
           " int i0, int i1, int j0, int j1) {\n    (void)b;\n    (void)sizes;\n"
           "    const WorldParams P = *static_cast<const WorldParams*>(params);\n"
           "    const StepInput& S = *static_cast<const StepInput*>(input);\n";
}

std::string file_head(const Stage& s, const std::string& isa) {
    return "// Written by stagec from " + s.name + (s.fused ? ".fused" : ".stage") + " for the instruction set " + isa +
           ".\nnamespace wadi_stage_" + isa + " {\n#include \"language/stage_cpp.h\"\n";
}

// The lowest set has every mask, and what another lacks is that of the set below.
std::string select_function(const Stage& s, const CpuSet& set, unsigned tested, std::vector<unsigned> masks,
                            const Effects& effects) {
    const auto& [isa, below, chosen] = set;
    if (!below.empty() && chosen != "all") {
        const unsigned choices = ~(effects.at(first_choice) - 1), usual = effects.at(usual_choice);
        const auto all = masks, kept = largest(masks, choices);
        const auto has = [](const std::vector<unsigned>& list, unsigned mask) {
            return std::find(list.begin(), list.end(), mask) != list.end();
        };
        std::erase_if(masks, [&, common = chosen == "common"](unsigned mask) {
            const bool of_default = (mask & choices & ~usual) == 0 && ((mask & usual) != 0 || !has(all, mask | usual));
            return !(common && of_default) && !has(kept, mask);
        });
    }
    std::ostringstream o;
    o << "using Block = void (*)(void* const*, const unsigned long long*, const void*, const void*, int, int, int, int);\n";
    if (!below.empty()) o << "extern \"C\" Block wadi_cpu_" << below << "_" << s.name << "(unsigned effects);\n";
    o << "extern \"C\" Block wadi_cpu_" << isa << "_" << s.name << "(unsigned effects) {\n    switch (effects & " << tested
      << "u) {\n";
    for (const unsigned mask : masks) o << "    case " << mask << "u: return wadi_stage_" << isa << "::block<" << mask << "u>;\n";
    o << "    default: return " << (below.empty() ? "nullptr" : "wadi_cpu_" + below + "_" + s.name + "(effects)")
      << ";\n    }\n}\n";
    return o.str();
}

} // namespace

std::string write_cpp(const Stage& s, const CpuSet& set, const Effects& effects) {
    const unsigned tested = tested_bits(s, effects);
    std::ostringstream o;
    o << file_head(s, set.isa) << stage_text(s) << block_head() << "    const " << s.struct_name << "<E> stage{P, S\n"
      << buffer_members(s) << "    };\n    for (int j = j0; j < j1; ++j) {\n        const " << s.struct_name
      << "<E> local = stage;\n"
      << (length(s.extent).empty()
              ? ""
              : "        const int row = " + length(s.extent) + " - j * POINT_ROW;\n        i1 = row < i1 ? row : i1;\n")
      << "#if defined(__GNUC__) && !defined(__clang__)\n#pragma GCC ivdep\n#elif defined(__clang__)\n#pragma clang loop "
         "vectorize(assume_safety)\n#endif\n"
      << "        for (int i = i0; i < i1; ++i) local.kernel(i, j);\n    }\n}\n} // namespace\n"
      << select_function(s, set, tested, masks(tested), effects);
    return o.str();
}

// One window after the other, what a GPU keeps in shared memory on the stack. Slower than the stages one by one: it is there to
// be compared with them.
std::string write_cpp(const FusedStage& f, const CpuSet& set, const Effects& effects) {
    const Stage& s = f.stage;
    std::ostringstream o;
    // What is loaded from a buffer that the fused stage's masks do not have is a constant, and its place used by nobody.
    o << file_head(s, set.isa)
      << "#pragma GCC diagnostic ignored \"-Wunused-but-set-variable\"\n#pragma GCC diagnostic ignored \"-Wunused-parameter\"\n"
      << physics_includes(f) << "struct Place { int x, y; };\n#define PLACE(X, Y) Place{X, Y}\n"
      << index_macros << shared_macros() << one_by_one
      << "#define LANE 0\n#define LANES 1\n#define BARRIER (void)0\n#define ANY(X) (X)\n#define ROLLED\n#define "
         "KEEP_STORED(FIELD, AT) FIELD[AT] = stored;\n"
      << "#define PART_FUNCTION HELPER\n#define APART(X)\n#define NOT_KEPT(X) (void)(X)\n"
      << "template <unsigned FREE> struct " << s.struct_name << " {\n    static constexpr unsigned EFFECTS = FREE | " << f.needs
      << "u;\n    const WorldParams& P;\n    const StepInput& S;\n";
    for (const auto& b : s.bindings)
        o << "    WADI_BUFFER(" << (b.access == "IN" ? "const " : "") << b.type << ") " << b.name << ";\n";
    for (const auto& rows : windows(f))
        o << "    float window_" << rows.field << "[" << rows.rows() * shared_pitch << "] = {};\n";
    for (const auto& rows : staged(f)) o << "    float staged_" << rows.field << "[" << rows.rows() * shared_pitch << "] = {};\n";
    o << own_variables(f) << part_functions(f, effects, "EFFECTS") << "void window() {\n"
      << phase_loops(f, effects) << "}\n};\n"
      << block_head() << "    " << s.struct_name << "<E> stage{P, S\n"
      << buffer_members(s)
      << "    };\n    for (int j = j0; j < j1; j += FUSED_ROWS) {\n        for (int i = i0; i < i1; i += "
         "FUSED_COLUMNS) {\n            stage.own_i0 = i;\n            stage.own_j0 = j;\n            stage.own_i1 = i + "
         "FUSED_COLUMNS < i1 ? i + FUSED_COLUMNS : i1;\n            stage.own_j1 = j + FUSED_ROWS < j1 ? j + FUSED_ROWS : "
         "j1;\n            stage.window();\n        }\n    }\n}\n} // namespace\n"
      << select_function(s, set, tested_bits(s, effects), masks(tested_bits(s, effects), f.needs, f.without), effects);
    return o.str();
}

} // namespace stagec
