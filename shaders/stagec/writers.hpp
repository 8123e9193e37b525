// What stagec writes.
#pragma once
#include "fused_file.hpp"
#include "stage_file.hpp"

namespace stagec {

// Pieces of kernels that GLSL and CUDA share (kernel_text.cpp).
/// The index range of an extent as guards; must agree with extent_range() in engine/compute.
std::string guard(const std::string& extent);
/// How long the list of an extent without a grid is; empty for others.
std::string length(const std::string& extent);
/// Stages that run over a list of active tiles, and stages of the rim, which run whole but tell what they changed.
bool marks(const Stage& stage);
/// Runs the kernel and, where `look`, notes in `changed` whether a bit of what it writes is another than before.
std::string marking(const Stage& stage, const std::string& member);
/// Stamps the tile with the step. Once a tile has its stamp nobody looks any more. Threads of one tile store the same value, so
/// that their order does not matter.
inline constexpr const char* marked = "    if (changed) activity[tile] = uint(S.step);\n";
/// The place of a rim kernel: its face, the cell outside it where that is written, the tile that holds the face.
std::string rim_place(const Stage& stage);
/// KEEP_STORED of a fused stage: stores, and notes whether that changed a bit where somebody looks; there, what is the same stays
/// as it is. A store never follows a load from its own place which is still under way: that holds up a multiprocessor's whole
/// memory (an H100: three times the time).
inline constexpr const char* keep_stored =
    "#define KEEP_STORED(FIELD, AT) { bool same = false; if (look && !changed) { same = float_bits(FIELD[AT]) == "
    "float_bits(stored); changed = !same; } if (!same) FIELD[AT] = stored; }\n";
/// Copies, looks and stores of fused stages where a thread takes one element at a time.
inline constexpr const char* one_by_one =
    "#define WIDE 1\n#define COPY(TO, T, FROM, F) TO[T] = FROM[F]\n#define ZERO(TO, T) TO[T] = 0.0f\n#define COPIED\n"
    "#define HOLDS(FIELD, AT) FIELD[AT] != 0.0f\n#define LOAD(FIELD, AT) FIELD[AT]\n"
    "#define KEEP_ZEROS(FIELD, AT) { float stored = 0.0f; KEEP_STORED(FIELD, AT) }\n"
    "#define KEEP_COPY(FIELD, AT, FROM) { float stored = FROM[AT]; KEEP_STORED(FIELD, AT) }\n";
/// SHARED_PITCH and SHARED_BESIDE, and nearest_index: the one in 0 ... last that is nearest.
std::string shared_macros();
/// Where group `part` of an active tile begins and ends: own_i0 ... own_j1, members of `member`. `skip` leaves out a group that
/// lies beyond the grid, as the last ones of a tile at the rim may: what it read would lie behind the end of fields.
std::string tile_part(const std::string& member, const std::string& skip);

std::string write_glsl(const Stage& stage);
std::string write_glsl(const FusedStage& fused, const Effects& effects);
/// An instruction set of the CPU, and the one whose functions run the masks that it lacks ("": none, it has all).
struct CpuSet {
    std::string isa, below;
    std::string masks; // all, common or largest
};
std::string write_cpp(const Stage& stage, const CpuSet& set, const Effects& effects);
std::string write_cpp(const FusedStage& fused, const CpuSet& set, const Effects& effects);
std::string write_cuda(const Stage& stage, const Effects& effects, bool all_masks);
std::string write_cuda(const FusedStage& fused, const Effects& effects, bool all_masks);

/// Decorates every float operation of a module NoContraction and has its entry points ask for SignedZeroInfNanPreserve.
void write_strict(const std::string& in, const std::string& out);
/// The words of a module as the inside of a C++ array.
std::string word_list(const std::string& module);

bool is_fused(const std::string& path);
/// The stage table that the engine reads; stages and fused stages by their paths.
std::string stage_table(const std::vector<std::string>& paths, const Effects& effects, const std::string& spirv_dir);
std::string cpu_rows(const std::string& isas, bool fused, const std::vector<std::string>& paths);
std::string cuda_rows(const std::vector<std::string>& stages);

} // namespace stagec
