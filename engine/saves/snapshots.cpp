#include "engine/saves/snapshots.hpp"
#include "engine/saves/snapshot_checks.hpp"
#include "engine/settings/rules/checks.hpp"
#include "engine/step/plan/world_params.hpp"
#include <algorithm>
#include <cstring>
#include <new>

namespace wadi {

namespace {

// What a world with these effects may hold.
Content content_under(std::uint32_t effects) { return {(effects & EFFECT_SAND) != 0, (effects & EFFECT_WATER) != 0}; }

// What is loaded but for this, and nobody but the host can know why.
std::string unbooked_text(const Drift& drift, const Method& method) {
    if (height_quantum(method) <= 0 || (drift.sand == 0 && drift.water == 0)) return "";
    return "load: the snapshot holds " + std::to_string(drift.sand) + " quanta of sand and " + std::to_string(drift.water) +
           " of water that its books do not say: columns had passed method.largest_height, or its bytes were changed and sealed "
           "anew";
}

Content operator|(Content a, Content b) { return {a.sand || b.sand, a.water || b.water}; }

} // namespace

SnapshotHeader Snapshots::header() const {
    SnapshotHeader header;
    header.nx = state_.layout().nx;
    header.ny = state_.layout().ny;
    header.effects = state_.plan().effects;
    header.level = state_.level();
    header.material = state_.settings().material;
    if (state_.settings().sources != state_.level_sources()) header.sources = state_.settings().sources;
    header.totals = stepper_.totals();
    header.fields = state_.fields().kept();
    return header;
}

std::uint64_t Snapshots::most_bytes() const {
    std::vector<PlanField> fields;
    for (const auto& row : field_table()) fields.push_back({std::string(row.name), row.role});
    auto largest = header();
    largest.fields = state_.fields().kept(fields);
    return largest.bytes() + MAX_SOURCES * (SOURCE_BYTES_MOST + sizeof(StepInputs::Total));
}

LiveSettings Snapshots::live_of(const SnapshotHeader& header) const {
    return {header.material, header.sources.value_or(state_.level_sources())};
}

Status Snapshots::save(std::span<std::byte> to) {
    if (auto status = stepper_.finish_step(); !status) return status;
    const auto header = this->header();
    if (to.size() < header.bytes()) {
        return error(Code::bad_argument, "save: size is " + std::to_string(to.size()) + ", the snapshot needs " +
                                             std::to_string(header.bytes()) + " bytes");
    }
    to = to.first(in_memory(header.bytes()));
    write_header(header, to);
    for (std::size_t n = 0; n < header.fields.size(); ++n) {
        const auto& field = header.fields[n];
        const auto from = state_.fields().buffer(field.name);
        if (auto status = state_.device().read(from, 0, to.subspan(in_memory(header.begin_of(n)), in_memory(field.bytes)));
            !status)
            return status;
    }
    seal(to);
    return ok_status();
}

Status Snapshots::check(const SnapshotHeader& header) const {
    const auto& layout = state_.layout();
    if (header.nx != layout.nx || header.ny != layout.ny) {
        return error(Code::bad_argument, "load: the snapshot is of " + std::to_string(header.nx) + " x " +
                                             std::to_string(header.ny) + " cells, the world has " + std::to_string(layout.nx) +
                                             " x " + std::to_string(layout.ny));
    }
    if (header.level != state_.level())
        return error(Code::bad_argument, "load: the snapshot is of a level with other settings (dt, material, method, sides or "
                                         "sources)");
    Settings settings = state_.settings();
    settings.set_live(live_of(header));
    if (settings.sources.size() > MAX_SOURCES)
        return error(Code::bad_file, "snapshot: " + std::to_string(settings.sources.size()) + " sources are more than " +
                                         std::to_string(MAX_SOURCES));
    for (std::size_t n = 0; header.sources && n < settings.sources.size(); ++n)
        if (auto status = check_source(settings, settings.sources[n], "snapshot: sources[" + std::to_string(n) + "]"); !status)
            return error(Code::bad_file, status.message);
    auto effects = effects_required(settings, content_under(header.effects) | state_.content);
    if (!effects) return effects.status();
    if (const auto lacking = header.effects & ~(effects->mask | state_.plan().effects); lacking != 0) {
        return error(Code::bad_argument,
                     "load: the snapshot has effects that this world's level does not allow: " + effect_names(lacking));
    }
    const auto kept = state_.fields().kept(make_step_plan(header.effects, state_.plan().substeps).fields);
    for (const auto& field : header.fields) {
        const auto found = std::find_if(kept.begin(), kept.end(), [&](const KeptField& k) { return k.name == field.name; });
        if (found == kept.end() || found->bytes != field.bytes) {
            return error(Code::bad_file, "snapshot: field '" + field.name + "' of " + std::to_string(field.bytes) +
                                             " bytes is not one of this world");
        }
    }
    if (header.totals.inputs.size() != StepInputs(settings).totals().size())
        return error(Code::bad_file, "snapshot: it has " + std::to_string(header.totals.inputs.size()) + " running totals");
    return ok_status();
}

// A field that the snapshot lacks was zero there, but without mixture the water in the sand moved with the rest of the water. All
// that needs memory comes ahead of the first field that is written.
Status Snapshots::write_fields(const SnapshotHeader& header, std::span<const std::byte> from) {
    const auto find = [&](const std::string& name) {
        std::span<const std::byte> contents;
        for (std::size_t n = 0; n < header.fields.size(); ++n) {
            if (header.fields[n].name == name)
                contents = from.subspan(in_memory(header.begin_of(n)), in_memory(header.fields[n].bytes));
        }
        return contents;
    };
    const bool one_layer = (header.effects & (EFFECT_WATER | EFFECT_SAND)) == (EFFECT_WATER | EFFECT_SAND);
    std::vector<std::pair<compute::Buffer, std::span<const std::byte>>> writes;
    std::size_t most_zeros = 0;
    const auto kept = state_.fields().kept();
    for (const auto& field : kept) {
        auto contents = find(field.name);
        if (contents.empty() && one_layer && field.name.starts_with("mixed_")) contents = find("water_" + field.name.substr(6));
        if (contents.empty()) most_zeros = std::max(most_zeros, in_memory(field.bytes));
        writes.emplace_back(state_.fields().buffer(field.name), contents);
    }
    const std::vector<std::byte> zeros(most_zeros);
    for (std::size_t n = 0; n < writes.size(); ++n) {
        const auto [buffer, contents] = writes[n];
        const auto bytes = contents.empty() ? std::span(zeros).first(in_memory(kept[n].bytes)) : contents;
        if (auto status = state_.device().write(buffer, 0, bytes); !status) return status;
    }
    return ok_status();
}

// What the world must be able to hold: no more than now where the snapshot's material asks for all of its effects.
Content Snapshots::content_for(const SnapshotHeader& header) const {
    Settings settings = state_.settings();
    settings.set_live(live_of(header));
    const auto now = effects_required(settings, state_.content);
    return now && (header.effects & ~now->mask) == 0 ? state_.content : content_under(header.effects) | state_.content;
}

Status Snapshots::load(std::span<const std::byte> from) {
    if (auto status = stepper_.finish_step(); !status) return status;
    auto header = read_header(from);
    if (!header) return header.status();
    if (auto status = check(*header); !status) return status;
    if (auto status = check_contents(*header, from, state_.settings()); !status) return status;
    const std::string unbooked = unbooked_text(drift_of(*header, from, state_.settings()), state_.settings().method);
    const std::string no_roll_back = "load: no memory to keep the state for roll-back";
    const auto write = [&] { return write_fields(*header, from); };
    if (auto status = stepper_.change(live_of(*header), content_for(*header), write); !status) return status;
    if (auto status = stepper_.go_to(header->totals); !status) return status;
    if (!unbooked.empty()) state_.tell(1, unbooked);
    keep_for_roll_back(no_roll_back);
    return state_.lost();
}

Result<Cost> Snapshots::cost(std::span<const std::byte> from) const {
    auto header = read_header(from);
    if (!header) return header.status();
    if (auto status = check(*header); !status) return status;
    Settings settings = state_.settings();
    settings.set_live(live_of(*header));
    auto effects = effects_required(settings, content_for(*header));
    if (!effects) return effects.status();
    constexpr std::uint64_t always = 1 << 20;
    std::uint64_t largest = 0; // of zeros, where the snapshot lacks a field
    for (const auto& field : header->fields) largest = std::max(largest, field.bytes);
    Cost cost;
    cost.cells = static_cast<std::uint64_t>(header->nx) * static_cast<std::uint64_t>(header->ny);
    cost.file_bytes = from.size();
    cost.host_bytes = from.size() + 4 * largest + always;
    cost.device_bytes = most_device_bytes(settings, effects->mask);
    cost.steps = header->totals.steps;
    return cost;
}

// The snapshot is loaded by now, whatever this comes to.
void Snapshots::keep_for_roll_back(const std::string& trouble) {
    try {
        if (auto status = roll_back_.restart(); status.code == Code::out_of_memory) state_.tell(1, trouble);
    } catch (const std::bad_alloc&) {
        state_.tell(1, trouble);
    }
}

Status Snapshots::make_buffers() {
    if (copies_ && recording_ == state_.fields().recording()) return ok_status();
    const auto label = [](const std::string& field) { return "save " + field; };
    std::vector<compute::BufferDesc> wanted;
    for (const auto& field : state_.fields().kept())
        wanted.push_back({field.bytes, label(field.name), compute::HostAccess::readback});
    copies_.reset();
    readback_.keep_only(wanted);
    if (auto status = readback_.keep_also(wanted); !status) return status;
    memory_.clear();
    for (const auto& field : state_.fields().kept()) memory_[field.name] = state_.device().mapped(readback_[label(field.name)]);
    recording_ = state_.fields().recording();
    copies_.emplace(state_, "save", [this, label](compute::ProgramBuilder& builder, const Parity& parity) {
        for (const auto& field : state_.fields().kept())
            builder.copy({state_.fields().buffer(field.name, parity), readback_[label(field.name)], 0, 0, field.bytes});
        return ok_status();
    });
    return ok_status();
}

Status Snapshots::submit_copies() {
    saved_ = header();
    auto ticket = copies_->submit();
    if (!ticket) return ticket.status();
    copied_ = *ticket;
    waits_for_ = Waits::device;
    return ok_status();
}

Result<std::uint64_t> Snapshots::begin_save() {
    if (!state_.lost()) return state_.lost();
    const bool at_work = waits_for_ == Waits::step || (waits_for_ == Waits::device && !state_.device().finished(copied_)) ||
                         (waits_for_ == Waits::worker && worker_.busy());
    if (at_work) return error(Code::not_ready, "begin_save: an earlier save is still in flight");
    waits_for_ = Waits::none;
    if (auto status = make_buffers(); !status) return status;
    ++ticket_;
    waits_for_ = Waits::step;
    if (stepper_.parts_done() > 0) return ticket_;
    if (auto status = at_boundary(); !status) return status;
    return ticket_;
}

Status Snapshots::at_boundary() {
    if (waits_for_ != Waits::step) return ok_status();
    auto status = make_buffers();
    if (status) status = submit_copies();
    if (!status) waits_for_ = Waits::none;
    return status;
}

Result<std::uint64_t> Snapshots::saved_bytes(std::uint64_t ticket) const {
    if (waits_for_ == Waits::none || ticket != ticket_)
        return error(Code::bad_argument, "end_save: ticket " + std::to_string(ticket) +
                                             " is not of the last begin_save, or its snapshot was fetched");
    return waits_for_ == Waits::step ? bytes() : saved_.bytes();
}

Status Snapshots::end_save(std::uint64_t ticket, std::span<std::byte> to) {
    auto bytes = saved_bytes(ticket);
    if (!bytes) return bytes.status();
    if (to.size() < *bytes) {
        return error(Code::bad_argument, "end_save: size is " + std::to_string(to.size()) + ", the snapshot needs " +
                                             std::to_string(*bytes) + " bytes");
    }
    // What the worker was given no loss of the device takes away.
    if (waits_for_ != Waits::worker && !state_.lost()) return state_.lost();
    if (waits_for_ == Waits::device && state_.device().finished(copied_)) {
        if (auto status = state_.device().wait(copied_); !status) return status;
        to_ = to.first(in_memory(*bytes));
        worker_.start([this] { assemble(); });
        waits_for_ = Waits::worker;
    } else if (waits_for_ == Waits::worker) {
        if (to.data() != to_.data()) return error(Code::bad_argument, "end_save: data differs from that of the earlier calls");
        if (!worker_.busy()) {
            waits_for_ = Waits::none;
            return ok_status();
        }
    }
    return error(Code::not_ready, "end_save: the snapshot is not finished; ask again later");
}

// On the worker's thread: touches nothing but the header, memory that the device has finished with, and the host's.
void Snapshots::assemble() {
    write_header(saved_, to_);
    for (std::size_t n = 0; n < saved_.fields.size(); ++n) {
        const auto& field = saved_.fields[n];
        std::memcpy(to_.data() + saved_.begin_of(n), memory_.at(field.name).data(), in_memory(field.bytes));
    }
    seal(to_);
}

} // namespace wadi
