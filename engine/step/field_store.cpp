#include "engine/step/field_store.hpp"
#include "engine/step/half.hpp"
#include <algorithm>

namespace wadi {

namespace {

std::string scratch_label(int block) { return "scratch " + std::to_string(block); }

} // namespace

std::vector<float> with_ghosts(const FieldLayout& layout, const std::vector<float>& cells, bool repeat_edges) {
    std::vector<float> field(layout.size(), 0.0F);
    if (cells.empty()) return field;
    for (int j = -GHOST; j < layout.ny + 1 + GHOST; ++j) {
        for (int i = -GHOST; i < layout.nx + 1 + GHOST; ++i) {
            const int x = std::clamp(i, 0, layout.nx - 1), y = std::clamp(j, 0, layout.ny - 1);
            if (repeat_edges || (x == i && y == j))
                field[layout.index(i, j)] =
                    cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(layout.nx) + static_cast<std::size_t>(x)];
        }
    }
    return field;
}

FieldStore::FieldStore(WorldDevice& device, const Settings& settings)
    : device_(device), layout_{settings.grid.nx, settings.grid.ny},
      tile_columns_(settings.active_tiles > 0 ? FieldLayout::active_tiles(layout_.nx, settings.active_tiles) : 0),
      tile_rows_(settings.active_tiles > 0 ? FieldLayout::active_tiles(layout_.ny, settings.active_tiles) : 0), buffers_(device) {
}

std::uint64_t FieldStore::bytes_of(const PlanField& field) const {
    if (field.role == FieldRole::shapes) return 2 * MAX_SOURCES * sizeof(vec4);
    if (field.role == FieldRole::tiles) {
        const auto columns = static_cast<std::uint64_t>(tile_columns_), rows = static_cast<std::uint64_t>(tile_rows_);
        return 4 * (field.name.starts_with("active_dispatch") ? 8
                    : field.name.starts_with("active_counts") ? rows
                                                              : columns * rows);
    }
    if (field.role != FieldRole::ledger) return layout_.size() * static_cast<std::uint64_t>(field.element_bytes());
    if (field.name != "source_ledger") return static_cast<std::uint64_t>(layout_.rim()) * 4 * 4;
    return std::uint64_t{2 * LEDGER_ENTRIES} * static_cast<std::uint64_t>(layout_.strips()) *
           static_cast<std::uint64_t>(layout_.pitch()) * 4;
}

std::vector<KeptField> FieldStore::kept(const std::vector<PlanField>& fields) const {
    std::vector<KeptField> kept;
    for (const auto& field : fields)
        if (field.role == FieldRole::state || field.role == FieldRole::ledger) kept.push_back({field.name, bytes_of(field)});
    return kept;
}

std::vector<compute::BufferDesc> FieldStore::wanted_by(const StepPlan& plan) const {
    std::vector<compute::BufferDesc> wanted;
    for (const auto& field : plan.fields) {
        if (field.role == FieldRole::scratch) continue;
        wanted.push_back({bytes_of(field), field.name});
        if (field.ping_pong) wanted.push_back({bytes_of(field), next_name(field.name)});
    }
    for (int block = 0; block < plan.scratch_blocks; ++block) wanted.push_back({layout_.size() * 4, scratch_label(block)});
    return wanted;
}

Status FieldStore::set_plan(const StepPlan& plan) {
    const auto wanted = wanted_by(plan);
    if (auto status = buffers_.keep_also(wanted); !status) return status;
    // Before turn 0 the first buffer of each pair is the current one.
    for (const auto& name : parity()) buffers_.exchange(name, next_name(name));
    buffers_.keep_only(wanted);
    fields_ = plan.fields;
    parities_ = {};
    turn_ = 0;
    ++recording_;
    return ok_status();
}

const PlanField* FieldStore::find(const std::string& name) const {
    const auto found = std::find_if(fields_.begin(), fields_.end(), [&](const PlanField& f) { return f.name == name; });
    return found == fields_.end() ? nullptr : &*found;
}

compute::Buffer FieldStore::buffer(const std::string& name, const Parity& parity) const {
    const std::string base = base_name(name);
    const auto* field = find(base);
    if (field == nullptr) return {};
    if (field->role == FieldRole::scratch) return buffers_[scratch_label(field->memory)];
    return buffers_[is_next(name) == parity.contains(base) ? base : next_name(base)];
}

Status FieldStore::read(const std::string& name, std::size_t first, std::span<float> values) {
    const auto* field = find(name);
    if (field == nullptr) {
        std::fill(values.begin(), values.end(), 0.0F);
        return ok_status();
    }
    if (!field->half) return device_.read(buffer(name), first * 4, std::as_writable_bytes(values));
    std::vector<std::uint16_t> halves(values.size());
    auto status = device_.read(buffer(name), first * 2, std::as_writable_bytes(std::span(halves)));
    if (status) std::transform(halves.begin(), halves.end(), values.begin(), from_half);
    return status;
}

Status FieldStore::write(const std::string& name, std::size_t first, std::span<const float> values) {
    const auto* field = find(name);
    if (field == nullptr) return ok_status();
    if (!field->half) return device_.write(buffer(name), first * 4, std::as_bytes(values));
    std::vector<std::uint16_t> halves(values.size());
    std::transform(values.begin(), values.end(), halves.begin(), to_half);
    return device_.write(buffer(name), first * 2, std::as_bytes(std::span(halves)));
}

} // namespace wadi
