// Comparison of a device's field with the reference, by a tolerance that is computed and not chosen; guards round buffers.
#pragma once
#include "shaders/stage_table.hpp"
#include "tests/conformance/case.hpp"
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace wadi::conformance {

/// One field of a comparison, all in Wadi's layout.
struct FieldCheck {
    std::string name;
    compute::Range2 range{}; // where it has values
    std::span<const float> got;
    std::span<const float> narrow;     // reference<float>
    std::span<const double> wide;      // reference<double>
    std::span<const double> unrounded; // reference<double> with the quantum off; empty = not needed
};

/// ARCHITECTURE 7: passes where max|got - wide| <= 8 max|narrow - wide| + 16 eps S, S = max|wide| over the fields given (the
/// components of one vector). Truncating volumes to whole quanta turns a difference of one rounding into one quantum: a stage
/// that truncates is allowed `quanta` more; after whole steps the allowance grows by what all truncations together did to the
/// field, max|wide - unrounded|. Fails as well where the references differ so much (another branch taken) that the case would
/// prove nothing.
Verdict compare_fields(const std::vector<FieldCheck>& components, const FieldLayout& layout, double quanta);

/// Fields with values equal to the bit; the detail names the first cell that is not.
Verdict compare_bits(const std::string& name, std::span<const float> got, std::span<const float> expected,
                     const FieldLayout& layout, compute::Range2 range);

/// All cells of a field, ghosts included.
compute::Range2 whole_layout(const FieldLayout& layout);

/// The worse of two; their errors and allowances stay with the worse (or, both passing, the one nearer its allowance).
Verdict worse(const Verdict& a, const Verdict& b);

constexpr std::size_t guard_bytes = 4096;
/// Byte n of every guard: what no stage can write by chance.
std::byte guard_byte(std::size_t n);
/// A float that stands in padding, ghosts of outputs and other places that no stage may write.
float untouched_value();

} // namespace wadi::conformance
