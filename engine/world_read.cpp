// Reading a world: fields, published fields, ledger, statistics and the state hash.
#include "engine/world.hpp"
#include "engine/world_params.hpp"
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

// In the order that the hash numbers them: never reorder, or every golden hash changes.
constexpr const char* hashed_fields[] = {"sand_height",      "water_height",     "stretch_xx",      "stretch_xy",
                                         "stretch_yy",       "sand_velocity_x",  "sand_velocity_y", "water_velocity_x",
                                         "water_velocity_y", "mixed_velocity_x", "mixed_velocity_y"};

bool is_velocity(const std::string& name) { return name.ends_with("velocity_x") || name.ends_with("velocity_y"); }

} // namespace

Result<std::vector<float>> World::read_buffer(compute::Buffer from) {
    std::vector<float> raw(layout_.size());
    if (auto status = note(device_->read(from, 0, std::as_writable_bytes(std::span(raw)))); !status) return status;
    return raw;
}

Result<std::vector<float>> World::read_raw(const std::string& field) {
    const auto from = buffer(field, start_parity_[static_cast<std::size_t>(parity_)]);
    if (from.id == 0) return std::vector<float>(layout_.size(), 0.0F);
    return read_buffer(from);
}

Status World::read_cells(compute::Buffer from, std::span<float> values) {
    auto raw = read_buffer(from);
    if (!raw) return raw.status();
    for (int j = 0; j < layout_.ny; ++j) {
        std::memcpy(values.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(layout_.nx),
                    raw->data() + layout_.index(0, j), static_cast<std::size_t>(layout_.nx) * sizeof(float));
    }
    return ok_status();
}

Status World::append_stage(compute::ProgramBuilder& builder, const char* stage_name,
                           const std::map<std::string, std::string>& names) {
    const int index = compute::find_stage(stage_name);
    const auto& stage = compute::stage_table()[static_cast<std::size_t>(index)];
    auto pipeline = device_->create_pipeline(index, plan_.effects, group_);
    if (!pipeline) return pipeline.status();
    const auto& parity = start_parity_[static_cast<std::size_t>(parity_)];
    compute::Dispatch dispatch{*pipeline, index, plan_.effects, {}, compute::extent_range(stage.extent, params_), stage_name};
    std::size_t outputs = 0;
    for (const auto& binding : stage.bindings) {
        const std::string name(binding.name);
        const bool exists = (plan_.effects & binding.condition) == binding.condition;
        if (!exists) {
            dispatch.slots.push_back({});
        } else if (binding.access == compute::Access::out) {
            auto& out = output_.at(outputs++);
            if (out.id == 0) {
                auto made = make_buffer("output " + std::to_string(outputs), layout_.size() * 4);
                if (!made) return made.status();
                out = *made;
            }
            dispatch.slots.push_back(out);
        } else {
            dispatch.slots.push_back(buffer(names.contains(name) ? names.at(name) : name, parity));
        }
    }
    builder.dispatch(std::move(dispatch));
    return ok_status();
}

Status World::publish(const char* stage, const std::map<std::string, std::string>& names) {
    compute::ProgramBuilder builder(std::string("publish ") + stage);
    if (auto status = append_stage(builder, stage, names); !status) return note(status);
    auto program = device_->compile(builder, params_);
    if (!program) return note(program.status());
    auto ticket = device_->submit(*program, StepInput{});
    auto status = ticket ? device_->wait(*ticket) : ticket.status();
    device_->destroy_program(*program);
    return note(status);
}

Status World::read(const std::string& name, std::span<float> values) {
    if (!lost_) return lost_;
    if (name == "water_depth" || name == "free_surface" || name == "surface_saturation") {
        if (auto status = publish("publish_heights", {}); !status) return status;
        return read_cells(output_[name == "water_depth" ? 0 : name == "free_surface" ? 1 : 2], values);
    }
    if (plan_.find(name) == nullptr) {
        std::fill(values.begin(), values.end(), 0.0F);
        return ok_status();
    }
    if (is_velocity(name)) {
        const std::string layer = name.substr(0, name.size() - 1);
        if (auto status = publish("publish_velocity", {{"velocity_x", layer + "x"}, {"velocity_y", layer + "y"}}); !status)
            return status;
        return read_cells(output_[name.back() == 'x' ? 0 : 1], values);
    }
    return read_cells(buffer(name, start_parity_[static_cast<std::size_t>(parity_)]), values);
}

Result<Ledger> World::read_ledger() {
    Ledger ledger;
    // Sums the low and high words of one entry over its row of counters.
    const auto sum = [](const std::vector<std::uint32_t>& words, std::size_t row, std::size_t entry) {
        std::uint64_t total = 0;
        for (std::size_t n = 0; n < row; ++n)
            total += words[2 * entry * row + n] + (std::uint64_t{words[(2 * entry + 1) * row + n]} << 32);
        return static_cast<std::int64_t>(total);
    };
    const auto words = [&](const char* name, std::size_t count) -> Result<std::vector<std::uint32_t>> {
        std::vector<std::uint32_t> values(count);
        if (auto status = note(device_->read(buffers_.at(name)[0], 0, std::as_writable_bytes(std::span(values)))); !status)
            return status;
        return values;
    };
    if (plan_.find("source_ledger") != nullptr) {
        const std::size_t row = static_cast<std::size_t>(layout_.strips()) * static_cast<std::size_t>(layout_.pitch());
        auto w = words("source_ledger", row * 2 * LEDGER_ENTRIES);
        if (!w) return w.status();
        ledger.water_in += sum(*w, row, LEDGER_WATER_IN);
        ledger.water_out += sum(*w, row, LEDGER_WATER_OUT);
        ledger.sand_in += sum(*w, row, LEDGER_SAND_IN);
        ledger.sand_out += sum(*w, row, LEDGER_SAND_OUT);
        ledger.refused += sum(*w, row, LEDGER_REFUSED);
    }
    const auto rim = static_cast<std::size_t>(layout_.rim());
    if (plan_.find("water_side_ledger") != nullptr) {
        auto w = words("water_side_ledger", 4 * rim);
        if (!w) return w.status();
        ledger.water_in += sum(*w, rim, 0);
        ledger.water_out += sum(*w, rim, 1);
    }
    if (plan_.find("sand_side_ledger") != nullptr) {
        auto w = words("sand_side_ledger", 4 * rim);
        if (!w) return w.status();
        ledger.sand_in += sum(*w, rim, 0);
        ledger.sand_out += sum(*w, rim, 1);
    }
    return ledger;
}

Result<WorldStats> World::stats() {
    if (!lost_) return lost_;
    WorldStats s;
    const double quantum = ledger_quantum(settings_.method);
    s.quantum = quantum;
    s.sand_initial = sand_initial_;
    s.water_initial = water_initial_;
    auto ledger = read_ledger();
    if (!ledger) return ledger.status();
    s.ledger = *ledger;
    for (std::size_t n = 0; n < std::size(hashed_fields); ++n) {
        const std::string name = hashed_fields[n];
        if (plan_.find(name) == nullptr) continue;
        auto raw = read_raw(name);
        if (!raw) return raw.status();
        const bool sand = name.starts_with("sand_"), height = name.ends_with("_height"), velocity = is_velocity(name);
        // Velocities have one more face than cells along their own axis.
        const int nx = layout_.nx + (name.ends_with("velocity_x") ? 1 : 0),
                  ny = layout_.ny + (name.ends_with("velocity_y") ? 1 : 0);
        for (int j = 0; j < ny; ++j) {
            for (int i = 0; i < nx; ++i) {
                const float value = (*raw)[layout_.index(i, j)];
                std::uint32_t bits;
                std::memcpy(&bits, &value, 4);
                s.hash += mix(
                    mix((std::uint64_t{n} << 56) ^ (static_cast<std::uint64_t>(j) << 28) ^ static_cast<std::uint64_t>(i)) + bits);
                if (!std::isfinite(value)) {
                    ++s.not_finite;
                    continue;
                }
                const double x = static_cast<double>(value);
                if (height) {
                    (sand ? s.sand_quanta : s.water_quanta) += std::llrint(x / quantum);
                    auto& largest = sand ? s.largest_sand : s.largest_water;
                    largest = std::max(largest, x);
                    s.smallest_height = std::min(s.smallest_height, x);
                } else if (velocity) {
                    auto& largest = sand ? s.largest_sand_speed : s.largest_water_speed;
                    largest = std::max(largest, std::abs(x));
                }
            }
        }
    }
    if (auto status = publish("mark_limits", {}); !status) return status;
    auto marks = read_buffer(output_[0]);
    if (!marks) return marks.status();
    for (int j = 0; j <= layout_.ny; ++j) {
        for (int i = 0; i <= layout_.nx; ++i) {
            std::uint32_t mark;
            std::memcpy(&mark, &(*marks)[layout_.index(i, j)], 4);
            s.clamped_faces += mark & 255u;
            s.capped_faces += mark >> 8 & 255u;
            s.limited_cells += mark >> 16;
        }
    }
    return s;
}

} // namespace wadi
