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
        o << ",\n        static_cast<" << (b.access == "IN" ? "const " : "") << b.type << "*>(b.at[" << b.slot << "])";
    const std::string look = "    const bool look = activity[tile] != uint(S.step);\n    bool changed = false;\n";
    o << "};\n    volatile uint* const activity = tiles.activity;\n";
    if (s.extent == "RIM") {
        o << "    const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);\n    const int j = 0;\n    if (!("
          << guard(s.extent) << ")) return;\n"
          << rim_place(s) << look << marking(s, "stage.") << marked << "}\n";
        return o.str();
    }
    o << "    const uint count = *tiles.count;\n"
      << "    for (uint n = blockIdx.x; n < count; n += gridDim.x) {\n    const int tile = static_cast<int>(tiles.list[n]);\n"
      << look // ahead of the rows, so that none of them waits for it
      << "    const int i = (tile % P.tile_columns) * P.tile_size + static_cast<int>(threadIdx.x);\n"
      << "    for (int row = static_cast<int>(threadIdx.y); row < P.tile_size; row += static_cast<int>(blockDim.y)) {\n"
      << "    const int j = (tile / P.tile_columns) * P.tile_size + row;\n    if (!(" << guard(s.extent)
      << ")) continue;\n    const int at = IDX(i, j);\n"
      << marking(s, "stage.") << "    }\n"
      << marked << "    }\n}\n";
    return o.str();
}

// Rows of a group begin at multiples of four elements, in memory as in shared rows. Copies to shared memory are asynchronous
// where the device has that. Buffers that are read are never written by the same pass: they may come through the read-only cache.
const char* const four_at_once = R"(#define WIDE 4
__device__ __forceinline__ void copy(float* to, const float* from) {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
    asm volatile("cp.async.cg.shared.global [%0], [%1], 16;" :: "r"(static_cast<unsigned>(__cvta_generic_to_shared(to))), "l"(from) : "memory");
#else
    *reinterpret_cast<float4*>(to) = __ldg(reinterpret_cast<const float4*>(from));
#endif
}
__device__ __forceinline__ bool holds(const float* from) {
    const float4 v = __ldg(reinterpret_cast<const float4*>(from));
    return v.x != 0.0f || v.y != 0.0f || v.z != 0.0f || v.w != 0.0f;
}
// Whether a bit changed, where `look` asks.
__device__ __forceinline__ bool keep(float* to, float4 value, bool look) {
    float4* const place = reinterpret_cast<float4*>(to);
    bool changed = false;
    if (look) {
        const float4 old = *place;
        changed = float_bits(old.x) != float_bits(value.x) || float_bits(old.y) != float_bits(value.y) ||
                  float_bits(old.z) != float_bits(value.z) || float_bits(old.w) != float_bits(value.w);
    }
    if (!look || changed) *place = value; // waits for what it looked at
    return changed;
}
#define LOAD(FIELD, AT) __ldg(FIELD + (AT))
#define COPY(TO, T, FROM, F) copy(TO + (T), FROM + (F))
#define ZERO(TO, T) *reinterpret_cast<float4*>(TO + (T)) = make_float4(0.0f, 0.0f, 0.0f, 0.0f)
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
#define COPIED asm volatile("cp.async.wait_all;" ::: "memory")
#else
#define COPIED
#endif
#define HOLDS(FIELD, AT) holds(FIELD + (AT))
#define KEEP_ZEROS(FIELD, AT) changed = keep(FIELD + (AT), make_float4(0.0f, 0.0f, 0.0f, 0.0f), look) || changed
#define KEEP_COPY(FIELD, AT, FROM) changed = keep(FIELD + (AT), __ldg(reinterpret_cast<const float4*>(FROM + (AT))), look) || changed
)";

// Arrays in shared memory and their floats.
std::vector<std::pair<std::string, int>> shared_rows(const FusedStage& f) {
    std::vector<std::pair<std::string, int>> all;
    for (const auto& rows : windows(f)) all.emplace_back("window_" + rows.field, rows.rows() * shared_pitch);
    for (const auto& rows : staged(f)) all.emplace_back("staged_" + rows.field, rows.rows() * shared_pitch);
    return all;
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
        o << ",\n        static_cast<" << (b.access == "IN" ? "const " : "") << b.type << "*>(b.at[" << b.slot << "])";
    o << "};\n    const int i = static_cast<int>(blockIdx.x * (X > 0 ? X : blockDim.x) + threadIdx.x);\n"
      << "    const int j = static_cast<int>(blockIdx.y * (Y > 0 ? Y : blockDim.y) + threadIdx.y);\n"
      << "    if (" << guard(s.extent) << ") stage.kernel(i, j);\n}\n"
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
    const std::size_t bytes = shared_bytes(f);
    std::ostringstream o;
    o << "// Written by stagec from " << s.name << ".fused.\nnamespace " << space
      << " {\n#pragma nv_diag_suppress 177, 550\n#include \"language/stage_cuda.h\"\n" // places that nobody uses, as in
                                                                                       // write_cpp.cpp
      << physics_includes(f) << "struct Place { int x, y; };\n#define PLACE(X, Y) Place{X, Y}\n"
      << index_macros << shared_macros() << four_at_once << "#define LANE static_cast<int>(threadIdx.y * " << fused_group_x
      << " + threadIdx.x)\n#define LANES " << fused_group_x * fused_group_y
      << "\n#define BARRIER __syncthreads()\n#define ANY(X) __syncthreads_or(X)\n#define ROLLED _Pragma(\"unroll 1\")\n#define "
         "APART(X) asm(\"\" : \"+r\"(X))\n#define "
         "PART_FUNCTION __device__ "
         "__forceinline__\n#define NOT_KEPT(X) (void)(X)\n"
      << keep_stored << active_argument << "struct Slots { void* at[" << s.bindings.size() << "]; };\n"
      << "template <unsigned FREE, bool ACTIVE> struct " << s.struct_name << " {\n    static constexpr unsigned EFFECTS = FREE | "
      << f.needs << "u;\n    const WorldParams& P;\n    const StepInput& S;\n";
    for (const auto& b : s.bindings)
        o << "    " << (b.access == "IN" ? "const " : "") << b.type << "* __restrict__ " << b.name << ";\n";
    const auto shared = shared_rows(f);
    for (const auto& [name, floats] : shared) o << "    float* __restrict__ " << name << ";\n";
    o << own_variables(f) << "bool tile_looked_at = false;\n"
      << "#define look (ACTIVE && tile_looked_at)\n"
      << part_functions(f, effects, "EFFECTS") << "__device__ __forceinline__ void window() {\n"
      << phase_loops(f, effects) << "}\n};\n"
      << "#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ < 800 // a multiprocessor holds 1024 threads\n#define GROUPS "
      << std::min(4, f.groups) << "\n#else\n#define GROUPS " << f.groups << "\n#endif\n"
      << "template <unsigned E, bool ACTIVE> __global__ void __launch_bounds__(" << fused_group_x * fused_group_y << ", GROUPS)\n"
      << "run(const WorldParams P, const StepInput* __restrict__ input, const Slots b, const Active active) {\n"
      << "    __shared__ __align__(16) float shared[" << std::max<std::size_t>(4, bytes / sizeof(float)) << "];\n    "
      << s.struct_name << "<E, ACTIVE> stage{P, *input";
    for (const auto& b : s.bindings)
        o << ",\n        static_cast<" << (b.access == "IN" ? "const " : "") << b.type << "*>(b.at[" << b.slot << "])";
    int at = 0;
    for (const auto& [name, floats] : shared) {
        o << ",\n        shared + " << at;
        at += floats;
    }
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
      << tile_part("stage.", "continue")
      << "        activity += tile;\n        stage.tile_looked_at = *activity != uint(input->step);\n"
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
