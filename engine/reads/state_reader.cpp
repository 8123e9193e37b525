#include "engine/reads/state_reader.hpp"
#include "engine/settings/data/quanta.hpp"
#include "engine/step/plan/world_params.hpp"
#include "engine/step/run/active_count.hpp"
#include "engine/threads/bands.hpp"
#include <algorithm>
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

/// Of a row of field number n.
std::uint64_t hash_of_row(std::uint64_t n, int j, std::span<const float> row) {
    const std::uint64_t place = (n << 56) ^ (static_cast<std::uint64_t>(j) << 28);
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
        std::uint32_t word = 0; // std::bit_cast is not in LLVM's library before version 14
        std::memcpy(&word, &row[i], sizeof word);
        hash += mix(mix(place ^ i) + word);
    }
    return hash;
}

} // namespace

struct StateReader::Figures {
    std::uint64_t hash = 0, not_finite = 0;
    std::int64_t quanta = 0;
    double largest = 0, smallest = 0; // finite values; of velocities the largest absolute one

    void add(const Figures& other) {
        hash += other.hash;
        not_finite += other.not_finite;
        quanta = add_quanta(quanta, other.quanta);
        largest = std::max(largest, other.largest);
        smallest = std::min(smallest, other.smallest);
    }
    void add_heights(std::span<const float> row, double quantum) {
        for (const float value : row) {
            const double height = static_cast<double>(value);
            if (!std::isfinite(value)) continue;
            quanta = add_quanta(quanta, to_quanta(height, quantum));
            largest = std::max(largest, height);
            smallest = std::min(smallest, height);
        }
    }
    void add_speeds(std::span<const float> row) {
        for (const float value : row)
            if (std::isfinite(value)) largest = std::max(largest, std::abs(static_cast<double>(value)));
    }
};

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

StateReader::Rows StateReader::rows_of(const std::string& field) {
    return [this, field](std::size_t first, std::span<float> rows) { return state_.fields().read(field, first, rows); };
}

Status StateReader::read_cells(const Rows& rows_from, const Region& region, std::span<float> values) {
    const auto& layout = state_.layout();
    const std::size_t pitch = static_cast<std::size_t>(layout.pitch()), width = static_cast<std::size_t>(region.nx),
                      height = static_cast<std::size_t>(region.ny), most = std::min(rows_at_once(layout), height);
    std::vector<float> rows(pitch * (most - 1) + width);
    for (std::size_t first = 0; first < height; first += most) {
        const std::size_t count = std::min(most, height - first);
        const auto part = std::span(rows).first(pitch * (count - 1) + width);
        if (auto status = rows_from(layout.index(region.i0, region.j0) + first * pitch, part); !status) return status;
        for (std::size_t j = 0; j < count; ++j)
            std::memcpy(values.data() + (first + j) * width, part.data() + j * pitch, width * sizeof(float));
    }
    return ok_status();
}

Status StateReader::look_at(const Rows& rows_from, int nx, int ny, const Look& look, Figures& figures) {
    const auto& layout = state_.layout();
    const std::size_t pitch = static_cast<std::size_t>(layout.pitch()), width = static_cast<std::size_t>(nx),
                      height = static_cast<std::size_t>(ny), most = std::min(rows_at_once(layout), height);
    std::vector<float> rows(pitch * (most - 1) + width);
    for (std::size_t first = 0; first < height; first += most) {
        const std::size_t count = std::min(most, height - first), band = row_band(width);
        const auto part = std::span(rows).first(pitch * (count - 1) + width);
        if (auto status = rows_from(layout.index(0, 0) + first * pitch, part); !status) return status;
        std::vector<Figures> found(bands_of(count, band));
        in_bands(count, band, [&](std::size_t n, std::size_t begin, std::size_t end) {
            for (std::size_t j = begin; j < end; ++j) look(static_cast<int>(first + j), part.subspan(j * pitch, width), found[n]);
        });
        for (const Figures& of_band : found) figures.add(of_band);
    }
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
    if (name == "limits") return limits_.read(region, values);
    if (row != nullptr && row->role == FieldRole::published) {
        const std::string stage = name == "surface_saturation" ? "publish_saturation" : "publish_" + name;
        auto status = publish(stage, {}, {row->name.data()}); // the program keeps the pointer
        return status ? read_cells(rows_of(output_[0]), region, values) : status;
    }
    const bool readable = row != nullptr && row->place != FieldPlace::none;
    if (!readable || state_.plan().find(name) == nullptr) {
        if (!readable || row->role != FieldRole::state)
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
    return read_cells(rows_of(name), region, values);
}

Status StateReader::read(const std::string& name, std::span<float> values) {
    return read(name, {0, 0, state_.layout().nx, state_.layout().ny}, values);
}

Result<std::uint64_t> StateReader::hash_fields(WorldStats* stats) {
    std::uint64_t hash = 0, number = 0;
    for (const FieldRow& field : field_table()) {
        if (!field.hashed) continue;
        const std::uint64_t n = number++;
        const std::string name(field.name);
        if (state_.plan().find(name) == nullptr) continue;
        if (field.role == FieldRole::rim) {
            std::vector<float> values(static_cast<std::size_t>(state_.layout().rim()) * 4);
            if (auto status = state_.fields().read(name, 0, values); !status) return status;
            hash += hash_of_row(n, 0, values);
            continue;
        }
        const bool height = name.ends_with("_height"), velocity = is_velocity(field);
        const auto look = [&](int j, std::span<const float> row, Figures& figures) {
            figures.hash += hash_of_row(n, j, row);
            if (stats == nullptr) return;
            figures.not_finite += static_cast<std::uint64_t>(
                std::count_if(row.begin(), row.end(), [](float value) { return !std::isfinite(value); }));
            if (height) figures.add_heights(row, stats->quantum);
            if (velocity) figures.add_speeds(row);
        };
        // Velocities have one more face than cells along their own axis.
        const int nx = state_.layout().nx + (field.place == FieldPlace::west_face ? 1 : 0),
                  ny = state_.layout().ny + (field.place == FieldPlace::south_face ? 1 : 0);
        Figures figures;
        if (auto status = look_at(rows_of(name), nx, ny, look, figures); !status) return status;
        hash += figures.hash;
        if (stats == nullptr) continue;
        const bool sand = name.starts_with("sand_");
        stats->not_finite += figures.not_finite;
        if (height) {
            (sand ? stats->sand_quanta : stats->water_quanta) = figures.quanta;
            (sand ? stats->largest_sand : stats->largest_water) = figures.largest;
            stats->smallest_height = std::min(stats->smallest_height, figures.smallest);
        } else if (velocity) {
            auto& largest = sand ? stats->largest_sand_speed : stats->largest_water_speed;
            largest = std::max(largest, figures.largest);
        }
    }
    return hash;
}

Result<std::uint64_t> StateReader::hash() {
    auto status = stepper_.finish_step();
    return status ? hash_fields(nullptr) : Result<std::uint64_t>(status);
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
    auto hash = hash_fields(&s);
    if (!hash) return hash.status();
    s.hash = *hash;
    if (state_.plan().active_tiles) {
        auto counts = read_active_counts(state_);
        if (!counts) return counts.status();
        s.tiles = state_.tiles().count();
        s.active_tiles = *std::max_element(counts->begin(), counts->end());
        s.active_sand_tiles = counts->back();
    } else if (state_.chooses_tiles()) {
        s.tiles = s.active_tiles = s.active_sand_tiles = state_.tiles().count();
    }
    auto limits = limits_.count();
    if (!limits) return limits.status();
    s.limits = *limits;
    return s;
}

} // namespace wadi
