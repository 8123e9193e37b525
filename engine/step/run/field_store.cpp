#include "engine/step/run/field_store.hpp"
#include "engine/threads/bands.hpp"
#include <algorithm>

namespace wadi {

namespace {

std::string scratch_label(int block) { return "scratch " + std::to_string(block); }

} // namespace

void fill_row(const FieldLayout& layout, const std::vector<float>& cells, bool repeat_edges, int j, std::span<float> row) {
    const int y = std::clamp(j, 0, layout.ny - 1);
    if (cells.empty() || (y != j && !repeat_edges)) return;
    const auto from = cells.begin() + static_cast<std::ptrdiff_t>(y) * layout.nx;
    std::copy_n(from, layout.nx, row.begin() + GHOST);
    if (!repeat_edges) return;
    std::fill_n(row.begin(), GHOST, *from);
    std::fill_n(row.begin() + GHOST + layout.nx, 1 + GHOST, from[layout.nx - 1]);
}

std::vector<float> with_ghosts(const FieldLayout& layout, const std::vector<float>& cells, bool repeat_edges) {
    std::vector<float> field(layout.size(), 0.0F);
    const auto pitch = static_cast<std::size_t>(layout.pitch());
    for (int row = 0; row < layout.rows(); ++row)
        fill_row(layout, cells, repeat_edges, row - GHOST, std::span(field).subspan(layout.row(row - GHOST), pitch));
    return field;
}

FieldStore::FieldStore(WorldDevice& device, const Settings& settings)
    : device_(device), layout_{settings.grid.nx, settings.grid.ny},
      tile_columns_(settings.tile_side() > 0 ? FieldLayout::active_tiles(layout_.nx, settings.tile_side()) : 0),
      tile_rows_(settings.tile_side() > 0 ? FieldLayout::active_tiles(layout_.ny, settings.tile_side()) : 0), buffers_(device) {}

std::uint64_t FieldStore::bytes_of(const PlanField& field) const {
    if (field.role == FieldRole::shapes) return SOURCE_VECTORS * sizeof(vec4);
    if (field.role == FieldRole::tiles) {
        const auto columns = static_cast<std::uint64_t>(tile_columns_), rows = static_cast<std::uint64_t>(tile_rows_);
        return 4 * (field.name.starts_with("active_dispatch") ? 8
                    : field.name.starts_with("active_counts") ? rows
                                                              : columns * rows);
    }
    if (field.role == FieldRole::rim) return static_cast<std::uint64_t>(layout_.rim()) * 4 * 4;
    if (field.role != FieldRole::ledger) return layout_.size() * PlanField::element_bytes;
    if (field.name != "source_ledger") return static_cast<std::uint64_t>(layout_.rim()) * 4 * 4;
    return std::uint64_t{2 * LEDGER_ENTRIES} * static_cast<std::uint64_t>(layout_.strips()) *
           static_cast<std::uint64_t>(layout_.pitch()) * 4;
}

std::vector<KeptField> FieldStore::kept(const std::vector<PlanField>& fields) const {
    std::vector<KeptField> kept;
    for (const auto& field : fields)
        if (field.role == FieldRole::state || field.role == FieldRole::rim || field.role == FieldRole::ledger)
            kept.push_back({field.name, bytes_of(field)});
    return kept;
}

std::vector<compute::BufferDesc> FieldStore::wanted_by(const StepPlan& plan) const {
    std::vector<compute::BufferDesc> wanted;
    for (const auto& field : plan.fields) {
        if (field.role == FieldRole::scratch && field.memory >= 0) continue;
        wanted.push_back({bytes_of(field), field.name});
        if (field.ping_pong) wanted.push_back({bytes_of(field), next_name(field.name)});
    }
    for (int block = 0; block < plan.scratch_blocks; ++block) wanted.push_back({layout_.size() * 4, scratch_label(block)});
    return wanted;
}

Status FieldStore::set_plan(const StepPlan& plan) {
    auto wanted = wanted_by(plan);
    auto fields = plan.fields;
    if (auto status = buffers_.keep_also(wanted); !status) return status;
    // Before turn 0 the first buffer of each pair is the current one.
    for (const auto& name : parity()) buffers_.exchange(name, next_name(name));
    wanted_ = std::move(wanted);
    fields_ = std::move(fields);
    parities_ = {};
    turn_ = 0;
    set_way(plan.active_tiles);
    ++recording_;
    return ok_status();
}

void FieldStore::go_back(Replaced&& before) noexcept {
    fields_ = std::move(before.fields);
    wanted_ = std::move(before.wanted);
    buffers_.go_back(std::move(before.buffers));
    parities_ = std::move(before.parities);
    way_ = before.way;
    turn_ = before.turn;
    ++recording_;
}

const PlanField* FieldStore::find(const std::string& name) const {
    const auto found = std::find_if(fields_.begin(), fields_.end(), [&](const PlanField& f) { return f.name == name; });
    return found == fields_.end() ? nullptr : &*found;
}

compute::Buffer FieldStore::buffer(const std::string& name, const Parity& parity) const {
    const std::string base = base_name(name);
    const auto* field = find(base);
    if (field == nullptr) return {};
    if (field->role == FieldRole::scratch && field->memory >= 0) return buffers_[scratch_label(field->memory)];
    return buffers_[is_next(name) == parity.contains(base) ? base : next_name(base)];
}

Status FieldStore::read(const std::string& name, std::size_t first, std::span<float> values) {
    const auto* field = find(name);
    if (field == nullptr) {
        std::fill(values.begin(), values.end(), 0.0F);
        return ok_status();
    }
    return device_.read(buffer(name), first * 4, std::as_writable_bytes(values));
}

Status FieldStore::write(const std::string& name, std::size_t first, std::span<const float> values) {
    if (find(name) == nullptr) return ok_status();
    return device_.write(buffer(name), first * 4, std::as_bytes(values));
}

Status FieldStore::write_rows(const std::string& name, const std::function<void(int j, std::span<float> row)>& fill) {
    if (find(name) == nullptr) return ok_status();
    const auto pitch = static_cast<std::size_t>(layout_.pitch()), rows = static_cast<std::size_t>(layout_.rows());
    const std::size_t most = rows_at_once(layout_);
    std::vector<float> part(std::min(rows, most) * pitch);
    for (std::size_t first = 0; first < rows; first += most) {
        const std::size_t count = std::min(most, rows - first);
        in_bands(count, row_band(pitch), [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n) {
                const std::span<float> row(&part[n * pitch], pitch);
                std::fill(row.begin(), row.end(), 0.0F);
                fill(static_cast<int>(first + n) - GHOST, row);
            }
        });
        if (auto status = write(name, layout_.row(static_cast<int>(first) - GHOST), std::span(part).first(count * pitch));
            !status)
            return status;
    }
    return ok_status();
}

} // namespace wadi
