#include "writers.hpp"
#include <algorithm>
#include <sstream>

namespace stagec {

// Group sizes with kernels of their own: the compiler then knows the limits of the indices and may use more registers.
// {0, 0} takes any group. The defaults of backends/cuda are among them: one row for stages of the rim, 64 x 4 for others.
namespace {
struct CudaGroup {
    int x, y;
};
const CudaGroup cuda_groups[] = {{64, 4}, {256, 1}, {0, 0}};

const char* const active_argument = "struct Active { const uint* list; const uint* count; uint* activity; };\n";

// As C++ and GLSL have them, but members of `stage` stand behind a dot.
std::string cuda_active(const Stage& s) {
    std::ostringstream o;
    o << active_argument << "template <unsigned EFFECTS> __global__ void __launch_bounds__(256)\n"
      << "run_active(const WorldParams P, const StepInput* __restrict__ input, const Slots b, const Active tiles) {\n"
      << "    const StepInput& S = *input;\n    const " << s.struct_name << "<EFFECTS> stage{P, S";
    for (const auto& b : s.bindings)
        o << ",\n        static_cast<" << (b.access == "IN" ? "const " : "") << element_type(b, "EFFECTS") << "*>(b.at[" << b.slot
          << "])";
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

} // namespace

// A namespace per stage: kernels of two files that had one name would be one function to the linker.
std::string write_cuda(const Stage& s, const Effects& effects, bool all_masks) {
    const auto chosen = all_masks ? masks(tested_bits(s, effects)) : largest(masks(tested_bits(s, effects)));
    const std::string space = "wadi_stage_cuda_" + s.name;
    std::ostringstream o;
    o << "// Written by stagec from " << s.name << ".stage.\nnamespace " << space << " {\n#include \"language/stage_cuda.h\"\n"
      << stage_text(s) << "struct Slots { void* at[" << (s.bindings.empty() ? 1 : s.bindings.size()) << "]; };\n"
      << "template <unsigned E, int X, int Y> __global__ void __launch_bounds__(X > 0 ? X * Y : 1024)\n"
      << "run(const WorldParams P, const StepInput* __restrict__ input, const Slots b) {\n    const StepInput& S = *input;\n    "
         "const "
      << s.struct_name << "<E> stage{P, S";
    for (const auto& b : s.bindings)
        o << ",\n        static_cast<" << (b.access == "IN" ? "const " : "") << element_type(b, "E") << "*>(b.at[" << b.slot
          << "])";
    o << "};\n    const int i = static_cast<int>(blockIdx.x * (X > 0 ? X : blockDim.x) + threadIdx.x)" << origin(s.extent, "i")
      << ";\n    const int j = static_cast<int>(blockIdx.y * (Y > 0 ? Y : blockDim.y) + threadIdx.y)" << origin(s.extent, "j")
      << ";\n    if (" << guard(s.extent) << ") stage.kernel(i, j);\n}\n"
      << "template <unsigned E> static const void* select(int x, int y) {\n";
    for (const auto& g : cuda_groups) {
        if (g.x > 0 && (g.y == 1) != (s.extent == "RIM")) continue; // nobody's default for it
        if (g.x > 0) o << "    if (x == " << g.x << " && y == " << g.y << ")\n    ";
        o << "    return reinterpret_cast<const void*>(&run<E, " << g.x << ", " << g.y << ">);\n";
    }
    o << "}\n";
    if (marks(s)) o << cuda_active(s);
    o << "} // namespace " << space << "\nextern \"C\" const void* wadi_cuda_" << s.name
      << "(unsigned effects, int x, int y) {\n    switch (effects) {\n";
    for (const unsigned mask : chosen) o << "    case " << mask << "u: return " << space << "::select<" << mask << "u>(x, y);\n";
    o << "    default: return nullptr;\n    }\n}\nextern \"C\" const void* wadi_cuda_active_" << s.name
      << "([[maybe_unused]] unsigned effects) {\n";
    if (marks(s)) {
        o << "    switch (effects) {\n";
        for (const unsigned mask : chosen)
            o << "    case " << mask << "u: return reinterpret_cast<const void*>(&" << space << "::run_active<" << mask
              << "u>);\n";
        o << "    default: break;\n    }\n";
    }
    o << "    return nullptr;\n}\n";
    return o.str();
}

std::string write_cuda(const FusedStage& f, const Effects& effects, bool all_masks) {
    const Stage& s = f.stage;
    const auto legal = masks(tested_bits(s, effects), f.needs, f.without), chosen = all_masks ? legal : largest(legal);
    const std::string space = "wadi_stage_cuda_" + s.name;
    const auto windows = fields_kept(f, Keeping::window);
    // Groups on a multiprocessor, for which the compiler saves registers: these kernels wait for instructions, not for memory.
    // Before compute capability 8.0 it holds 1024 threads, 4 groups.
    const int groups = 4 * windows.size() * static_cast<std::size_t>(window_floats(f)) > 16384 ? 5 : 6;
    std::ostringstream o;
    o << "// Written by stagec from " << s.name << ".fused.\nnamespace " << space
      << " {\n#pragma nv_diag_suppress 177, 550\n#include \"language/stage_cuda.h\"\n" // places that nobody uses, as in
                                                                                       // write_cpp.cpp
      << physics_includes(f) << "struct Place { int x, y; };\n#define PLACE(X, Y) Place{X, Y}\n"
      << index_macros(f) << "#define LANE static_cast<int>(threadIdx.y * " << fused_group_x << " + threadIdx.x)\n#define LANES "
      << fused_group_x * fused_group_y
      << "\n#define BARRIER __syncthreads()\n#define ANY(X) __syncthreads_or(X)\n#define ROLLED _Pragma(\"unroll 1\")\n#define "
         "PART_FUNCTION __device__ "
         "__forceinline__\n#define NOT_KEPT(X) (void)(X)\n"
      << keep_stored << active_argument << "struct Slots { void* at[" << s.bindings.size() << "]; };\n"
      << "template <unsigned FREE, bool ACTIVE> struct " << s.struct_name << " {\n    static constexpr unsigned EFFECTS = FREE | "
      << f.needs << "u;\n    typedef Stored<EFFECTS> float_or_half;\n    const WorldParams& P;\n    const StepInput& S;\n";
    for (const auto& b : s.bindings)
        o << "    " << (b.access == "IN" ? "const " : "") << b.type << "* __restrict__ " << b.name << ";\n";
    for (const auto& name : windows) o << "    float* __restrict__ window_" << name << ";\n";
    for (const auto& name : fields_kept(f, Keeping::own_index)) o << "    float own_" << name << " = 0.0f;\n";
    o << "    int own_i0 = 0, own_j0 = 0, own_i1 = 0, own_j1 = 0, window_i0 = 0, window_j0 = 0;\n    bool owned = "
         "false, tile_looked_at = false, changed = false;\n"
      << "#define look (ACTIVE && tile_looked_at)\n"
      << part_functions(f, effects, "EFFECTS") << "__device__ __forceinline__ void window() {\n    PLACE_WINDOW;\n"
      << phase_loops(f, effects) << "}\n};\n"
      << "#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ < 800\n#define GROUPS 4\n#else\n#define GROUPS " << groups << "\n#endif\n"
      << "template <unsigned E, bool ACTIVE> __global__ void __launch_bounds__(" << fused_group_x * fused_group_y << ", (E & "
      << f.four_groups << "u) != 0 ? 4 : GROUPS)\n"
      << "run(const WorldParams P, const StepInput* __restrict__ input, const Slots b, const Active active) {\n"
      << "    __shared__ float windows[" << std::max<std::size_t>(1, windows.size()) << "][" << window_floats(f) << "];\n    "
      << s.struct_name << "<E, ACTIVE> stage{P, *input";
    for (const auto& b : s.bindings)
        o << ",\n        static_cast<" << (b.access == "IN" ? "const " : "") << element_type(b, "E") << "*>(b.at[" << b.slot
          << "])";
    for (std::size_t n = 0; n < windows.size(); ++n) o << ",\n        windows[" << n << "]";
    // The kernel for all cells has registers for nothing else.
    o << "};\n    constexpr bool all = !ACTIVE;\n"
      << "    const int across = (P.tile_size + FUSED_COLUMNS - 1) / FUSED_COLUMNS;\n"
      << "    const int parts = across * ((P.tile_size + FUSED_ROWS - 1) / FUSED_ROWS);\n"
      << "    const int count = all ? 1 : static_cast<int>(*active.count) * parts;\n"
      << "    for (int n = all ? 0 : static_cast<int>(blockIdx.x); n < count; n += static_cast<int>(gridDim.x)) {\n"
      << "        stage.own_i0 = static_cast<int>(blockIdx.x) * FUSED_COLUMNS;\n"
      << "        stage.own_j0 = static_cast<int>(blockIdx.y) * FUSED_ROWS;\n"
      << "        stage.own_i1 = stage.own_i0 + FUSED_COLUMNS;\n        stage.own_j1 = stage.own_j0 + FUSED_ROWS;\n"
      << "        volatile uint* activity = active.activity;\n        if (!all) {\n"
      << "        const int tile = static_cast<int>(active.list[n / parts]), part = n % parts;\n"
      << tile_part("stage.") << "        activity += tile;\n        stage.tile_looked_at = *activity != uint(input->step);\n"
      << "        stage.changed = false;\n        }\n        stage.window();\n"
      << "        if (!all && stage.changed) *activity = uint(input->step);\n        BARRIER;\n    }\n}\n#undef look\n} // "
         "namespace "
      << space << "\n";
    for (const bool active : {false, true}) {
        o << "extern \"C\" const void* wadi_cuda_" << (active ? "active_" : "") << s.name
          << (active ? "(unsigned effects)" : "(unsigned effects, int, int)") << " {\n    switch (effects) {\n";
        for (const unsigned mask : chosen)
            o << "    case " << mask << "u: return reinterpret_cast<const void*>(&" << space << "::run<" << mask << "u, "
              << (active ? "true" : "false") << ">);\n";
        o << "    default: return nullptr;\n    }\n}\n";
    }
    return o.str();
}

} // namespace stagec
