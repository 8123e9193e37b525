// Buffers: sizes, handles, ranges and round trips.
#include "tests/conformance/contracts.hpp"
#include <algorithm>
#include <limits>

namespace wadi::conformance {

namespace {

using compute::Buffer;
using compute::Device;

void sizes(Session&, Device& device, Expect& expect) {
    const std::uint64_t largest = device.capabilities().largest_buffer_bytes;
    expect.that(largest > 0, "largest_buffer_bytes is 0");
    const std::string allowed = "allowed on " + device.capabilities().name + " are 1 to " + std::to_string(largest);
    for (const std::uint64_t bytes : {std::uint64_t{0}, largest + 4, std::numeric_limits<std::uint64_t>::max()}) {
        const Status status = device.create_buffer({bytes, "odd"}).status();
        expect.refused(status, "size of buffer 'odd' is " + std::to_string(bytes) + " bytes", "create_buffer");
        expect.refused(status, allowed, "create_buffer");
    }
    for (const std::uint64_t bytes : {4u, 256u, 4100u}) {
        auto made = device.create_buffer({bytes, "small"});
        expect.ok(made.status(), "a buffer of " + std::to_string(bytes) + " bytes");
        if (made) device.destroy_buffer(*made);
    }
}

void zeros(Session&, Device& device, Expect& expect) {
    // Dirty memory first, so that a recycled block would show.
    const std::vector<std::uint32_t> ones(1u << 18, 0xFFFFFFFFu);
    const Buffer dirty = buffer_of(device, ones);
    expect.that(dirty.id != 0, "a buffer of 1 MiB cannot be made");
    device.destroy_buffer(dirty);
    auto made = device.create_buffer({ones.size() * 4, "zero"});
    expect.ok(made.status(), "create_buffer");
    if (!made) return;
    const auto words = words_of(device, *made, ones.size());
    expect.that(words == std::vector<std::uint32_t>(ones.size(), 0u), "a new buffer is not full of zeros");
    device.destroy_buffer(*made);
}

void round_trip(Session&, Device& device, Expect& expect) {
    // More than one chunk of any staging buffer, and a length that no alignment likes.
    std::vector<std::byte> sent(20'000'003), received(sent.size());
    for (std::size_t n = 0; n < sent.size(); ++n) sent[n] = static_cast<std::byte>(n * 2654435761u >> 13 & 0xFFu);
    auto made = device.create_buffer({sent.size() + 1, "round trip"});
    expect.ok(made.status(), "create_buffer");
    if (!made) return;
    expect.ok(device.write(*made, 1, sent), "write at an odd offset");
    expect.ok(device.read(*made, 1, received), "read at an odd offset");
    expect.that(received == sent, "what was read is not what was written");
    std::vector<std::byte> middle(7);
    expect.ok(device.read(*made, 9'999'998, middle), "read across the middle");
    expect.that(std::equal(middle.begin(), middle.end(), sent.begin() + 9'999'997), "a part read back is not the part written");
    expect.ok(device.write(*made, 0, {}), "write of no bytes");
    expect.ok(device.read(*made, sent.size() + 1, {}), "read of no bytes at the end");
    device.destroy_buffer(*made);
}

void ranges(Session&, Device& device, Expect& expect) {
    const Buffer buffer = buffer_of(device, std::vector<std::uint32_t>(16, 7u));
    std::vector<std::byte> bytes(8);
    constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
    for (const std::uint64_t offset : {std::uint64_t{57}, std::uint64_t{64}, std::uint64_t{65}, most - 3, most}) {
        const std::string words = "8 bytes at offset " + std::to_string(offset) + " reach past the 64 bytes of buffer 'test'";
        expect.refused(device.write(buffer, offset, bytes), "write: " + words, "write");
        expect.refused(device.read(buffer, offset, bytes), "read: " + words, "read");
    }
    expect.that(words_of(device, buffer, 16) == std::vector<std::uint32_t>(16, 7u), "a refused write changed the buffer");
    device.destroy_buffer(buffer);
}

void handles(Session&, Device& device, Expect& expect) {
    std::vector<std::byte> bytes(4);
    const Buffer gone = buffer_of(device, {1, 2, 3});
    device.destroy_buffer(gone);
    for (const Buffer buffer : {Buffer{}, Buffer{4'000'000'000u}, gone}) {
        const std::string words = buffer.id == 0 ? "the buffer is null" : "no buffer has the handle " + std::to_string(buffer.id);
        expect.refused(device.write(buffer, 0, bytes), "write: " + words, "write");
        expect.refused(device.read(buffer, 0, bytes), "read: " + words, "read");
        expect.refused(device.native(buffer).status(), "native: " + words, "native");
        device.destroy_buffer(buffer); // must do nothing
    }
    const Buffer fresh = buffer_of(device, {5, 6});
    expect.that(fresh.id != 0 && !(fresh == gone), "a destroyed handle was given out again");
    device.destroy_buffer(gone);
    expect.that(words_of(device, fresh, 2) == std::vector<std::uint32_t>{5, 6}, "destroying an old handle touched a new buffer");
    device.destroy_buffer(fresh);
}

void many(Session&, Device& device, Expect& expect) {
    std::vector<Buffer> buffers;
    for (std::uint32_t n = 0; n < 200; ++n) buffers.push_back(buffer_of(device, {n, ~n}));
    for (std::uint32_t n = 0; n < 200; n += 2) device.destroy_buffer(buffers[n]);
    for (std::uint32_t n = 1; n < 200; n += 2)
        expect.that(words_of(device, buffers[n], 2) == std::vector<std::uint32_t>{n, ~n},
                    "buffer " + std::to_string(n) + " of 200 lost its content");
    for (std::uint32_t n = 1; n < 200; n += 2) device.destroy_buffer(buffers[n]);
}

} // namespace

std::span<const Contract> buffer_contracts() {
    static constexpr Contract contracts[] = {
        {"buffer_sizes", sizes},   {"buffer_starts_zero", zeros}, {"buffer_round_trip", round_trip},
        {"buffer_ranges", ranges}, {"buffer_handles", handles},   {"many_buffers", many},
    };
    return contracts;
}

} // namespace wadi::conformance
