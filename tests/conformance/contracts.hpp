// Suite 1: every call of engine/compute/device.hpp, with good and with bad arguments.
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
std::span<const Contract> refusal_contracts();
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

/// Buffers of a rain dispatch: fields of zeros and a ledger.
struct Rain {
    explicit Rain(compute::Device& d) : device(d) {
        const FieldLayout layout{small_params().nx, small_params().ny};
        terrain = buffer_of(device, std::vector<std::uint32_t>(layout.size(), 0));
        water = buffer_of(device, std::vector<std::uint32_t>(layout.size(), 0));
        ledger = buffer_of(device,
                           std::vector<std::uint32_t>(
                               std::size_t{2 * LEDGER_ENTRIES} * static_cast<std::size_t>(layout.strips() * layout.pitch()), 0));
    }
    ~Rain() {
        for (const compute::Buffer buffer : {terrain, water, ledger}) device.destroy_buffer(buffer);
    }
    Rain(const Rain&) = delete;
    Rain& operator=(const Rain&) = delete;
    float depth() { // of the cell (2, 3)
        float value = -1;
        const FieldLayout layout{small_params().nx, small_params().ny};
        return device.read(water, layout.index(2, 3) * 4, std::as_writable_bytes(std::span(&value, 1))) ? value : -1;
    }
    compute::Device& device;
    compute::Buffer terrain, water, ledger;
};

} // namespace wadi::conformance
