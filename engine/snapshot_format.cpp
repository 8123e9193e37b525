#include "engine/snapshot_format.hpp"
#include "engine/material_keys.hpp"
#include <cstring>

namespace wadi {

namespace {

constexpr char magic[] = "WADISNAP";
constexpr std::size_t fields_at = 12, material_at = 80, name_bytes = 32, field_bytes = name_bytes + 8, total_bytes = 16;

std::size_t fixed_bytes() { return material_at + 8 * material_keys().size(); }

} // namespace

std::uint64_t SnapshotHeader::begin_of(std::size_t field) const {
    std::uint64_t at = fixed_bytes() + total_bytes * totals.inputs.size() + field_bytes * fields.size();
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
                               m.bed_shear,
                               m.grain_size,
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
                               w.shock_viscosity,
                               w.bulk_viscosity,
                               w.rest_surface,
                               w.rest_velocity,
                               w.passive_pressure,
                               w.gradient_clamp,
                               w.cohesion_cap,
                               w.stress_taper,
                               double(w.saturation_smoothing),
                               double(w.velocity_transport),
                               double(w.strain_transport),
                               double(w.drag_friction),
                               double(w.diffusion),
                               double(w.water_transport_order)})
        add(value);
    if (w.half_storage) add(1); // levels without it keep their digest
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
    for (const auto& [edit, time, every, until, move] : s.edits) {
        for (const double value :
             {double(edit.kind), double(edit.layer), double(edit.capsule), edit.x0, edit.y0, edit.x1, edit.y1, edit.radius,
              edit.softness, edit.amount, edit.strength, edit.velocity_x, edit.velocity_y, time, every, until, move[0], move[1]})
            add(value);
    }
    return sum.value();
}

void write_header(const SnapshotHeader& header, std::span<std::byte> to) {
    begin_sealed(to.first(header.bytes()), magic, snapshot_version);
    std::size_t at = fields_at;
    put(to, at, static_cast<std::uint32_t>(header.fields.size()));
    at = sealed_header_bytes;
    put(to, at, header.nx);
    put(to, at, header.ny);
    put(to, at, header.effects);
    put(to, at, static_cast<std::uint32_t>(header.totals.inputs.size()));
    put(to, at, header.level);
    put(to, at, header.totals.steps);
    put(to, at, header.totals.sand_initial);
    put(to, at, header.totals.water_initial);
    for (int key = 0; key < static_cast<int>(material_keys().size()); ++key) put(to, at, material_value(header.material, key));
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
    if (auto status = check_sealed("snapshot", snapshot, magic, snapshot_version, fixed_bytes()); !status) return status;
    const std::uint64_t bytes = snapshot.size();
    SnapshotHeader header;
    header.nx = get<std::int32_t>(snapshot, 32);
    header.ny = get<std::int32_t>(snapshot, 36);
    header.effects = get<std::uint32_t>(snapshot, 40);
    header.level = get<std::uint64_t>(snapshot, 48);
    header.totals = {get<std::uint64_t>(snapshot, 56), get<std::int64_t>(snapshot, 64), get<std::int64_t>(snapshot, 72), {}};
    const std::uint64_t totals = get<std::uint32_t>(snapshot, 44), fields = get<std::uint32_t>(snapshot, fields_at);
    std::size_t at = material_at;
    for (int key = 0; key < static_cast<int>(material_keys().size()); ++key, at += 8)
        set_material_value(header.material, key, get<double>(snapshot, at));
    if (auto status = validate(header.material); !status) return broken(status.message);
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
