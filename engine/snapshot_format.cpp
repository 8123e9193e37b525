#include "engine/snapshot_format.hpp"
#include <array>
#include <bit>
#include <cstring>

namespace wadi {

namespace {

static_assert(std::endian::native == std::endian::little, "snapshots are written as the processor holds numbers");

constexpr char magic[8] = {'W', 'A', 'D', 'I', 'S', 'N', 'A', 'P'};
constexpr std::size_t version_at = 8, bytes_at = 16, checksum_at = 24, fixed_bytes = 80, name_bytes = 32;
constexpr std::size_t field_bytes = name_bytes + 8, total_bytes = 16;

// Four lanes of multiply and rotate, 32 bytes a turn. Each step can be undone, so that a change of a single word always shows.
class Checksum {
  public:
    void add(std::span<const std::byte> bytes) {
        std::size_t at = 0;
        for (; at + 32 <= bytes.size(); at += 32) {
            for (std::size_t n = 0; n < 4; ++n) lane_[n] = turn(lane_[n], word(bytes.subspan(at + 8 * n, 8)));
        }
        for (std::size_t n = 0; at < bytes.size(); n = (n + 1) % 4) {
            const std::size_t left = std::min<std::size_t>(8, bytes.size() - at);
            lane_[n] = turn(lane_[n], word(bytes.subspan(at, left)));
            at += left;
        }
        lane_[0] = turn(lane_[0], bytes.size());
    }
    std::uint64_t value() const {
        std::uint64_t sum = 0;
        for (std::size_t n = 0; n < 4; ++n) sum = turn(sum, lane_[n]);
        return sum;
    }

  private:
    static std::uint64_t word(std::span<const std::byte> bytes) {
        std::uint64_t w = 0;
        std::memcpy(&w, bytes.data(), bytes.size());
        return w;
    }
    static std::uint64_t turn(std::uint64_t lane, std::uint64_t w) {
        return std::rotl((lane ^ w) * 0x9e3779b97f4a7c15ull, 29) + 0xd1b54a32d192ed03ull;
    }
    std::array<std::uint64_t, 4> lane_{1, 2, 3, 4};
};

std::uint64_t checksum_of(std::span<const std::byte> snapshot) {
    Checksum sum;
    sum.add(snapshot.first(checksum_at));
    sum.add(snapshot.subspan(checksum_at + 8));
    return sum.value();
}

template <class T> T get(std::span<const std::byte> from, std::size_t at) {
    T value;
    std::memcpy(&value, from.data() + at, sizeof value);
    return value;
}

template <class T> void put(std::span<std::byte> to, std::size_t& at, T value) {
    std::memcpy(to.data() + at, &value, sizeof value);
    at += sizeof value;
}

} // namespace

std::uint64_t SnapshotHeader::begin_of(std::size_t field) const {
    std::uint64_t at = fixed_bytes + total_bytes * totals.inputs.size() + field_bytes * fields.size();
    for (std::size_t n = 0; n < field; ++n) at += fields[n].bytes;
    return at;
}

std::uint64_t level_digest(const Settings& s) {
    Checksum sum;
    const auto add = [&](double value) { sum.add(std::as_bytes(std::span(&value, 1))); };
    const auto series = [&](const TimeSeries& t) {
        add(static_cast<double>(t.samples.size()));
        for (const auto& [time, value] : t.samples) {
            add(time);
            add(value);
        }
    };
    const auto& m = s.material;
    const auto& w = s.method;
    sum.add(std::as_bytes(std::span(w.name)));
    for (const double value : {double(s.grid.nx),
                               double(s.grid.ny),
                               s.grid.dx,
                               s.dt,
                               s.gravity,
                               m.water_density,
                               m.sand_density,
                               m.friction,
                               m.young_modulus,
                               m.poisson_ratio,
                               m.yield_friction,
                               m.cohesion_dry,
                               m.cohesion_wet,
                               m.cohesion_capillary,
                               m.saturation[0],
                               m.saturation[1],
                               m.saturation[2],
                               m.exchange_rate,
                               m.diffusion_rate,
                               m.bed_friction,
                               double(w.substeps),
                               double(w.outflow_limiter),
                               w.quantum,
                               w.largest_height,
                               w.dry_threshold,
                               w.velocity_clamp,
                               w.gravity_cap,
                               w.gravity_cap_least,
                               w.sand_gravity_cap,
                               w.elastic_cap,
                               w.rest_surface,
                               w.rest_velocity,
                               w.passive_pressure,
                               w.gradient_clamp,
                               w.cohesion_cap,
                               w.stress_taper,
                               double(w.saturation_smoothing)})
        add(value);
    for (const auto& side : s.sides) {
        add(static_cast<double>(side.kind));
        add(side.from);
        add(side.to);
        series(side.value);
    }
    for (const auto& source : s.sources) {
        for (const double value :
             {double(source.shape), double(source.material), source.center[0], source.center[1], source.radius, source.box[0],
              source.box[1], source.box[2], source.box[3], double(source.set_velocity), source.velocity[0], source.velocity[1]})
            add(value);
        series(source.rate);
    }
    series(s.rain);
    series(s.evaporation);
    return sum.value();
}

void write_header(const SnapshotHeader& header, std::span<std::byte> to) {
    std::memcpy(to.data(), magic, sizeof magic);
    std::size_t at = version_at;
    put(to, at, snapshot_version);
    put(to, at, static_cast<std::uint32_t>(header.fields.size()));
    put(to, at, header.bytes());
    put(to, at, std::uint64_t{0});
    put(to, at, header.nx);
    put(to, at, header.ny);
    put(to, at, header.effects);
    put(to, at, static_cast<std::uint32_t>(header.totals.inputs.size()));
    put(to, at, header.level);
    put(to, at, header.totals.steps);
    put(to, at, header.totals.sand_initial);
    put(to, at, header.totals.water_initial);
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

void seal(std::span<std::byte> snapshot) {
    std::size_t at = checksum_at;
    put(snapshot, at, checksum_of(snapshot));
}

Result<SnapshotHeader> read_header(std::span<const std::byte> snapshot) {
    const auto broken = [](const std::string& what) { return error(Code::bad_file, "snapshot: " + what); };
    if (snapshot.size() < fixed_bytes) {
        return broken(std::to_string(snapshot.size()) + " bytes are fewer than the " + std::to_string(fixed_bytes) +
                      " of a header");
    }
    if (std::memcmp(snapshot.data(), magic, sizeof magic) != 0) return broken("it does not begin with WADISNAP");
    const auto version = get<std::uint32_t>(snapshot, version_at);
    if (version != snapshot_version) {
        return broken("version " + std::to_string(version) + (version > snapshot_version ? " is newer than" : " is not") +
                      " the version " + std::to_string(snapshot_version) + " that this library reads");
    }
    const auto bytes = get<std::uint64_t>(snapshot, bytes_at);
    if (bytes != snapshot.size()) {
        return broken("it says that it has " + std::to_string(bytes) + " bytes, but there are " +
                      std::to_string(snapshot.size()));
    }
    if (get<std::uint64_t>(snapshot, checksum_at) != checksum_of(snapshot))
        return broken("its checksum is wrong: bytes were changed");
    SnapshotHeader header;
    header.nx = get<std::int32_t>(snapshot, 32);
    header.ny = get<std::int32_t>(snapshot, 36);
    header.effects = get<std::uint32_t>(snapshot, 40);
    header.level = get<std::uint64_t>(snapshot, 48);
    header.totals = {get<std::uint64_t>(snapshot, 56), get<std::int64_t>(snapshot, 64), get<std::int64_t>(snapshot, 72), {}};
    const std::uint64_t totals = get<std::uint32_t>(snapshot, 44), fields = get<std::uint32_t>(snapshot, 12);
    if (fixed_bytes + totals * total_bytes + fields * field_bytes > bytes) return broken("its lists pass its end");
    std::size_t at = fixed_bytes;
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
