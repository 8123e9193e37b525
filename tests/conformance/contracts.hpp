// Layer 1: every call of engine/compute/device.hpp, with good and with bad arguments.
#pragma once
#include "tests/conformance/expect.hpp"
#include "tests/conformance/target.hpp"
#include <span>
#include <vector>

namespace wadi::conformance {

struct Contract {
    const char* name;
    void (*check)(Session& session, compute::Device& device, Expect& expect);
};

std::span<const Contract> buffer_contracts();
std::span<const Contract> program_contracts();
std::span<const Contract> device_contracts();
std::span<const Contract> host_contracts();

/// What most bad calls must answer, for Expect::code.
constexpr auto bad = {Code::bad_argument};

/// A buffer that holds `words`; null when the device refuses.
compute::Buffer buffer_of(compute::Device& device, const std::vector<std::uint32_t>& words);
std::vector<std::uint32_t> words_of(compute::Device& device, compute::Buffer buffer, std::size_t count);
/// Compiles, submits once, waits and destroys.
Status run_once(compute::Device& device, const compute::ProgramBuilder& builder);
/// Parameters of a 33 x 17 grid with a quantum.
WorldParams small_params();
/// apply_rain under EFFECT_WATER over `water` and `terrain` (fields) and `ledger`.
Result<compute::Dispatch> rain_dispatch(compute::Device& device, compute::Buffer terrain, compute::Buffer water,
                                        compute::Buffer ledger);

} // namespace wadi::conformance
