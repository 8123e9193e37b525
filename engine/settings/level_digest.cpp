#include "engine/settings/level_digest.hpp"
#include "engine/settings/checksum.hpp"
#include <span>

namespace wadi {

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

} // namespace wadi
