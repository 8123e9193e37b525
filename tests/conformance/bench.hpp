// One stage alone on a device: buffers with guards, outputs full of NaN, one dispatch, and what came back.
#pragma once
#include "engine/compute/device.hpp"
#include "tests/conformance/case.hpp"
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace wadi::conformance {

/// One binding's buffer as the host prepares it and as the device left it; 4 KiB of guard bytes follow the values. Buffers are
/// bound whole, so the guard ahead of a field's cells is its own ghost rows.
struct BenchBuffer {
    bool exists = false;               // false: the mask lacks the binding
    std::vector<std::uint32_t> before; // values as words, without the guard
    std::vector<bool> may_change;      // words that the stage may write
    std::vector<bool> must_change;     // words that held NaN and must hold a number afterwards
    std::vector<std::byte> after;      // values and guard, as read back

    std::span<const float> floats() const;
    std::span<const std::uint32_t> words() const;
};

/// Runs the stage over its extent on buffers made for this call. Errors: those of the device.
Status run_bench(compute::Device& device, int stage, std::uint32_t effects, const WorldParams& params, const StepInput& input,
                 compute::GroupSize group, std::vector<BenchBuffer>& buffers);

/// Fails where a word outside may_change or a guard byte changed, or where NaN is left in a cell that the stage must write.
Verdict check_guards(const compute::StageInfo& stage, const std::vector<BenchBuffer>& buffers, const FieldLayout& layout);

} // namespace wadi::conformance
