// stagec: the build's own tool for stage files and fused files. It has no dependencies and is built first.
//   stagec glsl  EFFECTS_H STAGE OUT.comp          GLSL wrapper: prelude, stage, main()
//   stagec cpp   EFFECTS_H STAGE OUT.cpp ISA all|common|largest [BELOW]  a function per mask the stage distinguishes, for one
//                                                  instruction set; largest: of each choice of methods the masks that no other
//                                                  one includes; common: those and all of the default method; BELOW: the set
//                                                  whose functions run the masks that are left out
//   stagec cuda  EFFECTS_H STAGE OUT.cu all|largest  every mask as CUDA kernels; largest: masks that no other one includes
//   stagec strict IN.spv OUT.spv                   decorates every float operation NoContraction and turns off what else drivers
//                                                  call fast math
//   stagec embed IN.spv OUT.inc                    a module as the words of a C++ array
//   stagec table EFFECTS_H OUT.cpp SPIRV_DIR|- STAGES...   the stage table that the engine reads
//   stagec cpurows OUT.cpp ISAS fused|- STAGES...  the CPU backend's index of the compiled stages, with or without fused ones
//   stagec cudarows OUT.cpp STAGES...              the CUDA backend's index of the compiled kernels
#include "writers.hpp"

using namespace stagec;

int main(int argc, char** argv) {
    const std::vector<std::string> a(argv + 1, argv + argc);
    const std::string mode = a.empty() ? "" : a[0];
    if (mode == "glsl" && a.size() == 4) {
        const Effects effects = parse_effects(a[1]);
        write_code(a[3], is_fused(a[2]) ? write_glsl(parse_fused(a[2], effects), effects) : write_glsl(parse_stage(a[2])));
    } else if (mode == "cpp" && (a.size() == 6 || a.size() == 7) && (a[5] == "all" || a[5] == "common" || a[5] == "largest")) {
        const Effects effects = parse_effects(a[1]);
        const CpuSet set{a[4], a.size() == 7 ? a[6] : "", a[5]};
        write_code(a[3], is_fused(a[2]) ? write_cpp(parse_fused(a[2], effects), set, effects)
                                        : write_cpp(parse_stage(a[2]), set, effects));
    } else if (mode == "cuda" && a.size() == 5 && (a[4] == "all" || a[4] == "largest")) {
        const Effects effects = parse_effects(a[1]);
        const bool all = a[4] == "all";
        write_code(a[3], is_fused(a[2]) ? write_cuda(parse_fused(a[2], effects), effects, all)
                                        : write_cuda(parse_stage(a[2]), effects, all));
    } else if (mode == "strict" && a.size() == 3) {
        write_strict(a[1], a[2]);
    } else if (mode == "embed" && a.size() == 3) {
        write_code(a[2], "// Written by stagec." + word_list(a[1]) + "\n");
    } else if (mode == "table" && a.size() >= 5) {
        write_code(a[2], stage_table({a.begin() + 4, a.end()}, parse_effects(a[1]), a[3]));
    } else if (mode == "cpurows" && a.size() >= 5) {
        write_code(a[1], cpu_rows(a[2], a[3] == "fused", {a.begin() + 4, a.end()}));
    } else if (mode == "cudarows" && a.size() >= 3) {
        std::vector<std::string> names;
        for (std::size_t i = 2; i < a.size(); ++i) names.push_back(stem(a[i]));
        write_code(a[1], cuda_rows(names));
    } else {
        fail("usage: glsl|cpp|cuda|strict|embed|table|cpurows|cudarows ... (see the top of stagec.cpp)");
    }
    return 0;
}
