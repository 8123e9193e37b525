// What a host shares with a device: memory that both touch, native handles, semaphores and command buffers.
#include "tests/conformance/contracts.hpp"
#include <algorithm>
#include <array>
#include <cstring>

namespace wadi::conformance {

namespace {

using compute::Buffer;
using compute::Device;
using compute::HostAccess;
using compute::NativeBuffer;
using compute::ProgramBuilder;

Buffer host_buffer(Device& device, HostAccess access, std::uint64_t bytes, Expect& expect) {
    auto made = device.create_buffer({bytes, "shared with the host", access});
    expect.ok(made.status(), "create_buffer for the host");
    return made ? *made : Buffer{};
}

// Three submissions in flight, each with memory of its own, several times over: what the host wrote ahead of submit() comes back.
void host_round_trip(Session&, Device& device, Expect& expect) {
    constexpr std::size_t words = 20'001, lanes = 3;
    struct Lane {
        Buffer up, device, down;
        compute::Program program;
        compute::Ticket ticket;
    };
    std::array<Lane, lanes> all;
    for (Lane& lane : all) {
        lane.up = host_buffer(device, HostAccess::upload, words * 4, expect);
        lane.down = host_buffer(device, HostAccess::readback, words * 4, expect);
        lane.device = buffer_of(device, std::vector<std::uint32_t>(words, 0));
        ProgramBuilder builder("host round trip");
        builder.copy({lane.up, lane.device, 0, 0, words * 4});
        builder.copy({lane.device, lane.down, 0, 4, (words - 1) * 4});
        auto program = device.compile(builder, small_params());
        expect.ok(program.status(), "compile");
        if (!program) return;
        lane.program = *program;
        expect.that(device.mapped(lane.up).size() == words * 4 && device.mapped(lane.down).size() == words * 4,
                    "mapped() has not the buffer's size");
        if (device.mapped(lane.up).size() != words * 4 || device.mapped(lane.down).size() != words * 4) return;
        const auto zero = device.mapped(lane.down);
        expect.that(std::all_of(zero.begin(), zero.end(), [](std::byte b) { return b == std::byte{0}; }),
                    "a new buffer for the host is not full of zeros");
    }
    const auto word_of = [](std::size_t n, std::size_t turn, std::size_t lane) {
        return static_cast<std::uint32_t>(n * 2654435761u + turn * 97u + lane * 7919u);
    };
    for (std::size_t turn = 0; turn < 4; ++turn) {
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            auto* to = reinterpret_cast<std::uint32_t*>(device.mapped(all[lane].up).data());
            for (std::size_t n = 0; n < words; ++n) to[n] = word_of(n, turn, lane);
            auto ticket = device.submit(all[lane].program, StepInput{});
            expect.ok(ticket.status(), "submit");
            if (!ticket) return;
            all[lane].ticket = *ticket;
        }
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            expect.ok(device.wait(all[lane].ticket), "wait");
            const auto* from = reinterpret_cast<const std::uint32_t*>(device.mapped(all[lane].down).data());
            bool same = true;
            for (std::size_t n = 1; n < words; ++n) same &= from[n] == word_of(n - 1, turn, lane);
            expect.that(same && from[0] == 0, "what came back is not what the host wrote");
        }
    }
    for (const Lane& lane : all) {
        device.destroy_program(lane.program);
        for (const Buffer buffer : {lane.up, lane.device, lane.down}) device.destroy_buffer(buffer);
    }
}

void host_memory_only_copies(Session&, Device& device, Expect& expect) {
    const FieldLayout layout{small_params().nx, small_params().ny};
    const Buffer shared = host_buffer(device, HostAccess::upload, layout.size() * 4, expect);
    const Buffer field = buffer_of(device, std::vector<std::uint32_t>(layout.size(), 0));
    const Buffer ledger =
        buffer_of(device, std::vector<std::uint32_t>(
                              std::size_t{2 * LEDGER_ENTRIES} * static_cast<std::size_t>(layout.strips() * layout.pitch()), 0));
    ProgramBuilder fill("fill");
    fill.fill({shared, 1});
    const std::string words = "buffer 'shared with the host' is the host's memory, which only copies may use";
    expect.refused(device.compile(fill, small_params()).status(), "program 'fill', fill: " + words, "a fill");
    auto dispatch = rain_dispatch(device, shared, field, ledger);
    expect.ok(dispatch.status(), "create_pipeline");
    if (!dispatch) return;
    ProgramBuilder rain("rain");
    rain.dispatch(*dispatch);
    expect.refused(device.compile(rain, small_params()).status(),
                   "program 'rain', dispatch 'rain' of apply_rain, terrain: " + words, "a dispatch");
    expect.that(device.mapped(field).empty(), "mapped() gives a buffer that is not the host's");
    device.destroy_buffer(shared);
    for (const Buffer gone : {Buffer{}, shared, Buffer{4'000'000'000u}})
        expect.that(device.mapped(gone).empty(), "mapped() gives a buffer that does not exist");
    device.destroy_buffer(field);
    device.destroy_buffer(ledger);
}

void native_handles(Session&, Device& device, Expect& expect) {
    const Buffer one = buffer_of(device, {1, 2}), other = buffer_of(device, {3, 4, 5});
    auto first = device.native(one), second = device.native(other);
    expect.ok(first.status(), "native");
    expect.ok(second.status(), "native");
    if (!first || !second) return;
    expect.that(first->bytes == 8 && second->bytes == 12, "native() gives another size");
    expect.that(first->handle != 0 && first->handle != second->handle, "native() gives no handle of its own");
    if (first->kind == NativeBuffer::Kind::host_pointer) {
        std::uint32_t words[3];
        std::memcpy(words, reinterpret_cast<const void*>(second->handle), sizeof words);
        expect.that(words[0] == 3 && words[2] == 5, "the address does not hold the buffer");
    }
    device.destroy_buffer(one);
    device.destroy_buffer(other);
}

// Null semaphores, events, images and command buffers. The working of both is shown by samples/vulkan_host_minimal.
void host_sync_refusals(Session&, Device& device, Expect& expect) {
    compute::HostSync* sync = device.host_sync();
    expect.that(sync != nullptr, "the front end has no host_sync()");
    if (sync == nullptr) return;
    expect.ok(sync->wait_before({}), "waiting for nothing");
    const std::array<compute::SyncPoint, 1> null = {};
    expect.refused(sync->wait_before(null), "wait_before: the semaphore is null", "wait_before");
    expect.refused(sync->signal_after(null[0]), "signal_after: the semaphore is null", "signal_after");
    expect.refused(sync->begin_recording(nullptr, null[0]), "begin_recording: the semaphore is null", "begin_recording");
    expect.refused(sync->begin_recording(nullptr, {1, 1}), "begin_recording: the command buffer is null", "begin_recording");
    expect.refused(sync->end_recording(), "end_recording: no recording is under way", "end_recording");
    expect.refused(sync->wait_event(nullptr), "wait_event: the event is null", "wait_event");
    expect.refused(sync->record_event(nullptr), "record_event: the event is null", "record_event");
    const Buffer buffer = buffer_of(device, {9});
    const compute::BufferRows one{.buffer = buffer, .row_pitch = 4, .texel_bytes = 4, .width = 1, .height = 1};
    const auto copied = [&](auto change) {
        auto rows = one;
        change(rows);
        return sync->copy_to_image(rows, {.image = 1}).status();
    };
    expect.refused(sync->copy_to_image(one, {}).status(), "copy_to_image: the image is null", "copy_to_image");
    expect.refused(copied([](auto& r) { r.width = 2; }), "copy_to_image: rows of 2 texels of 4 bytes, 1 of them 4 bytes apart",
                   "a row");
    expect.refused(copied([](auto& r) { r.row_pitch = 6; }), "copy_to_image: rows of 1 texels of 4 bytes, 1 of them 6 bytes",
                   "a pitch");
    expect.refused(copied([](auto& r) { r.height = 2; }), "copy_to_image", "a row beyond the buffer");
    expect.refused(copied([](auto& r) { r.buffer = {4'000'000'000u}; }), "copy_to_image", "no buffer");
    expect.that(copied([](auto&) {}).code == Code::not_supported, "a device of its own copies into a host's image");
    const compute::HostRows rows{.handle = 1, .row_pitch = 4, .width = 1, .height = 1};
    auto wrong = rows;
    wrong.handle = 0;
    expect.refused(sync->copy_from(wrong, buffer).status(), "copy_from: the handle is null", "copy_from");
    wrong = rows;
    wrong.offset = 2;
    expect.refused(sync->copy_from(wrong, buffer).status(), "copy_from: rows of 1 numbers", "an offset");
    wrong = rows;
    wrong.height = 2;
    expect.refused(sync->copy_from(wrong, buffer).status(), "copy_from", "rows beyond the buffer");
    expect.that(words_of(device, buffer, 1) == std::vector<std::uint32_t>{9}, "a refused recording stops the queue");
    device.destroy_buffer(buffer);
}

} // namespace

std::span<const Contract> host_contracts() {
    static constexpr Contract contracts[] = {
        {"host_round_trip", host_round_trip},
        {"host_memory_only_copies", host_memory_only_copies},
        {"native_handles", native_handles},
        {"host_sync_refusals", host_sync_refusals},
    };
    return contracts;
}

} // namespace wadi::conformance
