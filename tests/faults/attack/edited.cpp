// Saves and command logs that a player edited and whose checksum is right again: each is refused in words with the world as it
// was, or taken and then harmless.
#include "engine/saves/sealed_bytes.hpp"
#include "tests/faults/attack/attack.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace attack {
namespace {

using Bytes = std::vector<unsigned char>;

/// The checksum is the header's last word, and counts as 0 while it is computed.
void mend(Bytes& bytes) { wadi::seal(std::as_writable_bytes(std::span(bytes))); }

/// Bytes, words and numbers at one to four places, none of them in name and version, which say what it is.
void edit(Bytes& bytes, std::mt19937& random) {
    constexpr float floats[] = {
        std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1, 1e30F, -1e9F, 1e-40F, 17, 1e5F};
    const auto any = [&](std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random); };
    for (std::size_t change = 0, changes = 1 + any(4); change < changes; ++change) {
        // Half of them in the header and the tables behind it.
        const std::size_t size = any(2) == 0 ? std::min<std::size_t>(bytes.size(), 700) : bytes.size(), at = 16 + any(size - 24);
        const float number = floats[any(std::size(floats))];
        const double wide = static_cast<double>(number);
        const std::uint64_t word = any(2) == 0 ? ~std::uint64_t{0} >> any(64) : any(300);
        switch (any(4)) {
        case 0:
            bytes[at] = static_cast<unsigned char>(any(256));
            break;
        case 1:
            std::memcpy(&bytes[at / 4 * 4], &number, sizeof number);
            break;
        case 2:
            std::memcpy(&bytes[at / 8 * 8], &wide, sizeof wide);
            break;
        default:
            std::memcpy(&bytes[at / 8 * 8], &word, sizeof word);
            break;
        }
    }
    mend(bytes);
}

bool harmless(wadi_world_id world) {
    auto stats = wadi_default_world_stats();
    return wadi_world_step(world, 3) == WADI_OK && wadi_world_get_stats(world, &stats) == WADI_OK && stats.not_finite == 0 &&
           stats.smallest_depth >= 0;
}

std::uint64_t hash_of(wadi_world_id world) {
    std::uint64_t hash = 0;
    expect(wadi_world_get_hash(world, &hash) == WADI_OK, "hash");
    return hash;
}

template <class Call> Bytes bytes_by(const Call& call) {
    size_t size = 0;
    expect(call(nullptr, &size) == WADI_OK, "a size");
    Bytes bytes(size);
    expect(call(bytes.data(), &size) == WADI_OK, "its bytes");
    return bytes;
}

} // namespace

int edited(int count) {
    wadi_world_id world{};
    if (!expect(make(16, world) == WADI_OK, "create")) return wrong;
    const auto sand = brush(WADI_LAYER_SAND), water = brush(WADI_LAYER_WATER);
    const float cells[4] = {0.5F, 0.25F, 0, 1};
    const wadi_region region = {2, 3, 2, 2};
    expect(wadi_world_set_command_log(world, 1) == WADI_OK && wadi_world_edit(world, &sand, 1) == WADI_OK &&
               wadi_world_step(world, 2) == WADI_OK && wadi_world_edit(world, &water, 1) == WADI_OK &&
               wadi_world_set_material(world, "friction", 0.61) == WADI_OK &&
               wadi_world_write_region(world, WADI_FIELD_SAND_DEPTH, &region, cells, 4) == WADI_OK &&
               wadi_world_step(world, 3) == WADI_OK,
           "a world to edit");
    const Bytes snapshot = bytes_by([&](void* data, size_t* size) { return wadi_world_save(world, data, size); });
    const Bytes log = bytes_by([&](void* data, size_t* size) { return wadi_world_get_commands(world, data, size); });
    std::mt19937 random(20);
    int taken[2] = {}, refused[2] = {};
    const auto ask = [&](const std::string& name, int kind, wadi_world_id of, const auto& call, std::uint64_t before) {
        const auto answer = call();
        const std::string why = wadi_get_last_error();
        if (answer == WADI_OK) {
            ++taken[kind];
            expect(harmless(of), name + " is taken, and does harm");
            return;
        }
        ++refused[kind];
        expect(answer == WADI_ERROR_BAD_FILE || answer == WADI_ERROR_BAD_ARGUMENT, name + ": answered " + std::to_string(answer));
        expect(!why.empty() && why.find("checksum") == std::string::npos && why.find("changed") == std::string::npos,
               name + ": told by its contents, not its checksum: " + why);
        expect(hash_of(of) == before, name + ": refused, and the world is as it was");
    };
    for (int n = 0; n < count; ++n) {
        Bytes bytes = snapshot;
        edit(bytes, random);
        const std::uint64_t before = hash_of(world);
        ask(
            "edited save " + std::to_string(n), 0, world, [&] { return wadi_world_load(world, bytes.data(), bytes.size()); },
            before);
        bytes = log;
        edit(bytes, random);
        wadi_world_id player{};
        if (!expect(make(16, player) == WADI_OK, "a world that plays")) break;
        const std::uint64_t fresh = hash_of(player);
        ask(
            "edited log " + std::to_string(n), 1, player,
            [&] { return wadi_world_play_commands(player, bytes.data(), bytes.size()); }, fresh);
        wadi_destroy_world(player);
    }
    std::printf("edited saves: %d taken, %d refused; edited logs: %d taken, %d refused\n", taken[0], refused[0], taken[1],
                refused[1]);
    for (int kind = 0; kind < 2; ++kind)
        expect(taken[kind] > count / 20 && refused[kind] > count / 20, "neither answer is the only one");
    // Controls: what was not edited is taken, and a seal is asked for at all.
    Bytes bytes = snapshot;
    mend(bytes);
    expect(bytes == snapshot, "the seal is the library's");
    bytes.back() = static_cast<unsigned char>(bytes.back() ^ 1U);
    expect(wadi_world_load(world, bytes.data(), bytes.size()) == WADI_ERROR_BAD_FILE, "a change without its checksum is refused");
    expect(wadi_world_load(world, snapshot.data(), snapshot.size()) == WADI_OK, "the save itself is taken");
    wadi_destroy_world(world);
    return wrong;
}

} // namespace attack
