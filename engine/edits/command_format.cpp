// A command log as bytes. Little-endian, version 3, behind the header of sealed_bytes.hpp:
//     12  u32      number of stamps
//     32  u64      digest of the level's settings
//     40  u64      number of commands
//     48  per stamp: i32[2] pixels along x and y, f32 values
//      .  per command: u32 kind, u32 layer, u64 step, then
//         edit:   u32 kind, capsule, stamp, player; f64 x0, y0, x1, y1, radius, softness, amount, strength, velocity x, y
//         region: i32 i0, j0, nx, ny; f32 values
//         source: u32 index, player; then source_format.hpp
//         material: u32 number, 0; f64 value. The number is the index in material_keys(), but from `list_numbers` on it counts
//         the keys of lists (saturation), which come last there: a key that is new moves no number. Version 2 had the index among
//         its 23 keys.
#include "engine/edits/command_log.hpp"
#include "engine/saves/sealed_bytes.hpp"
#include "engine/saves/source_format.hpp"
#include "engine/settings/rules/material_keys.hpp"

namespace wadi {

namespace {

constexpr char magic[] = "WADICMDS";
constexpr std::uint32_t version = 3, oldest_version = 2;
constexpr int list_keys = 3, list_numbers = 0x10000;
constexpr std::size_t stamps_at = 12, lists_at = 48;
enum class Kind : std::uint32_t { edit, region, trim, material, source };

constexpr double Edit::*numbers[] = {&Edit::x0,       &Edit::y0,     &Edit::x1,       &Edit::y1,         &Edit::radius,
                                     &Edit::softness, &Edit::amount, &Edit::strength, &Edit::velocity_x, &Edit::velocity_y};

class Writer {
  public:
    template <class T> void add(T value) {
        std::size_t at = bytes.size();
        bytes.resize(at + sizeof value);
        put(std::span<std::byte>(bytes), at, value);
    }
    void floats(std::span<const float> values) {
        const auto raw = std::as_bytes(values);
        bytes.insert(bytes.end(), raw.begin(), raw.end());
    }
    void add(const Source& source) {
        std::size_t at = bytes.size();
        bytes.resize(at + static_cast<std::size_t>(source_bytes(source)));
        put_source(bytes, at, source);
    }
    std::vector<std::byte> bytes;
};

// Reads on from a place; past the end everything is 0 and `whole` false.
class Reader {
  public:
    Reader(std::span<const std::byte> bytes, std::size_t at) : bytes_(bytes), at_(at) {}
    template <class T> T next() {
        if (!has(1, sizeof(T))) return T{};
        at_ += sizeof(T);
        return get<T>(bytes_, at_ - sizeof(T));
    }
    std::vector<float> floats(std::int64_t count) {
        if (count <= 0 || !has(static_cast<std::uint64_t>(count), sizeof(float)))
            return {}; // memcpy takes no null, whatever the size
        std::vector<float> values(static_cast<std::size_t>(count));
        std::memcpy(values.data(), bytes_.data() + at_, values.size() * sizeof(float));
        at_ += values.size() * sizeof(float);
        return values;
    }
    Source source() {
        auto found = whole_ ? get_source(bytes_, at_) : std::nullopt;
        whole_ = found.has_value();
        return found.value_or(Source{});
    }
    bool whole() const { return whole_; }
    bool at_end() const { return at_ == bytes_.size(); }

  private:
    bool has(std::uint64_t count, std::uint64_t each) {
        whole_ = whole_ && count <= (bytes_.size() - at_) / each;
        return whole_;
    }
    std::span<const std::byte> bytes_;
    std::size_t at_;
    bool whole_ = true;
};

void write(Writer& to, Kind kind, EditLayer layer, std::uint64_t step) {
    to.add(kind);
    to.add(static_cast<std::uint32_t>(layer));
    to.add(step);
}

void write(Writer& to, const Edit& edit) {
    write(to, Kind::edit, edit.layer, edit.step);
    to.add(static_cast<std::uint32_t>(edit.kind));
    to.add(std::uint32_t{edit.capsule});
    to.add(edit.stamp);
    to.add(edit.player);
    for (const auto number : numbers) to.add(edit.*number);
}

void write(Writer& to, const RegionWrite& region) {
    write(to, Kind::region, region.layer, region.step);
    for (const int n : {region.region.i0, region.region.j0, region.region.nx, region.region.ny}) to.add(n);
    to.floats(region.values);
}

void write(Writer& to, const Trim& trim) { write(to, Kind::trim, EditLayer::terrain, trim.step); }

// Index of the first key of lists among `keys` of them.
constexpr int first_of_lists(std::size_t keys) { return static_cast<int>(keys) - list_keys; }

void write(Writer& to, const MaterialChange& change) {
    write(to, Kind::material, EditLayer::terrain, change.step);
    const int past = change.key - first_of_lists(material_keys().size());
    to.add(static_cast<std::uint32_t>(past < 0 ? change.key : list_numbers + past));
    to.add(std::uint32_t{0});
    to.add(change.value);
}

void write(Writer& to, const SourceChange& change) {
    write(to, Kind::source, EditLayer::terrain, change.step);
    to.add(change.index);
    to.add(change.player);
    to.add(change.source);
}

Edit read_edit(Reader& from, EditLayer layer, std::uint64_t step) {
    Edit edit;
    edit.layer = layer;
    edit.step = step;
    edit.kind = static_cast<EditKind>(from.next<std::uint32_t>() % 3);
    edit.capsule = from.next<std::uint32_t>() != 0;
    edit.stamp = from.next<std::uint32_t>();
    edit.player = from.next<std::uint32_t>();
    for (const auto number : numbers) edit.*number = from.next<double>();
    return edit;
}

RegionWrite read_region(Reader& from, EditLayer layer, std::uint64_t step) {
    RegionWrite write{step, layer, {}, {}};
    for (int* n : {&write.region.i0, &write.region.j0, &write.region.nx, &write.region.ny}) *n = from.next<std::int32_t>();
    write.values = from.floats(std::int64_t{write.region.nx} * write.region.ny);
    return write;
}

MaterialChange read_material(Reader& from, std::uint32_t of_version, std::uint64_t step) {
    constexpr std::size_t keys_of_2 = 23;
    MaterialChange change{step, 0, 0};
    const std::uint32_t number = from.next<std::uint32_t>();
    const int lists = of_version == 2 ? first_of_lists(keys_of_2) : list_numbers,
              scalars = first_of_lists(material_keys().size());
    const bool of_list = number >= static_cast<std::uint32_t>(lists);
    change.key = of_list ? scalars + static_cast<int>((number - static_cast<std::uint32_t>(lists)) % std::uint32_t{list_keys})
                         : static_cast<int>(number % static_cast<std::uint32_t>(scalars));
    from.next<std::uint32_t>();
    change.value = from.next<double>();
    return change;
}

SourceChange read_source(Reader& from, std::uint64_t step) {
    SourceChange change;
    change.step = step;
    change.index = from.next<std::uint32_t>();
    change.player = from.next<std::uint32_t>();
    change.source = from.source();
    return change;
}

} // namespace

std::vector<std::byte> write_commands(std::uint64_t level, std::span<const Stamp> stamps, std::span<const Command> commands) {
    Writer to;
    to.bytes.resize(sealed_header_bytes);
    to.add(level);
    to.add(std::uint64_t{commands.size()});
    for (const auto& stamp : stamps) {
        to.add(stamp.nx);
        to.add(stamp.ny);
        to.floats(stamp.values);
    }
    for (const auto& command : commands) std::visit([&](const auto& c) { write(to, c); }, command);
    begin_sealed(to.bytes, magic, version);
    std::size_t at = stamps_at;
    put(std::span<std::byte>(to.bytes), at, static_cast<std::uint32_t>(stamps.size()));
    seal(to.bytes);
    return std::move(to.bytes);
}

Result<CommandList> read_commands(std::span<const std::byte> bytes) {
    if (auto status = check_sealed("command log", bytes, magic, {oldest_version, version}, lists_at); !status) return status;
    CommandList list;
    list.level = get<std::uint64_t>(bytes, sealed_header_bytes);
    const auto stamps = get<std::uint32_t>(bytes, stamps_at);
    const auto commands = get<std::uint64_t>(bytes, sealed_header_bytes + 8);
    Reader from(bytes, lists_at);
    for (std::uint32_t n = 0; n < stamps && from.whole(); ++n) {
        Stamp stamp;
        stamp.nx = from.next<std::int32_t>();
        stamp.ny = from.next<std::int32_t>();
        if (stamp.nx < 1 || stamp.ny < 1) return error(Code::bad_file, "command log: a stamp has no pixels");
        stamp.values = from.floats(std::int64_t{stamp.nx} * stamp.ny);
        stamp.set_range();
        list.stamps.push_back(std::move(stamp));
    }
    for (std::uint64_t n = 0; n < commands && from.whole(); ++n) {
        const auto kind = from.next<Kind>();
        const auto layer = static_cast<EditLayer>(from.next<std::uint32_t>() % 3);
        const auto step = from.next<std::uint64_t>();
        if (kind == Kind::edit) {
            list.commands.emplace_back(read_edit(from, layer, step));
        } else if (kind == Kind::region) {
            list.commands.emplace_back(read_region(from, layer, step));
        } else if (kind == Kind::material) {
            list.commands.emplace_back(read_material(from, sealed_version(bytes), step));
        } else if (kind == Kind::source) {
            list.commands.emplace_back(read_source(from, step));
        } else if (kind == Kind::trim) {
            list.commands.emplace_back(Trim{step});
        } else if (from.whole()) {
            return error(Code::bad_file, "command log: it has a command of kind " +
                                             std::to_string(static_cast<std::uint32_t>(kind)) +
                                             ", which this library does not know");
        }
    }
    if (!from.whole() || !from.at_end()) return error(Code::bad_file, "command log: its lists do not end where it does");
    return list;
}

} // namespace wadi
