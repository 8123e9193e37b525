// stagec: the build's own tool for stage files. It has no dependencies and is built first.
//   stagec glsl  EFFECTS_H STAGE OUT.comp          GLSL wrapper: prelude, stage, main()
//   stagec cpp   EFFECTS_H STAGE OUT.cpp ISA       every mask the stage distinguishes, for one instruction set
//   stagec cuda  EFFECTS_H STAGE OUT.cu            the same as CUDA kernels
//   stagec nocontract IN.spv OUT.spv               decorates every float operation NoContraction
//   stagec embed IN.spv OUT.inc                    a module as the words of a C++ array
//   stagec table EFFECTS_H OUT.cpp SPIRV_DIR|- STAGES...   the stage table that the engine reads
//   stagec cpurows OUT.cpp ISAS STAGES...          the CPU backend's index of the compiled stages
//   stagec cudarows OUT.cpp STAGES...              the CUDA backend's index of the compiled kernels
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

[[noreturn]] void fail(const std::string& message) {
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

struct Binding {
    std::string name, type, access, condition;
    int slot = 0;
};

struct Stage {
    std::string path, name, struct_name, extent;
    int reach = -1; // cells from the kernel's own index to the farthest that it reads
    std::vector<Binding> bindings;
    std::vector<std::string> tested; // effect names that HAS() or a condition asks
};

const std::set<std::string> extents = {"CELLS", "FACES", "RIM", "STRIPS", "SOURCE_BOX", "POINTS", "TILES", "TILE_ROWS"};

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

// The arguments of a macro call whose name ends at `at`; empty when no parenthesis follows.
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

Stage parse(const std::string& path) {
    Stage stage;
    stage.path = path;
    stage.name = stem(path);
    const std::string text = strip_comments(read_text(path));
    std::set<std::string> tested;
    const auto note_effects = [&](const std::string& expression) {
        std::size_t at = 0;
        while ((at = expression.find("EFFECT_", at)) != std::string::npos) {
            std::size_t end = at;
            while (end < expression.size() &&
                   (std::isalnum(static_cast<unsigned char>(expression[end])) || expression[end] == '_'))
                ++end;
            tested.insert(expression.substr(at, end - at));
            at = end;
        }
    };
    std::size_t at = 0;
    while (at < text.size()) {
        if (!std::isalpha(static_cast<unsigned char>(text[at]))) {
            ++at;
            continue;
        }
        std::size_t end = at;
        while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_')) ++end;
        const std::string word = text.substr(at, end - at);
        at = end;
        const bool conditional = word == "IN_IF" || word == "OUT_IF" || word == "INOUT_IF";
        if (word == "STAGE") {
            stage.struct_name = arguments(text, end).at(0);
        } else if (word == "EXTENT") {
            stage.extent = arguments(text, end).at(0);
        } else if (word == "REACH") {
            stage.reach = std::atoi(arguments(text, end).at(0).c_str());
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
            if (b.slot != static_cast<int>(stage.bindings.size()))
                fail(path + ": slot of " + b.name + " is " + a[shift] + ", expected " + std::to_string(stage.bindings.size()));
            stage.bindings.push_back(b);
        }
    }
    if (stage.struct_name.empty()) fail(path + ": no STAGE(Name)");
    if (!extents.count(stage.extent))
        fail(path + ": EXTENT must be CELLS, FACES, RIM, STRIPS, SOURCE_BOX, POINTS, TILES or TILE_ROWS");
    const bool grid = stage.extent == "CELLS" || stage.extent == "FACES" || stage.extent == "RIM";
    if (stage.reach < 0) stage.reach = grid ? 1 : 0;
    if (stage.reach > 2) fail(path + ": REACH is at most 2, the width of the ghosts");
    stage.tested.assign(tested.begin(), tested.end());
    return stage;
}

std::map<std::string, unsigned> parse_effects(const std::string& path) {
    std::map<std::string, unsigned> effects;
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

unsigned tested_bits(const Stage& stage, const std::map<std::string, unsigned>& effects) {
    unsigned bits = 0;
    for (const auto& name : stage.tested) {
        const auto found = effects.find(name);
        if (found == effects.end()) fail(stage.path + ": unknown effect " + name);
        bits |= found->second;
    }
    return bits;
}

// Every mask that the stage can tell apart: all subsets of the bits it tests.
std::vector<unsigned> masks(unsigned tested) {
    std::vector<unsigned> result;
    unsigned mask = 0;
    do {
        result.push_back(mask);
        mask = (mask - tested) & tested;
    } while (mask != 0);
    return result;
}

// The index range of an extent as guards; must agree with extent_range() in engine/compute.
std::string guard(const std::string& extent) {
    if (extent == "CELLS") return "i < P.nx && j < P.ny";
    if (extent == "FACES") return "i <= P.nx && j <= P.ny";
    if (extent == "RIM") return "i < 2 * (P.nx + P.ny) && j < 1";
    if (extent == "STRIPS") return "i <= P.nx && j < P.strips";
    if (extent == "TILES") return "i < P.tile_columns && j < P.tile_rows";
    if (extent == "TILE_ROWS") return "i < 1 && j < P.tile_rows";
    if (extent == "POINTS") return "i < POINT_ROW && j * POINT_ROW + i < S.point_count";
    return "i < P.source_i1 && j < P.source_s1";
}

std::string origin(const std::string& extent, const char* axis) {
    if (extent != "SOURCE_BOX") return "";
    return axis[0] == 'i' ? " + P.source_i0" : " + P.source_s0";
}

// Stages that run over a list of active tiles, and stages of the rim, which run whole but tell what they changed.
bool marks(const Stage& s) {
    bool marks = s.extent == "CELLS" || s.extent == "FACES" || s.extent == "RIM";
    for (const auto& b : s.bindings) marks &= b.access == "IN" || b.type == "float" || (s.extent == "RIM" && b.type == "uint");
    return marks;
}

// Where a kernel at (i, j) writes a buffer. RIM: its face and the ghost outside, the low words of its counts in and out.
std::vector<std::string> written(const Stage& s, const Binding& b) {
    if (s.extent != "RIM") return {"at"};
    if (b.type == "uint") return {"i", "4 * (P.nx + P.ny) + i"};
    return {"at", "ghost"};
}

// Runs the kernel and stamps its tile with the step if a bit of what it writes is another than before. Once a tile has its stamp
// nobody looks any more. Threads of one tile store the same value, so that their order does not matter.
std::string marking(const Stage& s, const std::string& member) {
    std::ostringstream before, after;
    int count = 0;
    for (const auto& b : s.bindings) {
        if (b.access == "IN") continue;
        const std::string has = b.condition == "0u" ? "" : "if (HAS(" + b.condition + ")) ";
        for (const std::string& at : written(s, b)) {
            const bool is_float = b.type == "float";
            const std::string old = "old" + std::to_string(count++), value = member + b.name + "[" + at + "]";
            before << "    " << b.type << " " << old << " = " << (is_float ? "0.0f" : "0u") << ";\n    if (look) {\n        "
                   << has << old << " = " << value << ";\n    }\n";
            after << "        " << has << "changed = changed || "
                  << (is_float ? "float_bits(" + value + ") != float_bits(" + old + ")" : value + " != " + old) << ";\n";
        }
    }
    return before.str() + "    " + member + "kernel(i, j);\n    if (look) {\n        bool changed = false;\n" + after.str() +
           "        if (changed) activity[tile] = uint(S.step);\n    }\n";
}

// The place of a rim kernel: its face, the cell outside it where that is written, the tile that holds the face.
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

std::string glsl(const Stage& s) {
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

std::string cpp(const Stage& s, const std::string& isa, unsigned tested) {
    std::ostringstream o;
    o << "// Written by stagec from " << s.name << ".stage for the instruction set " << isa << ".\n"
      << "namespace wadi_stage_" << isa << " {\n#include \"stage_cpp.h\"\n#include \"stages/" << s.name << ".stage\"\n"
      << "template <unsigned E> static void block(void* const* b, const unsigned long* sizes, const void* params, const void* "
         "input,"
      << " int i0, int i1, int j0, int j1) {\n    (void)b;\n    (void)sizes;\n"
      << "    const WorldParams P = *static_cast<const WorldParams*>(params);\n    const StepInput& S = *static_cast<const "
         "StepInput*>(input);\n"
      << "#ifdef WADI_STAGE_CHECKED\n    const " << s.struct_name << "<E> stage{P, S";
    for (const auto& b : s.bindings) {
        const std::string type = (b.access == "IN" ? "const " : "") + b.type;
        o << ",\n        {static_cast<" << type << "*>(b[" << b.slot << "]), sizes[" << b.slot << "] / sizeof(" << b.type
          << "), \"" << s.name << "\", \"" << b.name << "\"}";
    }
    o << "};\n#else\n    const " << s.struct_name << "<E> stage{P, S";
    for (const auto& b : s.bindings) {
        o << ",\n        static_cast<" << (b.access == "IN" ? "const " : "") << b.type << "*>(b[" << b.slot << "])";
    }
    o << "};\n#endif\n    for (int j = j0; j < j1; ++j) {\n        const " << s.struct_name << "<E> local = stage;\n"
      << (s.extent == "POINTS" ? "        const int row = S.point_count - j * POINT_ROW;\n        i1 = row < i1 ? row : i1;\n"
                               : "")
      << "#if defined(__GNUC__) && !defined(__clang__)\n#pragma GCC ivdep\n#elif defined(__clang__)\n#pragma clang loop "
         "vectorize(assume_safety)\n#endif\n"
      << "        for (int i = i0; i < i1; ++i) local.kernel(i, j);\n    }\n}\n} // namespace\n"
      << "using Block = void (*)(void* const*, const unsigned long*, const void*, const void*, int, int, int, int);\n"
      << "extern \"C\" Block wadi_cpu_" << isa << "_" << s.name << "(unsigned effects) {\n    switch (effects & " << tested
      << "u) {\n";
    for (const unsigned mask : masks(tested))
        o << "    case " << mask << "u: return wadi_stage_" << isa << "::block<" << mask << "u>;\n";
    o << "    default: return nullptr;\n    }\n}\n";
    return o.str();
}

// Group sizes with kernels of their own: the compiler then knows the limits of the indices and may use more registers.
// {0, 0} takes any group. The defaults of backends/cuda are among them.
struct CudaGroup {
    int x, y;
};
const CudaGroup cuda_groups[] = {{64, 4}, {256, 1}, {0, 0}};

// As C++ and GLSL have them, but members of `stage` stand behind a dot.
std::string cuda_active(const Stage& s) {
    std::ostringstream o;
    o << "struct Active { const uint* list; const uint* count; uint* activity; };\n"
      << "template <unsigned EFFECTS> __global__ void __launch_bounds__(256)\n"
      << "run_active(const WorldParams P, const StepInput* __restrict__ input, const Slots b, const Active tiles) {\n"
      << "    const StepInput& S = *input;\n    const " << s.struct_name << "<EFFECTS> stage{P, S";
    for (const auto& b : s.bindings)
        o << ",\n        static_cast<" << (b.access == "IN" ? "const " : "") << b.type << "*>(b.at[" << b.slot << "])";
    const std::string look = "    const bool look = activity[tile] != uint(S.step);\n";
    o << "};\n    volatile uint* const activity = tiles.activity;\n";
    if (s.extent == "RIM") {
        o << "    const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);\n    const int j = 0;\n    if (!("
          << guard(s.extent) << ")) return;\n"
          << rim_place(s) << look << marking(s, "stage.") << "}\n";
        return o.str();
    }
    o << "    const uint count = *tiles.count;\n"
      << "    for (uint n = blockIdx.x; n < count; n += gridDim.x) {\n    const int tile = static_cast<int>(tiles.list[n]);\n"
      << "    const int i = (tile % P.tile_columns) * P.tile_size + static_cast<int>(threadIdx.x);\n"
      << "    for (int row = static_cast<int>(threadIdx.y); row < P.tile_size; row += static_cast<int>(blockDim.y)) {\n"
      << "    const int j = (tile / P.tile_columns) * P.tile_size + row;\n    if (!(" << guard(s.extent)
      << ")) continue;\n    const int at = IDX(i, j);\n"
      << look << marking(s, "stage.") << "    }\n    }\n}\n";
    return o.str();
}

// A namespace per stage: kernels of two files that had one name would be one function to the linker.
std::string cuda(const Stage& s, unsigned tested) {
    const std::string space = "wadi_stage_cuda_" + s.name;
    std::ostringstream o;
    o << "// Written by stagec from " << s.name << ".stage.\nnamespace " << space
      << " {\n#include \"stage_cuda.h\"\n#include \"stages/" << s.name << ".stage\"\n"
      << "struct Slots { void* at[" << (s.bindings.empty() ? 1 : s.bindings.size()) << "]; };\n"
      << "template <unsigned E, int X, int Y> __global__ void __launch_bounds__(X > 0 ? X * Y : 1024)\n"
      << "run(const WorldParams P, const StepInput* __restrict__ input, const Slots b) {\n    const StepInput& S = *input;\n    "
         "const "
      << s.struct_name << "<E> stage{P, S";
    for (const auto& b : s.bindings)
        o << ",\n        static_cast<" << (b.access == "IN" ? "const " : "") << b.type << "*>(b.at[" << b.slot << "])";
    o << "};\n    const int i = static_cast<int>(blockIdx.x * (X > 0 ? X : blockDim.x) + threadIdx.x)" << origin(s.extent, "i")
      << ";\n    const int j = static_cast<int>(blockIdx.y * (Y > 0 ? Y : blockDim.y) + threadIdx.y)" << origin(s.extent, "j")
      << ";\n    if (" << guard(s.extent) << ") stage.kernel(i, j);\n}\n"
      << "template <unsigned E> static const void* select(int x, int y) {\n";
    for (const auto& g : cuda_groups) {
        if (g.x > 0) o << "    if (x == " << g.x << " && y == " << g.y << ")\n    ";
        o << "    return reinterpret_cast<const void*>(&run<E, " << g.x << ", " << g.y << ">);\n";
    }
    o << "}\n";
    if (marks(s)) o << cuda_active(s);
    o << "} // namespace " << space << "\nextern \"C\" const void* wadi_cuda_" << s.name
      << "(unsigned effects, int x, int y) {\n    switch (effects) {\n";
    for (const unsigned mask : masks(tested))
        o << "    case " << mask << "u: return " << space << "::select<" << mask << "u>(x, y);\n";
    o << "    default: return nullptr;\n    }\n}\nextern \"C\" const void* wadi_cuda_active_" << s.name
      << "([[maybe_unused]] unsigned effects) {\n";
    if (marks(s)) {
        o << "    switch (effects) {\n";
        for (const unsigned mask : masks(tested))
            o << "    case " << mask << "u: return reinterpret_cast<const void*>(&" << space << "::run_active<" << mask
              << "u>);\n";
        o << "    default: break;\n    }\n";
    }
    o << "    return nullptr;\n}\n";
    return o.str();
}

std::vector<std::uint32_t> read_words(const std::string& path) {
    const std::string bytes = read_text(path);
    if (bytes.size() < 20 || bytes.size() % 4 != 0) fail(path + ": not a SPIR-V module");
    std::vector<std::uint32_t> words(bytes.size() / 4);
    for (std::size_t i = 0; i < words.size(); ++i) {
        std::uint32_t w = 0;
        for (std::size_t b = 4; b-- > 0;) w = w << 8 | static_cast<unsigned char>(bytes[4 * i + b]);
        words[i] = w;
    }
    if (words[0] != 0x07230203u) fail(path + ": wrong SPIR-V magic number");
    return words;
}

// `precise` in glslang 12 does not reach through function calls, so the finished module is decorated instead:
// every float arithmetic result id gets NoContraction, ahead of the first type declaration.
void nocontract(const std::string& in, const std::string& out) {
    const auto words = read_words(in);
    std::vector<std::uint32_t> decorations;
    std::size_t first_type = 0;
    for (std::size_t at = 5; at < words.size();) {
        const std::uint32_t op = words[at] & 0xffffu, length = words[at] >> 16;
        if (length == 0 || at + length > words.size()) fail(in + ": broken instruction");
        if (first_type == 0 && op >= 19 && op <= 39) first_type = at;
        const bool arithmetic = op == 127 || op == 129 || op == 131 || op == 133 || op == 136 || (op >= 140 && op <= 148);
        if (arithmetic) decorations.insert(decorations.end(), {(3u << 16) | 71u, words[at + 2], 42u});
        at += length;
    }
    if (first_type == 0) fail(in + ": no types");
    std::vector<std::uint32_t> result(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(first_type));
    result.insert(result.end(), decorations.begin(), decorations.end());
    result.insert(result.end(), words.begin() + static_cast<std::ptrdiff_t>(first_type), words.end());
    std::string bytes;
    for (const std::uint32_t w : result) {
        for (int b = 0; b < 4; ++b) bytes += static_cast<char>(w >> (8 * b) & 0xffu);
    }
    write_text(out, bytes);
}

std::string word_list(const std::string& module) {
    std::ostringstream o;
    int column = 0;
    for (const std::uint32_t w : read_words(module)) o << (column++ % 12 == 0 ? "\n    " : " ") << w << "u,";
    return o.str();
}

std::string table(const std::vector<Stage>& stages, const std::map<std::string, unsigned>& effects,
                  const std::string& spirv_dir) {
    std::ostringstream o;
    o << "// Written by stagec from the stage files.\n#include \"engine/compute/stage_table.hpp\"\n#include <array>\nnamespace "
         "wadi::compute {\nnamespace {\n";
    for (const auto& s : stages) {
        o << "constexpr StageBinding bindings_" << s.name << "[] = {\n";
        for (const auto& b : s.bindings) {
            const std::map<std::string, std::string> types = {
                {"float", "f32"}, {"uint", "u32"}, {"int", "i32"}, {"vec2", "vec2"}, {"vec4", "vec4"}};
            const std::map<std::string, std::string> access = {{"IN", "in"}, {"OUT", "out"}, {"INOUT", "inout"}};
            if (!types.count(b.type))
                fail(s.path + ": type " + b.type + " of " + b.name + " is not float, uint, int, vec2 or vec4");
            o << "    {\"" << b.name << "\", " << b.slot << ", Access::" << access.at(b.access)
              << ", Scalar::" << types.at(b.type) << ", " << b.condition << "},\n";
        }
        o << "};\n";
        if (spirv_dir != "-") {
            o << "constexpr std::uint32_t spirv_" << s.name << "[] = {" << word_list(spirv_dir + "/" + s.name + ".spv")
              << "\n};\n";
        }
    }
    o << "constexpr StageInfo stages[] = {\n";
    for (const auto& s : stages) {
        std::string extent = s.extent;
        for (auto& c : extent) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        o << "    {\"" << s.name << "\", Extent::" << extent << ", " << s.reach << ", " << (marks(s) ? "true" : "false") << ", "
          << tested_bits(s, effects) << "u, bindings_" << s.name << ", "
          << (spirv_dir != "-" ? "spirv_" + s.name : "std::span<const std::uint32_t>{}") << "},\n";
    }
    o << "};\n} // namespace\nstd::span<const StageInfo> stage_table() {\n    return stages;\n}\n} // namespace wadi::compute\n";
    return o.str();
}

std::string cpurows(const std::string& isas, const std::vector<std::string>& stages) {
    std::ostringstream o;
    std::vector<std::string> sets;
    std::istringstream list(isas);
    for (std::string isa; std::getline(list, isa, ',');) sets.push_back(isa);
    o << "// Written by stagec: which function runs a stage, by instruction set; in the order of the stage table.\n"
      << "#include \"backends/cpu/cpu_stages.hpp\"\nextern \"C\" {\n";
    for (const auto& isa : sets)
        for (const auto& s : stages) o << "wadi::cpu::StageBlock wadi_cpu_" << isa << "_" << s << "(unsigned effects);\n";
    o << "}\nnamespace wadi::cpu {\nnamespace {\n";
    for (const auto& isa : sets) {
        o << "constexpr StageSelect select_" << isa << "[] = {\n";
        for (const auto& s : stages) o << "    wadi_cpu_" << isa << "_" << s << ",\n";
        o << "};\n";
    }
    o << "constexpr InstructionSet sets[] = {\n";
    for (const auto& isa : sets) o << "    {\"" << isa << "\", select_" << isa << "},\n";
    o << "};\n} // namespace\nstd::span<const InstructionSet> instruction_sets() {\n    return sets;\n}\n} // namespace "
         "wadi::cpu\n";
    return o.str();
}

std::string cudarows(const std::vector<std::string>& stages) {
    std::ostringstream o;
    o << "// Written by stagec: which function selects a stage's kernel; in the order of the stage table.\n"
      << "#include \"backends/cuda/cuda_stages.hpp\"\nextern \"C\" {\n";
    for (const auto& s : stages)
        o << "const void* wadi_cuda_" << s << "(unsigned effects, int group_x, int group_y);\nconst void* wadi_cuda_active_" << s
          << "(unsigned effects);\n";
    o << "}\nnamespace wadi::cuda {\nstd::span<const KernelSelect> kernels() {\n    static constexpr KernelSelect list[] = {\n";
    for (const auto& s : stages) o << "        wadi_cuda_" << s << ",\n";
    o << "    };\n    return list;\n}\nstd::span<const ActiveKernelSelect> active_kernels() {\n    static constexpr "
         "ActiveKernelSelect list[] = {\n";
    for (const auto& s : stages) o << "        wadi_cuda_active_" << s << ",\n";
    o << "    };\n    return list;\n}\n} // namespace wadi::cuda\n";
    return o.str();
}

} // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> a(argv + 1, argv + argc);
    const std::string mode = a.empty() ? "" : a[0];
    if (mode == "glsl" && a.size() == 4) {
        write_text(a[3], glsl(parse(a[2])));
    } else if (mode == "cpp" && a.size() == 5) {
        const Stage s = parse(a[2]);
        write_text(a[3], cpp(s, a[4], tested_bits(s, parse_effects(a[1]))));
    } else if (mode == "cuda" && a.size() == 4) {
        const Stage s = parse(a[2]);
        write_text(a[3], cuda(s, tested_bits(s, parse_effects(a[1]))));
    } else if (mode == "nocontract" && a.size() == 3) {
        nocontract(a[1], a[2]);
    } else if (mode == "embed" && a.size() == 3) {
        write_text(a[2], "// Written by stagec." + word_list(a[1]) + "\n");
    } else if (mode == "table" && a.size() >= 5) {
        std::vector<Stage> stages;
        for (std::size_t i = 4; i < a.size(); ++i) stages.push_back(parse(a[i]));
        write_text(a[2], table(stages, parse_effects(a[1]), a[3]));
    } else if (mode == "cpurows" && a.size() >= 4) {
        std::vector<std::string> names;
        for (std::size_t i = 3; i < a.size(); ++i) names.push_back(stem(a[i]));
        write_text(a[1], cpurows(a[2], names));
    } else if (mode == "cudarows" && a.size() >= 3) {
        std::vector<std::string> names;
        for (std::size_t i = 2; i < a.size(); ++i) names.push_back(stem(a[i]));
        write_text(a[1], cudarows(names));
    } else {
        fail("usage: glsl|cpp|cuda|nocontract|embed|table|cpurows|cudarows ... (see the top of stagec.cpp)");
    }
    return 0;
}
