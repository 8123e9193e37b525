#include "engine/step/run/field_store.hpp"
#include "engine/threads/bands.hpp"
#include <algorithm>

namespace wadi {

namespace {

std::string scratch_label(int block) { return "scratch " + std::to_string(block); }

FieldLayout layout_of(const Settings& settings) { return {settings.grid.nx, settings.grid.ny}; }

std::vector<compute::BufferDesc> wanted_by(const StepPlan& plan, const Settings& settings) {
    std::vector<compute::BufferDesc> wanted;
    for (const auto& field : plan.fields) {
        if (field.role == FieldRole::scratch && field.memory >= 0) continue;
        wanted.push_back({bytes_of(field, settings), field.name});
        if (field.ping_pong) wanted.push_back({bytes_of(field, settings), next_name(field.name)});
    }
    for (int block = 0; block < plan.scratch_blocks; ++block)
        wanted.push_back({layout_of(settings).size() * 4, scratch_label(block)});
    return wanted;
}

} // namespace

std::uint64_t bytes_of(const PlanField& field, const Settings& settings) {
    const FieldLayout layout = layout_of(settings);
    if (field.role == FieldRole::shapes) return SOURCE_VECTORS * sizeof(vec4);
    if (field.role == FieldRole::tiles) {
        const int side = settings.tile_side();
        const auto tiles = [&](int cells) {
            return side > 0 ? static_cast<std::uint64_t>(FieldLayout::active_tiles(cells, side)) : 0;
        };
        const auto columns = tiles(layout.nx), rows = tiles(layout.ny);
        return 4 * (field.name.starts_with("active_dispatch") ? 8
                    : field.name.starts_with("active_counts") ? rows
                                                              : columns * rows);
    }
    if (field.role == FieldRole::rim) return static_cast<std::uint64_t>(layout.rim()) * 4 * 4;
    if (field.role != FieldRole::ledger) return layout.size() * PlanField::element_bytes;
    if (field.name != "source_ledger") return static_cast<std::uint64_t>(layout.rim()) * 4 * 4;
    return std::uint64_t{2 * LEDGER_ENTRIES} * static_cast<std::uint64_t>(layout.strips()) *
           static_cast<std::uint64_t>(layout.pitch()) * 4;
}

LimitBytes limit_bytes(const FieldLayout& layout) {
    const std::uint64_t strips = std::uint64_t{LIMIT_WORDS} * 4 * static_cast<std::uint64_t>(layout.strips());
    return {layout.size() * 4, strips * static_cast<std::uint64_t>(layout.pitch()),
            strips * static_cast<std::uint64_t>(layout.tile_columns())};
}

std::uint64_t most_device_bytes(const Settings& settings, std::uint32_t effects) {
    std::uint64_t most = 0;
    for (const bool tiles : {false, true}) {
        if (tiles && settings.active_tiles == 0) continue;
        for (const bool fused : {false, true}) {
            StepPlan plan = make_step_plan(effects, settings.method.substeps, {tiles, fused, true});
            if (tiles) { // a world that may leave tiles out has the fields of both
                StepPlan whole = make_step_plan(effects, settings.method.substeps, {false, fused, true});
                const int without = whole.field_buffers();
                share_fields(plan, whole);
                if (settings.active_tiles == tiles_where_cheap && !tiles_are_cheap(plan, without)) continue;
            }
            std::uint64_t bytes = 0;
            for (const auto& buffer : wanted_by(plan, settings)) bytes += buffer.bytes;
            most = std::max(most, bytes);
        }
    }
    return most + limit_bytes(layout_of(settings)).all();
}

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

FieldStore::FieldStore(WorldDevice& device, const Settings& settings) : device_(device), settings_(settings), buffers_(device) {}

std::vector<KeptField> FieldStore::kept(const std::vector<PlanField>& fields) const {
    std::vector<KeptField> kept;
    for (const auto& field : fields)
        if (field.role == FieldRole::state || field.role == FieldRole::rim || field.role == FieldRole::ledger)
            kept.push_back({field.name, bytes_of(field, settings_)});
    return kept;
}

Status FieldStore::set_plan(const StepPlan& plan) {
    auto wanted = wanted_by(plan, settings_);
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
    const FieldLayout layout = layout_of(settings_);
    const auto pitch = static_cast<std::size_t>(layout.pitch()), rows = static_cast<std::size_t>(layout.rows());
    const std::size_t most = rows_at_once(layout);
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
        if (auto status = write(name, layout.row(static_cast<int>(first) - GHOST), std::span(part).first(count * pitch)); !status)
            return status;
    }
    return ok_status();
}

} // namespace wadi
