#include "tests/conformance/stage_inputs.hpp"
#include "tests/conformance/compare.hpp"
#include "tests/conformance/edits_check.hpp"
#include "tests/conformance/fields.hpp"
#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace wadi::conformance {

namespace {

using compute::Access;

const std::uint32_t nan_word = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN());

// Behind the flip of the water height the cells outside open sides hold depths of an older step.
constexpr std::array stages_with_stale_ghosts = {"integrate_water_velocity", "compute_saturation", "compute_momentum_exchange",
                                                 "integrate_sand_velocity", "apply_friction"};

bool contains(const compute::Range2& r, int i, int j) { return i >= r.i0 && i < r.i1 && j >= r.j0 && j < r.j1; }

// Calls f(i, j, word) for every cell of the layout that belongs to the field, ghosts included, padding excluded.
template <class F> void for_layout(const FieldLayout& layout, F f) {
    for (int j = -GHOST; j < layout.ny + 1 + GHOST; ++j)
        for (int i = -GHOST; i < layout.nx + 1 + GHOST; ++i) f(i, j, layout.index(i, j));
}

// Fields that a stage reads: state with its ghosts, scratch in its own range only.
void fill_input(BenchBuffer& buffer, const std::string& stage, const FieldName& name, const Pilot& pilot,
                const WorldParams& params) {
    const FieldLayout layout{params.nx, params.ny};
    auto values = reference_field(*pilot.narrow, stage, name, false);
    const bool state = is_state(name.base);
    if (state) fill_ghosts(values, name.base, *pilot.narrow);
    const bool stale = name.base == "water_height" && std::find(stages_with_stale_ghosts.begin(), stages_with_stale_ghosts.end(),
                                                                stage) != stages_with_stale_ghosts.end();
    const auto range = values_of(name.base, params);
    for_layout(layout, [&](int i, int j, std::size_t word) {
        const bool inside = contains(range, i, j);
        if (state || inside) buffer.before[word] = std::bit_cast<std::uint32_t>(values[word]);
        const bool outside_cell = contains({-1, -1, params.nx + 1, params.ny + 1}, i, j) && !inside;
        if (stale && outside_cell && pilot.narrow->has(EFFECT_OPEN_SIDES))
            buffer.before[word] = std::bit_cast<std::uint32_t>(7.0F);
    });
}

void fill_field(BenchBuffer& buffer, const std::string& stage, const compute::StageBinding& binding, const Scene& scene,
                const Pilot& pilot, const WorldParams& params) {
    const FieldLayout layout{params.nx, params.ny};
    const FieldName name = field_of(stage, std::string(binding.name), scene.effects);
    const bool out = binding.access == Access::out;
    buffer.before.assign(layout.size(), out ? std::bit_cast<std::uint32_t>(untouched_value()) : nan_word);
    buffer.may_change.assign(layout.size(), false);
    buffer.must_change.assign(layout.size(), false);
    // compute_water_flux reads the mixed flux only where diffusion has written it.
    const bool entry_unused =
        name.base.starts_with("mixed_flux") && (scene.effects & EFFECT_DIFFUSION) == 0 && binding.access == Access::inout;
    if (!out && !entry_unused) fill_input(buffer, stage, name, pilot, params);
    if (binding.access == Access::in) return;
    const auto range = written_range(stage, name.base, params);
    for_layout(layout, [&](int i, int j, std::size_t word) {
        if (!contains(range, i, j)) return;
        buffer.may_change[word] = true;
        if (out) buffer.before[word] = nan_word;
        buffer.must_change[word] = buffer.before[word] == nan_word;
    });
}

void fill_words(BenchBuffer& buffer, std::vector<std::uint32_t> words, bool may_change) {
    buffer.may_change.assign(words.size(), may_change);
    buffer.must_change.assign(words.size(), false);
    buffer.before = std::move(words);
}

std::vector<std::uint32_t> ledger_words(std::size_t count) {
    std::vector<std::uint32_t> words(count);
    for (std::size_t n = 0; n < count; ++n) words[n] = ledger_start(n);
    return words;
}

} // namespace

std::uint32_t ledger_start(std::size_t word) { return 0xFFFFFF00u + static_cast<std::uint32_t>(word * 37 % 251); }

compute::Range2 written_range(const std::string& stage, const std::string& base, const WorldParams& params) {
    if (stage == "open_sides" && base == "water_height") return {-1, -1, params.nx + 1, params.ny + 1};
    if (stage == "apply_edits" && base == "terrain") return {-GHOST, -GHOST, params.nx + 1 + GHOST, params.ny + 1 + GHOST};
    return values_of(base, params);
}

std::vector<BenchBuffer> stage_buffers(const compute::StageInfo& stage, const Scene& scene, const Pilot& pilot,
                                       const WorldParams& params) {
    std::vector<BenchBuffer> buffers(stage.bindings.size());
    const FieldLayout layout{params.nx, params.ny};
    for (std::size_t b = 0; b < buffers.size(); ++b) {
        const auto& binding = stage.bindings[b];
        buffers[b].exists = (scene.effects & binding.condition) == binding.condition;
        if (!buffers[b].exists) continue;
        if (binding.name == "source_shapes") {
            std::vector<std::uint32_t> words;
            for (const vec4& shape : source_shapes(scene.settings))
                for (const float x : {shape.x, shape.y, shape.z, shape.w}) words.push_back(std::bit_cast<std::uint32_t>(x));
            fill_words(buffers[b], std::move(words), false);
        } else if (binding.name == "stamp_images") {
            std::vector<std::uint32_t> words(STAMP_PAGE, nan_word);
            std::size_t at = 0;
            for (const float value : stamp_of_cases().values) words[at++] = std::bit_cast<std::uint32_t>(value);
            fill_words(buffers[b], std::move(words), false);
        } else if (binding.name == "source_ledger") {
            fill_words(buffers[b],
                       ledger_words(std::size_t{2 * LEDGER_ENTRIES} * static_cast<std::size_t>(layout.strips() * layout.pitch())),
                       true);
        } else if (binding.name == "side_ledger") {
            fill_words(buffers[b], ledger_words(4 * static_cast<std::size_t>(layout.rim())), true);
        } else {
            fill_field(buffers[b], std::string(stage.name), binding, scene, pilot, params);
        }
    }
    return buffers;
}

} // namespace wadi::conformance
