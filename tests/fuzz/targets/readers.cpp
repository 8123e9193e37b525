// libFuzzer: whatever bytes a reader gets, it returns a value or an error. One program per reader: -DTARGET=level, png, npy, asc,
// r16, snapshot or commands.
#include "backends/registry.hpp"
#include "engine/edits/command_log.hpp"
#include "engine/image/map.hpp"
#include "engine/level/level.hpp"
#include "engine/saves/sealed_bytes.hpp"
#include "engine/settings/rules/checks.hpp"
#include "engine/world.hpp"
#include <cmath>
#include <cstdlib>
#include <memory>

using namespace wadi;

namespace {

using Bytes = std::vector<std::uint8_t>;

/// A level whose map is itself: every key that names a file is read too.
[[maybe_unused]] void level(const Bytes& bytes) {
    const FileReader files = [&](const std::string&, std::uint64_t) -> Result<Bytes> { return bytes; };
    LevelOverrides overrides;
    overrides.size = {8, 6};
    const auto parsed = parse_level(std::string(bytes.begin(), bytes.end()), files, overrides);
    if (parsed && !validate(parsed->settings)) std::abort(); // what the loader takes, a world must take
}

template <class Decode> void map(const Bytes& bytes, Decode decode) {
    const auto decoded = decode(bytes);
    if (!decoded) return;
    if (decoded->values.size() != static_cast<std::size_t>(decoded->nx) * static_cast<std::size_t>(decoded->ny)) std::abort();
    for (const float value : decoded->values)
        if (!std::isfinite(value)) std::abort();
    static_cast<void>(resample(*decoded, 7, 5));
    for (const Holes how : {Holes::outside, Holes::wall, Holes::pit}) {
        Map raised = *decoded;
        raise_holes(raised, how, 1);
        resample_map(raised, 5, 7);
        if (!raised.holes.empty() && raised.holes.size() != 35) std::abort();
    }
}
[[maybe_unused]] void png(const Bytes& bytes) {
    map(bytes, [](const Bytes& b) { return decode_png(b, "fuzz.png"); });
    map(bytes, [](const Bytes& b) { return decode_png(b, "fuzz.png", nullptr, Packing::terrarium); });
}
[[maybe_unused]] void npy(const Bytes& bytes) {
    map(bytes, [](const Bytes& b) { return decode_npy(b, "fuzz.npy"); });
}
[[maybe_unused]] void asc(const Bytes& bytes) {
    map(bytes, [](const Bytes& b) { return decode_asc(b, "fuzz.asc"); });
}
[[maybe_unused]] void r16(const Bytes& bytes) {
    map(bytes, [](const Bytes& b) { return decode_r16(b, "fuzz.r16", std::nullopt); });
    map(bytes, [](const Bytes& b) { return decode_raw(b, "fuzz.raw", std::nullopt); });
    map(bytes, [](const Bytes& b) { return decode_r32(b, "fuzz.r32", std::nullopt); });
    map(bytes, [](const Bytes& b) { return decode_hgt(b, "N46E007.hgt"); });
}

World& small_world() {
    static const auto world = [] {
        Settings settings;
        settings.grid = {5, 4, 0.5};
        settings.dt = 0.02;
        InitialFields fields;
        fields.water.assign(20, 0.5F);
        auto device = backends::open_device("cpu", 0, {});
        auto made =
            device ? World::create(settings, fields, std::move(*device)) : Result<std::unique_ptr<World>>(device.status());
        if (!made) std::abort();
        return std::move(*made);
    }();
    return *world;
}

/// The sum is mended, so that what lies behind it is reached.
std::vector<std::byte> resealed(const Bytes& bytes) {
    std::vector<std::byte> copy(bytes.size());
    if (!bytes.empty()) std::memcpy(copy.data(), bytes.data(), bytes.size());
    if (copy.size() < sealed_header_bytes) return copy;
    std::size_t at = 16;
    put(std::span<std::byte>(copy), at, std::uint64_t{copy.size()});
    seal(copy);
    return copy;
}
/// A whole file, changed as the bytes say: by sixes, where (2 bytes) and to what (4).
Bytes changed(std::span<const std::byte> whole, const Bytes& bytes) {
    Bytes file(whole.size());
    std::memcpy(file.data(), whole.data(), whole.size());
    for (std::size_t n = 0; n + 6 <= bytes.size(); n += 6) {
        const std::size_t at = (bytes[n] + 256U * bytes[n + 1]) % file.size();
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(n + 2), std::min<std::size_t>(4, file.size() - at),
                    file.begin() + static_cast<std::ptrdiff_t>(at));
    }
    return file;
}
bool begins_with(const Bytes& bytes, const char (&name)[9]) {
    return bytes.size() >= 8 && std::memcmp(bytes.data(), name, 8) == 0;
}

[[maybe_unused]] void snapshot(const Bytes& bytes) {
    World& world = small_world();
    static const auto whole = [&] {
        std::vector<std::byte> saved(world.snapshots().bytes());
        if (!world.snapshots().save(saved)) std::abort();
        return saved;
    }();
    const auto sealed = resealed(begins_with(bytes, "WADISNAP") ? bytes : changed(whole, bytes));
    if (world.snapshots().load(sealed) && !world.step(1)) std::abort();
}
[[maybe_unused]] void commands(const Bytes& bytes) {
    static const auto whole = [] {
        auto& log = small_world().commands();
        log.remember(true);
        Edit edit;
        edit.x0 = edit.y0 = edit.radius = edit.amount = 0.5;
        SourceChange tap;
        tap.source.radius = 0.5;
        tap.source.rate.samples = {{0, 0.1}, {1, 0}};
        const bool noted = log.edit({&edit, 1}) && log.set_source(tap) &&
                           log.write_region(EditLayer::sand, {0, 0, 2, 1}, std::vector<float>(2, 0.25F)) &&
                           log.set_material(0, 999) && log.trim();
        if (!noted) std::abort();
        auto written = log.bytes();
        log.remember(false);
        return written;
    }();
    const auto sealed = resealed(begins_with(bytes, "WADICMDS") ? bytes : changed(whole, bytes));
    const auto list = read_commands(sealed);
    if (list) { // what is read is written again as it was
        const auto written = write_commands(list->level, list->stamps, list->commands);
        if (!read_commands(written)) std::abort();
    }
    static_cast<void>(small_world().commands().play(sealed));
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    TARGET(Bytes(data, data + size));
    return 0;
}
