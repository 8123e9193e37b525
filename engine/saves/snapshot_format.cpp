#include "engine/saves/snapshot_format.hpp"
#include "engine/settings/rules/checks.hpp"
#include "engine/settings/rules/effects.hpp"
#include "engine/settings/rules/material_keys.hpp"
#include <cstring>

namespace wadi {

namespace {

constexpr char magic[] = "WADISNAP";
constexpr std::size_t fields_at = 12, material_at = 80, name_bytes = 32, field_bytes = name_bytes + 8, total_bytes = 16;

// How many numbers of the material a version holds: keys are added ahead of those of lists, which are saturation's.
std::size_t material_numbers(std::uint32_t version) {
    return version == 4 ? 23 : version == 5 ? 27 : version == 6 ? 28 : material_keys().size();
}

// The key of a number that a version holds.
int material_key(std::uint32_t version, int number) {
    constexpr int of_lists = 3;
    const int numbers = static_cast<int>(material_numbers(version)), keys = static_cast<int>(material_keys().size());
    return number < numbers - of_lists ? number : number + keys - numbers;
}

constexpr std::uint32_t without_sources = 6; // the newest version

/// Which bit of the file choice n has: from the highest one down, so that effects that come later move none. Up to version 6, as in masks
/// then, behind the 16 effects that there were.
std::uint32_t bit_of_choice(std::uint32_t version, std::size_t n) { return version > 6 ? 0x80000000u >> n : 0x10000u << n; }
std::uint32_t bits_of_effects(std::uint32_t version) { return version > 6 ? all_effects : 0xffffu; }

std::uint32_t effects_to_file(std::uint32_t mask) {
    std::uint32_t bits = mask & all_effects;
    for (std::size_t n = 0; n < std::size(choice_rows); ++n)
        bits |= (mask & choice_rows[n].bit) != 0 ? bit_of_choice(snapshot_version, n) : 0;
    return bits;
}

/// None where the file has a bit that this library does not know.
std::optional<std::uint32_t> effects_of_file(std::uint32_t version, std::uint32_t bits) {
    std::uint32_t mask = bits & bits_of_effects(version);
    bits &= ~mask;
    for (std::size_t n = 0; n < std::size(choice_rows); ++n) {
        const std::uint32_t bit = bit_of_choice(version, n);
        mask |= (bits & bit) != 0 ? choice_rows[n].bit : 0;
        bits &= ~bit;
    }
    return bits == 0 ? std::optional(mask) : std::nullopt;
}

std::size_t fixed_bytes(std::uint32_t version) {
    return material_at + 8 * (material_numbers(version) + (version > without_sources ? 1 : 0));
}

std::uint64_t bytes_of_sources(const SnapshotHeader& header) {
    std::uint64_t bytes = 0;
    if (header.sources)
        for (const auto& source : *header.sources) bytes += source_bytes(source);
    return bytes;
}

} // namespace

std::uint64_t SnapshotHeader::begin_of(std::size_t field) const {
    std::uint64_t at =
        fixed_bytes(version) + bytes_of_sources(*this) + total_bytes * totals.inputs.size() + field_bytes * fields.size();
    for (std::size_t n = 0; n < field; ++n) at += fields[n].bytes;
    return at;
}

void write_header(const SnapshotHeader& header, std::span<std::byte> to) {
    begin_sealed(to.first(in_memory(header.bytes())), magic, snapshot_version);
    std::size_t at = fields_at;
    put(to, at, static_cast<std::uint32_t>(header.fields.size()));
    at = sealed_header_bytes;
    put(to, at, header.nx);
    put(to, at, header.ny);
    put(to, at, effects_to_file(header.effects));
    put(to, at, static_cast<std::uint32_t>(header.totals.inputs.size()));
    put(to, at, header.level);
    put(to, at, header.totals.steps);
    put(to, at, header.totals.sand_initial);
    put(to, at, header.totals.water_initial);
    for (int key = 0; key < static_cast<int>(material_keys().size()); ++key) put(to, at, material_value(header.material, key));
    put(to, at, std::uint64_t{header.sources ? 1 + header.sources->size() : 0});
    if (header.sources)
        for (const auto& source : *header.sources) put_source(to, at, source);
    for (const auto& total : header.totals.inputs) {
        put(to, at, total.metres);
        put(to, at, total.quanta);
    }
    for (const auto& field : header.fields) {
        char name[name_bytes] = {};
        field.name.copy(name, name_bytes - 1);
        std::memcpy(to.data() + at, name, name_bytes);
        at += name_bytes;
        put(to, at, field.bytes);
    }
}

Result<SnapshotHeader> read_header(std::span<const std::byte> snapshot) {
    const auto broken = [](const std::string& what) { return error(Code::bad_file, "snapshot: " + what); };
    const SealedVersions versions = {oldest_snapshot_version, snapshot_version};
    if (auto status = check_sealed("snapshot", snapshot, magic, versions, fixed_bytes(oldest_snapshot_version)); !status)
        return status;
    const std::uint64_t bytes = snapshot.size();
    SnapshotHeader header;
    header.version = sealed_version(snapshot);
    if (bytes < fixed_bytes(header.version)) return broken("it ends within its header");
    header.nx = get<std::int32_t>(snapshot, 32);
    header.ny = get<std::int32_t>(snapshot, 36);
    const auto effects = effects_of_file(header.version, get<std::uint32_t>(snapshot, 40));
    if (!effects) return broken("it has effects that this library does not know");
    header.effects = *effects;
    header.level = get<std::uint64_t>(snapshot, 48);
    header.totals = {get<std::uint64_t>(snapshot, 56), get<std::int64_t>(snapshot, 64), get<std::int64_t>(snapshot, 72), {}};
    const std::uint64_t totals = get<std::uint32_t>(snapshot, 44), fields = get<std::uint32_t>(snapshot, fields_at);
    std::size_t at = material_at;
    for (int n = 0; n < static_cast<int>(material_numbers(header.version)); ++n, at += 8)
        set_material_value(header.material, material_key(header.version, n), get<double>(snapshot, at));
    if (auto status = validate(header.material); !status) return broken(status.message);
    if (header.version > without_sources) {
        const auto sources = get<std::uint64_t>(snapshot, at);
        at += 8;
        if (sources > 0) header.sources.emplace();
        for (std::uint64_t n = 1; n < sources; ++n) {
            auto source = get_source(snapshot, at);
            if (!source) return broken("source " + std::to_string(n - 1) + " passes its end, or is none");
            header.sources->push_back(std::move(*source));
        }
    }
    if (at + totals * total_bytes + fields * field_bytes > bytes) return broken("its lists pass its end");
    for (std::uint64_t n = 0; n < totals; ++n, at += total_bytes)
        header.totals.inputs.push_back({get<double>(snapshot, at), get<double>(snapshot, at + 8)});
    std::uint64_t end = at + fields * field_bytes;
    for (std::uint64_t n = 0; n < fields; ++n, at += field_bytes) {
        const char* name = reinterpret_cast<const char*>(snapshot.data() + at);
        header.fields.push_back({std::string(name, strnlen(name, name_bytes)), get<std::uint64_t>(snapshot, at + name_bytes)});
        if (header.fields.back().bytes > bytes - end) return broken("field '" + header.fields.back().name + "' passes its end");
        end += header.fields.back().bytes;
    }
    if (end != bytes) return broken("bytes follow its last field");
    return header;
}

} // namespace wadi
