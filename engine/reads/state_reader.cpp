#include "engine/reads/state_reader.hpp"
#include "engine/settings/quanta.hpp"
#include "engine/step/active_count.hpp"
#include "engine/step/world_params.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace wadi {

namespace {

// Finaliser of splitmix64 (Steele, Lea, Flood 2014): every input bit reaches every output bit.
std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

bool is_velocity(const FieldRow& field) { return field.place != FieldPlace::cell; }

} // namespace

Result<std::vector<float>> StateReader::read_buffer(compute::Buffer from) {
    std::vector<float> raw(state_.layout().size());
    if (auto status = state_.device().read(from, 0, std::as_writable_bytes(std::span(raw))); !status) return status;
    return raw;
}

Result<std::vector<float>> StateReader::read_raw(const std::string& field) {
    if (auto status = stepper_.finish_step(); !status) return status;
    std::vector<float> raw(state_.layout().size());
    if (auto status = state_.fields().read(field, 0, raw); !status) return status;
    return raw;
}

StateReader::Rows StateReader::rows_of(compute::Buffer from) {
    return [this, from](std::size_t first, std::span<float> rows) {
        return state_.device().read(from, first * 4, std::as_writable_bytes(rows));
    };
}

Status StateReader::read_cells(const Rows& rows_from, const Region& region, std::span<float> values) {
    const auto& layout = state_.layout();
    const std::size_t first = layout.index(region.i0, region.j0), pitch = static_cast<std::size_t>(layout.pitch()),
                      width = static_cast<std::size_t>(region.nx);
    std::vector<float> rows(pitch * static_cast<std::size_t>(region.ny - 1) + width);
    if (auto status = rows_from(first, rows); !status) return status;
    for (std::size_t j = 0; j < static_cast<std::size_t>(region.ny); ++j)
        std::memcpy(values.data() + j * width, rows.data() + j * pitch, width * sizeof(float));
    return ok_status();
}

// Runs a stage on the state. `fields`: bindings that stand for a field of another name; `outputs`: bindings that get this
// reader's own buffers.
Status StateReader::publish(const std::string& stage, const std::map<std::string, std::string>& fields,
                            const std::vector<const char*>& outputs) {
    for (std::size_t n = 0; n < outputs.size(); ++n) {
        if (output_[n].id != 0) continue;
        auto made = state_.device().create_buffer({state_.layout().size() * 4, "reader output " + std::to_string(n)});
        if (!made) return made.status();
        output_[n] = *made;
    }
    auto& program = programs_[fields.empty() ? stage : stage + " " + fields.begin()->second];
    if (!program) {
        program = std::make_unique<StateProgram>(
            state_, stage, [this, stage, fields, outputs](compute::ProgramBuilder& builder, const Parity& parity) {
                Slots slots;
                for (const auto& [binding, field] : fields) slots[binding] = state_.fields().buffer(field, parity);
                for (std::size_t n = 0; n < outputs.size(); ++n) slots[outputs[n]] = output_[n];
                return state_.append_stage(builder, stage.c_str(), parity, slots);
            });
    }
    auto ticket = program->submit();
    return ticket ? state_.device().wait(*ticket) : ticket.status();
}

Status StateReader::read(const std::string& name, const Region& region, std::span<float> values) {
    if (auto status = check_region("read", region, state_.settings().grid, values.size()); !status) return status;
    if (auto status = stepper_.finish_step(); !status) return status;
    const FieldRow* row = find_field(name);
    if (row != nullptr && row->role == FieldRole::published) {
        const std::string stage = name == "surface_saturation" ? "publish_saturation" : "publish_" + name;
        auto status = publish(stage, {}, {row->name.data()}); // the program keeps the pointer
        return status ? read_cells(rows_of(output_[0]), region, values) : status;
    }
    if (state_.plan().find(name) == nullptr) {
        if (row == nullptr || row->role != FieldRole::state)
            return error(Code::bad_argument, "read: no field is called '" + name + "'");
        std::fill(values.begin(), values.end(), 0.0F);
        return ok_status();
    }
    if (is_velocity(*row)) {
        const std::string layer = name.substr(0, name.size() - 1);
        if (auto status = publish("publish_velocity", {{"velocity_x", layer + "x"}, {"velocity_y", layer + "y"}},
                                  {"centre_velocity_x", "centre_velocity_y"});
            !status)
            return status;
        return read_cells(rows_of(output_[name.back() == 'x' ? 0 : 1]), region, values);
    }
    return read_cells([&](std::size_t first, std::span<float> rows) { return state_.fields().read(name, first, rows); }, region,
                      values);
}

Status StateReader::read(const std::string& name, std::span<float> values) {
    return read(name, {0, 0, state_.layout().nx, state_.layout().ny}, values);
}

Result<std::uint64_t> StateReader::hash_fields(const Look& look) {
    std::uint64_t hash = 0, number = 0;
    for (const FieldRow& field : field_table()) {
        if (!field.hashed) continue;
        const std::uint64_t n = number++;
        const std::string name(field.name);
        if (state_.plan().find(name) == nullptr) continue;
        auto raw = read_raw(name);
        if (!raw) return raw.status();
        // Velocities have one more face than cells along their own axis.
        const int nx = state_.layout().nx + (field.place == FieldPlace::west_face ? 1 : 0),
                  ny = state_.layout().ny + (field.place == FieldPlace::south_face ? 1 : 0);
        for (int j = 0; j < ny; ++j) {
            const auto row = std::span<const float>(*raw).subspan(state_.layout().index(0, j), static_cast<std::size_t>(nx));
            for (std::size_t i = 0; i < row.size(); ++i) {
                hash += mix(mix((n << 56) ^ (static_cast<std::uint64_t>(j) << 28) ^ i) + std::bit_cast<std::uint32_t>(row[i]));
            }
            if (look) look(field, row);
        }
    }
    return hash;
}

Result<std::uint64_t> StateReader::hash() {
    auto status = stepper_.finish_step();
    return status ? hash_fields({}) : Result<std::uint64_t>(status);
}

Result<WorldStats> StateReader::stats() {
    if (auto status = stepper_.finish_step(); !status) return status;
    WorldStats s;
    const double quantum = ledger_quantum(state_.settings().method);
    s.quantum = quantum;
    s.sand_initial = state_.sand_initial;
    s.water_initial = state_.water_initial;
    auto ledger = read_ledger(state_);
    if (!ledger) return ledger.status();
    s.ledger = *ledger;
    auto hash = hash_fields([&](const FieldRow& field, std::span<const float> row) {
        const bool sand = field.name.starts_with("sand_"), height = field.name.ends_with("_height"),
                   velocity = is_velocity(field);
        for (const float value : row) {
            const double x = static_cast<double>(value);
            if (!std::isfinite(value)) {
                ++s.not_finite;
            } else if (height) {
                auto& sum = sand ? s.sand_quanta : s.water_quanta;
                sum = add_quanta(sum, to_quanta(x, quantum));
                auto& largest = sand ? s.largest_sand : s.largest_water;
                largest = std::max(largest, x);
                s.smallest_height = std::min(s.smallest_height, x);
            } else if (velocity) {
                auto& largest = sand ? s.largest_sand_speed : s.largest_water_speed;
                largest = std::max(largest, std::abs(x));
            }
        }
    });
    if (!hash) return hash.status();
    s.hash = *hash;
    if (state_.plan().active_tiles) {
        auto counts = read_active_counts(state_);
        if (!counts) return counts.status();
        s.tiles = state_.tiles().count();
        s.active_tiles = *std::max_element(counts->begin(), counts->end());
        s.active_sand_tiles = counts->back();
    }
    if (auto status = publish("mark_limits", {}, {"limit_marks"}); !status) return status;
    auto marks = read_buffer(output_[0]);
    if (!marks) return marks.status();
    for (int j = 0; j <= state_.layout().ny; ++j) {
        for (int i = 0; i <= state_.layout().nx; ++i) {
            std::uint32_t mark;
            std::memcpy(&mark, &(*marks)[state_.layout().index(i, j)], 4);
            s.clamped_faces += mark & 255u;
            s.capped_faces += mark >> 8 & 255u;
            s.limited_cells += mark >> 16;
        }
    }
    return s;
}

} // namespace wadi
