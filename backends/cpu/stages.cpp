#include "backends/cpu/stages.hpp"
#include "backends/cpu/processor.hpp"
#include <cstdio>
#include <cstdlib>

// An index out of range is our own bug: say where and stop, so that a debugger shows the stage.
#define WADI_INDEX_ERROR(ISA)                                                                                                    \
    namespace wadi_stage_##ISA {                                                                                                 \
        [[noreturn]] void stage_index_error(const char* stage, const char* buffer, long index, unsigned long long size);         \
        void stage_index_error(const char* stage, const char* buffer, long index, unsigned long long size) {                     \
            std::fprintf(stderr, "wadi: stage %s reads or writes %s[%ld], which has %llu elements\n", stage, buffer, index,      \
                         size);                                                                                                  \
            std::abort();                                                                                                        \
        }                                                                                                                        \
    }
WADI_INDEX_ERROR(base)
WADI_INDEX_ERROR(avx2)
WADI_INDEX_ERROR(avx512)

namespace wadi::cpu {

const InstructionSet* choose_instruction_set(std::string_view wanted) {
    const InstructionSet* best = nullptr;
    for (const auto& set : instruction_sets()) {
        if (has_instructions(set.name) && (wanted.empty() || wanted == set.name)) best = &set;
    }
    return best;
}

} // namespace wadi::cpu
