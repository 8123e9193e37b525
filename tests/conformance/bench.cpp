#include "tests/conformance/bench.hpp"
#include "engine/step/plan/half.hpp"
#include "tests/conformance/compare.hpp"
#include <bit>
#include <cmath>
#include <cstring>

namespace wadi::conformance {

namespace {

std::string word_place(std::size_t word, const FieldLayout& layout) {
    const auto pitch = static_cast<std::size_t>(layout.pitch());
    const std::size_t at = word + GHOST - LEAD; // from the first ghost of row -GHOST
    const int i = static_cast<int>(at % pitch) - GHOST, j = static_cast<int>(at / pitch) - GHOST;
    return "word " + std::to_string(word) + ", in a field cell (" + std::to_string(i) + ", " + std::to_string(j) + ")";
}

Status dispatch(compute::Device& device, int stage, std::uint32_t effects, const WorldParams& params, const StepInput& input,
                compute::GroupSize group, std::vector<compute::Buffer> slots) {
    const auto& info = compute::stage_table()[static_cast<std::size_t>(stage)];
    auto pipeline = device.create_pipeline(stage, effects, group);
    if (!pipeline) return pipeline.status();
    compute::ProgramBuilder builder("bench " + std::string(info.name));
    builder.dispatch({*pipeline, stage, effects, std::move(slots), compute::extent_range(info.extent, params, input.point_count),
                      std::string(info.name)});
    auto program = device.compile(builder, params);
    if (!program) return program.status();
    auto ticket = device.submit(*program, input);
    Status status = ticket ? device.wait(*ticket) : ticket.status();
    device.destroy_program(*program);
    return status;
}

bool is_half(const compute::StageBinding& binding, std::uint32_t effects) {
    return binding.type == compute::Scalar::f32_or_f16 && (effects & EFFECT_HALF_STORAGE) != 0;
}

Status upload(compute::Device& device, const BenchBuffer& from, bool half, compute::Buffer to) {
    const std::size_t size = from.before.size() * (half ? 2 : 4);
    std::vector<std::byte> bytes(size + guard_bytes);
    if (half) {
        for (std::size_t n = 0; n < from.before.size(); ++n) {
            const std::uint16_t bits = to_half(std::bit_cast<float>(from.before[n]));
            std::memcpy(bytes.data() + 2 * n, &bits, 2);
        }
    } else {
        std::memcpy(bytes.data(), from.before.data(), size);
    }
    for (std::size_t n = 0; n < guard_bytes; ++n) bytes[size + n] = guard_byte(n);
    return device.write(to, 0, bytes);
}

// What the device holds, as floats and behind them the guard.
Status download(compute::Device& device, compute::Buffer from, bool half, BenchBuffer& to) {
    const std::size_t count = to.before.size();
    to.after.resize(count * 4 + guard_bytes);
    if (!half) return device.read(from, 0, to.after);
    std::vector<std::byte> bytes(count * 2 + guard_bytes);
    if (auto status = device.read(from, 0, bytes); !status) return status;
    for (std::size_t n = 0; n < count; ++n) {
        std::uint16_t bits = 0;
        std::memcpy(&bits, bytes.data() + 2 * n, 2);
        const float value = from_half(bits);
        std::memcpy(to.after.data() + 4 * n, &value, 4);
    }
    std::memcpy(to.after.data() + 4 * count, bytes.data() + 2 * count, guard_bytes);
    return ok_status();
}

} // namespace

std::span<const float> BenchBuffer::floats() const { return {reinterpret_cast<const float*>(after.data()), before.size()}; }
std::span<const std::uint32_t> BenchBuffer::words() const {
    return {reinterpret_cast<const std::uint32_t*>(after.data()), before.size()};
}

Status run_bench(compute::Device& device, int stage, std::uint32_t effects, const WorldParams& params, const StepInput& input,
                 compute::GroupSize group, std::vector<BenchBuffer>& buffers) {
    const auto& info = compute::stage_table()[static_cast<std::size_t>(stage)];
    std::vector<compute::Buffer> slots(buffers.size());
    Status status;
    for (std::size_t b = 0; b < buffers.size() && status; ++b) {
        if (!buffers[b].exists) continue;
        const std::string label = std::string(info.name) + "." + std::string(info.bindings[b].name);
        const bool half = is_half(info.bindings[b], effects);
        auto made = device.create_buffer({buffers[b].before.size() * (half ? 2 : 4) + guard_bytes, label});
        if (made) slots[b] = *made;
        status = made ? upload(device, buffers[b], half, *made) : made.status();
    }
    if (status) status = dispatch(device, stage, effects, params, input, group, slots);
    for (std::size_t b = 0; b < buffers.size() && status; ++b) {
        if (!buffers[b].exists) continue;
        status = download(device, slots[b], is_half(info.bindings[b], effects), buffers[b]);
    }
    for (const compute::Buffer buffer : slots) device.destroy_buffer(buffer);
    return status;
}

void round_to_half(std::vector<std::uint32_t>& words) {
    for (auto& word : words) word = std::bit_cast<std::uint32_t>(from_half(to_half(std::bit_cast<float>(word))));
}

Verdict check_guards(const compute::StageInfo& stage, const std::vector<BenchBuffer>& buffers, const FieldLayout& layout) {
    for (std::size_t b = 0; b < buffers.size(); ++b) {
        const BenchBuffer& buffer = buffers[b];
        if (!buffer.exists) continue;
        const std::string name(stage.bindings[b].name);
        for (std::size_t n = 0; n < guard_bytes; ++n) {
            if (buffer.after[buffer.before.size() * 4 + n] != guard_byte(n))
                return failed(name + ": guard byte " + std::to_string(n) + " behind the buffer was overwritten");
        }
        const auto after = buffer.words();
        const auto values = buffer.floats();
        for (std::size_t w = 0; w < after.size(); ++w) {
            if (!buffer.may_change[w] && after[w] != buffer.before[w])
                return failed(name + ": " + word_place(w, layout) + " was written, where the stage has nothing to write");
            if (buffer.must_change[w] && std::isnan(values[w]))
                return failed(name + ": " + word_place(w, layout) +
                              " holds NaN: not written, or computed from what must not be read");
        }
    }
    return {};
}

} // namespace wadi::conformance
