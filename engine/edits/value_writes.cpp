#include "engine/edits/value_writes.hpp"
#include "engine/settings/rules/effects.hpp"
#include "engine/step/run/step_number.hpp"
#include <cstring>

namespace wadi {

using MemoryKind = compute::NativeBuffer::Kind;

ValueWrites::ValueWrites(WorldState& state, Stepper& stepper)
    : state_(state), stepper_(stepper),
      program_(state, "written values", [this](compute::ProgramBuilder& builder, const Parity& parity) {
          return state_.append_stage(builder, "write_values", parity, {{"written_values", values_}});
      }) {}

void ValueWrites::free_all() {
    program_.forget();
    for (Upload& each : uploads_) {
        state_.device().destroy_program(each.program);
        state_.device().destroy_buffer(each.memory);
        each = {};
    }
    state_.device().destroy_buffer(values_);
    values_ = {};
    room_ = 0;
}

Status ValueWrites::make_room(std::uint64_t numbers) {
    if (numbers <= room_) return ok_status();
    free_all();
    auto made = state_.device().create_buffer({numbers * 4, "written values"});
    if (!made) return made.status();
    values_ = *made;
    room_ = numbers;
    return ok_status();
}

Status ValueWrites::make_upload(Upload& upload) {
    if (upload.program.id != 0) return ok_status();
    if (upload.memory.id == 0) {
        auto made = state_.device().create_buffer({room_ * 4, "written values of the host", compute::HostAccess::upload});
        if (!made) return made.status();
        upload.memory = *made;
    }
    compute::ProgramBuilder builder("values of the host");
    builder.copy({upload.memory, values_, 0, 0, room_ * 4});
    auto compiled = state_.device().compile(builder, state_.params());
    if (compiled) upload.program = *compiled;
    return compiled.status();
}

Status ValueWrites::upload(const Region& region, const ValueSource& from) {
    Upload& upload = uploads_[next_];
    if (auto status = make_upload(upload); !status) return status;
    if (auto status = state_.device().wait(upload.ticket); !status) return status;
    const auto* rows = reinterpret_cast<const std::byte*>(static_cast<std::uintptr_t>(from.handle)) + from.offset;
    std::byte* to = state_.device().mapped(upload.memory).data();
    const std::size_t row = static_cast<std::size_t>(region.nx) * 4;
    for (std::size_t n = 0; n < static_cast<std::size_t>(region.ny); ++n)
        std::memcpy(to + n * row, rows + n * from.row_pitch, row);
    auto ticket = state_.device().submit(upload.program, {});
    if (!ticket) return ticket.status();
    upload.ticket = *ticket;
    next_ = (next_ + 1) % uploads_.size();
    return ok_status();
}

Status ValueWrites::bring(const Region& region, const ValueSource& from) {
    if (from.kind == MemoryKind::host_pointer) return upload(region, from);
    const compute::HostRows rows{from.handle, from.offset, from.row_pitch, static_cast<std::uint32_t>(region.nx),
                                 static_cast<std::uint32_t>(region.ny)};
    return (*state_.device()).host_sync()->copy_from(rows, values_).status(); // of a front end: never null
}

// Fields are memory of the device's own API, whatever lends outputs.
Status ValueWrites::check_kind(MemoryKind kind) const {
    auto own = (*state_.device()).native(state_.fields().buffer("terrain"));
    if (!own) return own.status();
    if (kind == MemoryKind::host_pointer || kind == own->kind) return ok_status();
    constexpr const char* names[] = {"HOST_POINTER", "VULKAN_BUFFER", "CUDA_POINTER"};
    const auto name = [&](MemoryKind k) { return std::string(names[static_cast<std::size_t>(k)]); };
    return error(Code::bad_argument, "values.handle_kind is " + name(kind) + "; a world of the backend " +
                                         (*state_.device()).capabilities().backend + " takes HOST_POINTER" +
                                         (own->kind == MemoryKind::host_pointer ? "" : " and " + name(own->kind)));
}

Status ValueWrites::write(EditLayer layer, const Region& region, const ValueSource& from) {
    if (auto status = check_kind(from.kind); !status) return status;
    const Content brought{layer == EditLayer::sand, layer == EditLayer::water};
    if (auto status = check_allowed(state_.settings(), brought); !status) return status;
    if (auto status = make_room(region.cells()); !status) return status;
    if (auto status = bring(region, from); !status) return status;
    const Content content{state_.content.sand || brought.sand, state_.content.water || brought.water};
    if (content != state_.content) {
        if (auto status = stepper_.set_content(content); !status) return status;
    }
    if (recorded_with_ != state_.settings().material) {
        program_.forget();
        recorded_with_ = state_.settings().material;
    }
    StepInput input{};
    input.step = stage_step(state_.steps);
    cover(region, input.edit[0]);
    input.edit[0].layer = static_cast<int>(layer);
    if (auto ticket = program_.submit(input); !ticket) return ticket.status();
    constexpr int margin = 2; // as the stages look
    state_.tiles().wake(region.i0 - margin, region.j0 - margin, region.i0 + region.nx + margin, region.j0 + region.ny + margin);
    return ok_status();
}

} // namespace wadi
