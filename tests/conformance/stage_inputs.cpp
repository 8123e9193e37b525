#include "tests/conformance/stage_inputs.hpp"
#include "engine/step/plan/source_shapes.hpp"
#include "shaders/physics/limit_marks.glsl"
#include "tests/conformance/active_tiles_check.hpp"
#include "tests/conformance/compare.hpp"
#include "tests/conformance/edits_check.hpp"
#include "tests/conformance/fields.hpp"
#include "tests/conformance/stage_checks.hpp"
#include "tests/conformance/values_check.hpp"
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace wadi::conformance {

namespace {

using compute::Access;

const std::uint32_t nan_word = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN());

// Behind the flip of the water height the cells outside open sides hold depths of an older step.
constexpr std::array stages_with_stale_ghosts = {"center_water_velocity",
                                                 "integrate_water_velocity",
                                                 "compute_saturation",
                                                 "compute_momentum_exchange",
                                                 "integrate_sand_velocity",
                                                 "apply_friction",
                                                 "measure_layer_exchange",
                                                 "give_layer_exchange",
                                                 "push_water",
                                                 "push_sand",
                                                 "yield_right_stretch",
                                                 "apply_sand_stress",
                                                 "apply_frictional_force"};

std::size_t components_of(compute::Scalar type) {
    return type == compute::Scalar::vec4 ? 4 : type == compute::Scalar::vec2 || type == compute::Scalar::uvec2 ? 2 : 1;
}

bool contains(const compute::Range2& r, int i, int j) { return i >= r.i0 && i < r.i1 && j >= r.j0 && j < r.j1; }

// Calls f(i, j, word) for every cell of the layout that belongs to the field, ghosts included, padding excluded.
template <class F> void for_layout(const FieldLayout& layout, F f) {
    for (int j = -GHOST; j < layout.ny + 1 + GHOST; ++j)
        for (int i = -GHOST; i < layout.nx + 1 + GHOST; ++i) f(i, j, layout.index(i, j));
}

// Fields that a stage reads: state with its ghosts, scratch in its own range only; but ghosts that nothing ever writes are 0 in
// any world, and carried velocities may be read there.
void fill_input(BenchBuffer& buffer, const std::string& stage, const FieldName& name, const Pilot& pilot,
                const WorldParams& params) {
    const FieldLayout layout{params.nx, params.ny};
    auto values = reference_field(*pilot.narrow, stage, name, false);
    const bool state = is_state(name.base), zero_ghosts = name.base.starts_with("centered_water_velocity");
    if (state) fill_ghosts(values, name.base, *pilot.narrow);
    const bool stale = name.base == "water_height" && std::find(stages_with_stale_ghosts.begin(), stages_with_stale_ghosts.end(),
                                                                stage) != stages_with_stale_ghosts.end();
    const auto range = values_of(name.base, params);
    for_layout(layout, [&](int i, int j, std::size_t word) {
        const bool inside = contains(range, i, j);
        if (state || zero_ghosts || inside) buffer.before[word] = std::bit_cast<std::uint32_t>(values[word]);
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
    const std::size_t components = components_of(binding.type);
    buffer.before.assign(components * layout.size(), out ? std::bit_cast<std::uint32_t>(untouched_value()) : nan_word);
    buffer.may_change.assign(components * layout.size(), false);
    buffer.must_change.assign(components * layout.size(), false);
    // compute_water_flux reads the mixed flux only where diffusion has written it.
    const bool entry_unused =
        name.base.starts_with("mixed_flux") && (scene.effects & EFFECT_DIFFUSION) == 0 && binding.access == Access::inout;
    if (!out && !entry_unused) fill_input(buffer, stage, name, pilot, params);
    if (binding.access == Access::in) return;
    const auto range = written_range(stage, name.base, params);
    for_layout(layout, [&](int i, int j, std::size_t word) {
        if (!contains(range, i, j)) return;
        for (std::size_t at = word * components; at < (word + 1) * components; ++at) {
            buffer.may_change[at] = true;
            if (out) buffer.before[at] = nan_word;
            buffer.must_change[at] = buffer.before[at] == nan_word;
        }
    });
}

void fill_words(BenchBuffer& buffer, std::vector<std::uint32_t> words, bool may_change) {
    buffer.may_change.assign(words.size(), may_change);
    buffer.must_change.assign(words.size(), false);
    buffer.before = std::move(words);
}

// What measure_strips and fold_tiles read and write, which is no field; false for any other binding.
bool fill_tiles(BenchBuffer& buffer, const compute::StageBinding& binding, const FieldLayout& layout) {
    const bool strips = binding.name.starts_with("strip_");
    if (!strips && !binding.name.starts_with("tile_")) return false;
    if (binding.access == Access::in) {
        fill_words(buffer, binding.name == "strip_range" ? strip_ranges(layout) : strip_changes(layout), false);
        return true;
    }
    const std::size_t components = components_of(binding.type);
    const std::size_t row = static_cast<std::size_t>(strips ? layout.pitch() : layout.tile_columns());
    const std::size_t written = strips ? static_cast<std::size_t>(layout.nx + 1) : row;
    const std::size_t words = components * row * static_cast<std::size_t>(layout.strips());
    fill_words(buffer, std::vector<std::uint32_t>(words, std::bit_cast<std::uint32_t>(untouched_value())), false);
    for (std::size_t at = 0; at < words; ++at) {
        if (at / components % row >= written) continue;
        buffer.may_change[at] = true;
        // Tiles that are kept: some never measured, the others changed in step 3.
        buffer.before[at] = binding.access == Access::out ? nan_word : at % 3 == 0 ? ~0u : 3u;
        buffer.must_change[at] = binding.type == compute::Scalar::vec4;
    }
    return true;
}

// Spread over the grid and a little beyond it; the first ones on a corner, a cell centre and a face.
std::vector<std::uint32_t> point_words(const WorldParams& params) {
    const double width = params.nx * static_cast<double>(params.dx), height = params.ny * static_cast<double>(params.dx);
    const double half = 0.5 * static_cast<double>(params.dx);
    std::vector<std::uint32_t> words;
    for (int n = 0; n < sampled_points; ++n) {
        const auto spread = [n](double step) { return 1.2 * std::fmod(step * (n + 1), 1.0) - 0.1; };
        double x = width * spread(0.7548776662), y = height * spread(0.5698402910);
        if (n < 3) x = y = n * half;
        words.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(x)));
        words.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(y)));
    }
    return words;
}

// Marks of all kinds in a third of the places.
std::vector<std::uint32_t> mark_words(std::size_t count) {
    std::vector<std::uint32_t> words(count);
    for (std::size_t n = 0; n < count; n += 3) words[n] = static_cast<std::uint32_t>(n) * 2654435761u & 0x01FF03FFu;
    return words;
}

// Counts and floats of columns, as count_limits leaves them; or nothing yet, all of which it must write but the row's rest.
void fill_limit_columns(BenchBuffer& buffer, const FieldLayout& layout, bool found) {
    const auto pitch = static_cast<std::size_t>(layout.pitch()), rows = LIMIT_WORDS * static_cast<std::size_t>(layout.strips());
    std::vector<std::uint32_t> words(pitch * rows, nan_word);
    if (found)
        for (std::size_t n = 0; n < words.size(); ++n) {
            const std::uint32_t count = static_cast<std::uint32_t>(n) * 2654435761u >> 25;
            const bool sum = n < LIMIT_SUMS * pitch * static_cast<std::size_t>(layout.strips());
            words[n] = sum ? count : std::bit_cast<std::uint32_t>(static_cast<float>(count) - 64.0F);
        }
    fill_words(buffer, std::move(words), !found);
    if (found) return;
    for (std::size_t n = 0; n < pitch * rows; ++n) buffer.may_change[n] = n % pitch <= static_cast<std::size_t>(layout.nx);
    buffer.must_change = buffer.may_change;
}

std::vector<std::uint32_t> ledger_words(std::size_t count) {
    std::vector<std::uint32_t> words(count);
    for (std::size_t n = 0; n < count; ++n) words[n] = ledger_start(n);
    return words;
}

// Four numbers of each outer face, west, east, south, north: what its kind remembers.
std::vector<std::uint32_t> memory_words(const reference::Solver<float>& s) {
    std::vector<std::uint32_t> words;
    for (const bool is_y : {false, true}) {
        const reference::Axis axis = s.axis(is_y);
        for (const int a : {0, axis.along()})
            for (int b = 0; b < axis.across(); ++b) {
                const auto& memory = s.side_memory.along(axis)[axis.face(a, b)];
                for (const float value : {memory.stream + memory.error, memory.mean, memory.rise, memory.above})
                    words.push_back(std::bit_cast<std::uint32_t>(value));
            }
    }
    return words;
}

} // namespace

std::uint32_t ledger_start(std::size_t word) { return 0xFFFFFF00u + static_cast<std::uint32_t>(word * 37 % 251); }

compute::Range2 written_range(const std::string& stage, const std::string& base, const WorldParams& params) {
    if (stage == "open_sides" && base == "water_height") return {-1, -1, params.nx + 1, params.ny + 1};
    if ((stage == "apply_edits" || stage == "write_values") && base == "terrain")
        return {-GHOST, -GHOST, params.nx + 1 + GHOST, params.ny + 1 + GHOST};
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
        } else if (binding.name == "points") {
            fill_words(buffers[b], point_words(params), false);
        } else if (binding.name == "samples") {
            fill_words(buffers[b], std::vector<std::uint32_t>(std::size_t{sampled_points} * SAMPLE_FLOATS, nan_word), true);
            buffers[b].must_change = buffers[b].may_change;
        } else if (binding.name == "limit_marks" && binding.access == Access::in) {
            fill_words(buffers[b], mark_words(layout.size()), false);
        } else if (binding.name == "limit_columns") {
            fill_limit_columns(buffers[b], layout, binding.access == Access::in);
        } else if (binding.name == "limit_counts") {
            const auto tiles = static_cast<std::size_t>(layout.tile_columns() * layout.strips());
            fill_words(buffers[b], std::vector<std::uint32_t>(tiles * LIMIT_WORDS, nan_word), true);
            buffers[b].must_change = buffers[b].may_change;
        } else if (binding.name == "stamp_images") {
            std::vector<std::uint32_t> words(STAMP_PAGE, nan_word);
            std::size_t at = 0;
            for (const float value : stamp_of_cases().values) words[at++] = std::bit_cast<std::uint32_t>(value);
            fill_words(buffers[b], std::move(words), false);
        } else if (binding.name == "written_values") {
            std::vector<std::uint32_t> words;
            for (const float value : values_of_cases(scene)) words.push_back(std::bit_cast<std::uint32_t>(value));
            fill_words(buffers[b], std::move(words), false);
        } else if (binding.name == "source_ledger") {
            fill_words(buffers[b],
                       ledger_words(std::size_t{2 * LEDGER_ENTRIES} * static_cast<std::size_t>(layout.strips() * layout.pitch())),
                       true);
        } else if (binding.name == "side_memory") {
            fill_words(buffers[b], memory_words(*pilot.narrow), true);
        } else if (binding.name == "side_ledger") {
            fill_words(buffers[b], ledger_words(4 * static_cast<std::size_t>(layout.rim())), true);
        } else if (!fill_active_tiles(buffers[b], binding, params) && !fill_tiles(buffers[b], binding, layout)) {
            fill_field(buffers[b], std::string(stage.name), binding, scene, pilot, params);
        }
    }
    return buffers;
}

} // namespace wadi::conformance
