#include "backends/cpu/stages.hpp"
#include <cstdio>
#include <cstdlib>

// An index out of range is our own bug: say where and stop, so that a debugger shows the stage.
#define WADI_INDEX_ERROR(ISA)                                                                                                    \
    namespace wadi_stage_##ISA {                                                                                                 \
        [[noreturn]] void stage_index_error(const char* stage, const char* buffer, long index, unsigned long size);              \
        void stage_index_error(const char* stage, const char* buffer, long index, unsigned long size) {                          \
            std::fprintf(stderr, "wadi: stage %s reads or writes %s[%ld], which has %lu elements\n", stage, buffer, index,       \
                         size);                                                                                                  \
            std::abort();                                                                                                        \
        }                                                                                                                        \
    }
WADI_INDEX_ERROR(base)
WADI_INDEX_ERROR(avx2)
WADI_INDEX_ERROR(avx512)

namespace wadi::cpu {

namespace {
bool runs(std::string_view name) {
#if defined(__x86_64__)
    if (name == "avx2") return __builtin_cpu_supports("avx2") != 0;
    if (name == "avx512")
        return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
               __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512dq") != 0;
#endif
    return name == "base";
}
} // namespace

const InstructionSet* choose_instruction_set(std::string_view wanted) {
    const InstructionSet* best = nullptr;
    for (const auto& set : instruction_sets()) {
        if (runs(set.name) && (wanted.empty() || wanted == set.name)) best = &set;
    }
    return best;
}

} // namespace wadi::cpu
