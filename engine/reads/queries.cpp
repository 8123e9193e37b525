#include "engine/reads/queries.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <new>

namespace wadi {

namespace {

enum { upload, points, samples, readback };
constexpr std::uint32_t least_capacity = 1024;

} // namespace

// Makes room for a batch, whole powers of two at a time.
Status Queries::reserve(Batch& batch, std::size_t place, std::uint32_t count) {
    if (count <= batch.capacity) return ok_status();
    batch.program.reset();
    for (const auto buffer : batch.buffers) state_.device().destroy_buffer(buffer);
    batch.buffers = {};
    batch.capacity = 0;
    const std::uint32_t capacity = std::max(least_capacity, std::bit_ceil(count));
    const std::uint64_t in = std::uint64_t{capacity} * 2 * sizeof(float),
                        out = std::uint64_t{capacity} * SAMPLE_FLOATS * sizeof(float);
    const std::string label = "query " + std::to_string(place);
    const compute::BufferDesc wanted[] = {{in, label + " upload", compute::HostAccess::upload},
                                          {in, label + " points"},
                                          {out, label + " samples"},
                                          {out, label + " readback", compute::HostAccess::readback}};
    for (std::size_t n = 0; n < batch.buffers.size(); ++n) {
        auto made = state_.device().create_buffer(wanted[n]);
        if (!made) return made.status();
        batch.buffers[n] = *made;
    }
    batch.capacity = capacity;
    const auto build = [this, &batch, in, out](compute::ProgramBuilder& builder, const Parity& parity) {
        const auto& b = batch.buffers;
        builder.copy({b[upload], b[points], 0, 0, in});
        auto status = state_.append_stage(builder, "sample_points", parity, {{"points", b[points]}, {"samples", b[samples]}},
                                          static_cast<int>(batch.capacity));
        builder.copy({b[samples], b[readback], 0, 0, out});
        return status;
    };
    batch.program = std::make_unique<StateProgram>(state_, "query", build);
    return ok_status();
}

Result<std::uint64_t> Queries::ask(std::span<const float> xy) {
    const std::size_t count = xy.size() / 2;
    if (count == 0 || count > most_points) {
        return error(Code::bad_argument,
                     "query: count is " + std::to_string(count) + ", allowed are 1 ... " + std::to_string(most_points));
    }
    const auto bad = std::find_if(xy.begin(), xy.end(), [](float x) { return !std::isfinite(x); });
    if (bad != xy.end())
        return error(Code::bad_argument, "query: xy of point " + std::to_string((bad - xy.begin()) / 2) + " is not finite");
    if (!state_.lost()) return state_.lost();
    const std::size_t place = (last_ticket_ + 1) % most_batches;
    Batch& batch = batches_[place];
    if (batch.ticket != 0 && (!batch.submitted || !state_.device().finished(batch.sampled)))
        return error(Code::not_ready, "query: " + std::to_string(most_batches) + " batches are under way");
    batch.ticket = 0;
    if (count > batch.capacity) {
        // Room for the next ones as well: eight calls in a row would otherwise take longer than later ones.
        for (std::size_t n = 0; n < batches_.size(); ++n) {
            if (batches_[n].ticket != 0) continue;
            if (auto status = reserve(batches_[n], n, static_cast<std::uint32_t>(count)); !status) return status;
        }
        record();
    }
    std::memcpy(state_.device().mapped(batch.buffers[upload]).data(), xy.data(), xy.size_bytes());
    batch.count = static_cast<std::uint32_t>(count);
    batch.submitted = false;
    if (stepper_.parts_done() == 0) {
        if (auto status = submit(batch); !status) return status;
    }
    batch.ticket = ++last_ticket_;
    return batch.ticket;
}

Status Queries::submit(Batch& batch) {
    StepInput input{};
    input.point_count = static_cast<int>(batch.count);
    auto ticket = batch.program->submit(input);
    if (!ticket) return ticket.status();
    batch.sampled = *ticket;
    batch.step = state_.steps;
    batch.submitted = true;
    return ok_status();
}

// For the host's next ones, as they come: all at once would make a promotion's step as much longer. Where that fails the batch's
// own submission says so.
void Queries::record() {
    try {
        for (const std::uint64_t next : {last_ticket_ + 1, last_ticket_ + 2}) {
            auto& batch = batches_[next % most_batches];
            if (batch.program) static_cast<void>(batch.program->record());
        }
    } catch (const std::bad_alloc&) { // as above
    }
}

Status Queries::at_boundary() {
    record();
    for (auto& batch : batches_) {
        if (batch.ticket == 0 || batch.submitted) continue;
        if (auto status = submit(batch); !status) return status;
    }
    return ok_status();
}

Result<Queries::Answer> Queries::answer(std::uint64_t ticket) {
    const Batch& batch = batches_[ticket % most_batches];
    if (ticket == 0 || batch.ticket != ticket) {
        return error(Code::bad_argument, "get_query: ticket " + std::to_string(ticket) +
                                             " is unknown or its answer gave way to " + std::to_string(most_batches) +
                                             " later batches");
    }
    if (!state_.lost()) return state_.lost();
    if (!batch.submitted || !state_.device().finished(batch.sampled))
        return error(Code::not_ready, "get_query: the answer is not there yet; ask again later");
    if (auto status = state_.device().wait(batch.sampled); !status) return status;
    const auto bytes = state_.device().mapped(batch.buffers[readback]);
    return Answer{
        {reinterpret_cast<const float*>(bytes.data()), std::size_t{batch.count} * SAMPLE_FLOATS}, batch.count, batch.step};
}

} // namespace wadi
