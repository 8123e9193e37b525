#include "engine/step/plan/world_params.hpp"
#include "engine/step/plan/source_shapes.hpp"
#include <algorithm>
#include <cmath>

namespace wadi {

namespace {

// Neutral values that switch a guard off without a branch. Large, but far from overflow in what the stages do with them.
constexpr float off = 1e30F;
constexpr float gravity_cap_off = 1e9F;
constexpr double steep = 1e9; // slope of a wedge that limits nothing

// Next to nothing: less would not change a bit of what moves, but its inverse does not fit into a float. Below it gravity is
// none, and sand has this stiffness if it has any.
constexpr double least_gravity = 1e-15;   // [m/s2]
constexpr double least_stiffness = 1e-15; // [Pa]

// As a float, within what stages can multiply: neutral values of guards included.
// What is next to nothing is nothing, as in stages (flush): quotients of denormals are the processor's own.
float as_float(double x) {
    return std::abs(x) < 1e-20 ? 0.0F : static_cast<float>(std::clamp(x, -static_cast<double>(off), static_cast<double>(off)));
}

void set_sources(const Settings& s, WorldParams& p) {
    const SourcePieces pieces = source_pieces(s);
    p.source_count = static_cast<int>(s.sources.size());
    p.source_boxes = static_cast<int>(pieces.boxes.size());
    p.source_pieces = pieces.count;
    p.source_rows = pieces.rows;
}

// That of which heights are multiples unless a level says otherwise: what floats tell apart.
double finest_quantum(const Method& method) {
    Method chosen = method;
    chosen.quantum = -1;
    return height_quantum(chosen);
}

// tan(45 deg + phi/2) of the sand's inner friction.
double rankine(const Material& m) { return m.yield_friction + std::sqrt(1 + m.yield_friction * m.yield_friction); }

// Cohesion of the yield surface per cohesion of the material: its tip then holds cuts up to Rankine's height (NUMERICS 2.7), less
// of it where friction on the ground holds what falls, too. The paper's is the material's.
double yield_cohesion(const Material& m, std::uint32_t effects) {
    if ((effects & EFFECT_PUBLISHED) != 0) return 1;
    const double measured = (effects & EFFECT_SLOPE_NORMAL) != 0 ? 0.78 : 1.0;
    return measured * 4 * m.yield_friction * rankine(m);
}

// Share of the sand that is pores. Without two layers of water, and in the paper's method, they are as large as the sand.
double pore_share(const Material& m, std::uint32_t effects) {
    return (effects & EFFECT_MIXTURE) != 0 && (effects & EFFECT_PUBLISHED) == 0 ? m.porosity : 1;
}

// Slope of the plane on which a wedge of sand behind a cliff gains most momentum: of all s that of the largest (s - mu)/(s (1 +
// chi s^2)), mass times acceleration; a root of 2 chi s^3 - 3 mu chi s^2 - mu. Not below a tenth, where wedges would be longer
// than what they explain.
double failing_slope(double mu, double chi) {
    if (chi <= 0) return steep;
    double low = mu, high = mu + 1;
    const auto beyond = [&](double s) { return chi * s * s * (2 * s - 3 * mu) > mu; };
    while (!beyond(high) && high < steep) high *= 2;
    for (int n = 0; n < 100; ++n) (beyond(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
    return std::clamp(high, 0.1, steep);
}

// Of what halves in that time, 0 = never, the share that goes in a step.
double fading_share(double half_life, double dt) { return half_life > 0 ? -std::expm1(-std::log(2.0) * dt / half_life) : 0; }

} // namespace

double ledger_quantum(const Method& method) {
    return height_quantum(method) > 0 ? height_quantum(method) : finest_quantum(method);
}

float velocity_limit(const Method& method, double k) { return static_cast<float>(method.velocity_clamp / k); }

WorldParams derive_params(const Settings& s, std::uint32_t effects) {
    const auto& m = s.material;
    const auto& w = s.method;
    const FieldLayout layout{s.grid.nx, s.grid.ny};
    const auto f = as_float;
    const double gravity = s.gravity < least_gravity ? 0 : s.gravity;
    const double dx = s.grid.dx, dt = s.water_dt(), dts = s.dt / w.substeps, k = dt / dx, ks = dts / dx, step_k = s.dt / dx,
                 quantum = height_quantum(w);
    WorldParams p{};
    p.nx = s.grid.nx;
    p.ny = s.grid.ny;
    p.pitch = layout.pitch();
    p.strips = layout.strips();
    p.tile_size = s.tile_side();
    p.tile_rings = 1; // WorldState widens it to the plan's reach
    p.tile_columns = s.tile_side() > 0 ? FieldLayout::active_tiles(s.grid.nx, s.tile_side()) : 0;
    p.tile_rows = s.tile_side() > 0 ? FieldLayout::active_tiles(s.grid.ny, s.tile_side()) : 0;
    set_sources(s, p);
    const auto kind = [&](int side) { // a level that absorbs is a side of waves without any
        const Side& of = s.sides[static_cast<std::size_t>(side)];
        return static_cast<int>(of.kind == SideKind::level && of.absorb > 0 ? SideKind::waves : of.kind);
    };
    p.side_kind_west = kind(SIDE_WEST);
    p.side_kind_east = kind(SIDE_EAST);
    p.side_kind_south = kind(SIDE_SOUTH);
    p.side_kind_north = kind(SIDE_NORTH);
    p.dx = f(dx);
    p.inv_dx = f(1 / dx);
    p.gravity = f(gravity);
    p.quantum = f(quantum);
    p.inv_quantum = quantum > 0 ? f(1 / quantum) : 0.0F;
    p.inv_ledger_quantum = f(1 / ledger_quantum(w));
    p.largest_height = f(w.largest_height);
    p.dry_threshold = f(w.dry_threshold);
    p.film = f(std::min(w.dry_threshold, 2 * finest_quantum(w))); // so much or less is none

    p.k = f(k);
    p.water_velocity_clamp = velocity_limit(w, k);
    p.shock_viscosity = f(w.shock_viscosity * k * std::sqrt(gravity));
    p.gravity_cap_base = w.gravity_cap > 0 ? f(w.gravity_cap) : gravity_cap_off;
    p.inv_k2 = f(1 / (k * k));
    p.step_k = f(step_k);
    p.inv_step_k2 = f(1 / (step_k * step_k));
    const double rest_surface = 2 * ledger_quantum(w);
    p.rest_surface = w.rest_rule ? f(rest_surface) : -1.0F;
    const double pushed = (effects & EFFECT_MIXTURE) != 0 ? step_k : k; // what is inside the sand is pushed once a step
    p.rest_velocity = w.rest_rule ? f(1.5 * pushed * gravity * rest_surface) : -1.0F; // rounding of the push does not decide
    const double spreads = (effects & EFFECT_PUBLISHED) != 0 ? m.diffusion_rate : std::min(m.diffusion_rate, 0.2 * dx * dx / dt);
    p.diffusion_number = f(pore_share(m, effects) * spreads * dt / (dx * dx));
    p.bed_friction_dt = f(dt * m.bed_friction);
    p.manning = f(m.manning);
    p.gravity_dt = f(dt * gravity);
    const double submerged = std::max(m.sand_density / m.water_density - 1, 0.05) * gravity; // (s - 1) g
    p.bed_shear = f(m.bed_shear);
    p.bed_shear_dt = f(dt * m.bed_shear);
    p.bed_shear_threshold = f(0.047 * submerged * m.grain_size);
    p.bed_load = submerged > 0 ? f(8 / submerged) : 0.0F;
    p.bed_slope_number = f(2 / dx);
    p.bed_slope_cap = f(0.2 * dx / s.dt);
    p.limiter = w.outflow_limiter ? 1.0F : 0.0F;
    p.infiltration = f(dt * m.conductivity);
    p.suction = f(m.suction);
    p.foam_birth = f(0.5 * m.water_density * dt / (s.surface.foam_energy * dx));
    p.foam_fade = f(fading_share(s.surface.foam_half_life, dt));
    p.wetness_fade = f(fading_share(s.surface.wetness_half_life, dt));
    p.silt_fall = f(dt * s.surface.silt_settling);
    p.silt_rate = f(dt * s.surface.silt_rate);
    p.inv_silt_speed2 = f(1 / (s.surface.silt_speed * s.surface.silt_speed));
    p.inv_substeps = f(static_cast<double>(w.water_substeps) / w.substeps);

    p.ks = f(ks);
    p.dts = f(dts);
    p.sand_velocity_clamp = velocity_limit(w, ks);
    p.sand_gravity_cap = w.sand_gravity_cap > 0 ? f(w.sand_gravity_cap / (ks * ks)) : off;
    p.density_ratio = f(m.water_density / m.sand_density);
    p.water_density = f(m.water_density);
    p.sand_density = f(m.sand_density);
    p.friction = f(m.friction);
    const double n = pore_share(m, effects);
    p.porosity = f(n);
    p.inv_porosity = f(1 / n);
    p.buoyancy = n < 1 ? f(1 - n) : 1.0F;
    p.pressed_grains = (effects & EFFECT_DRAG) != 0 ? f(1 - n) : 0.0F;
    const double kd = (effects & EFFECT_DRAG) != 0 ? dts * n * m.exchange_rate : 0;
    p.drag_kd = f(kd);
    p.water_drag = p.drag_kd * (static_cast<float>(w.substeps) / static_cast<float>(w.water_substeps));
    p.drag_coupling = f(kd * m.water_density / (m.water_density + kd) / m.sand_density);
    p.drag_share = f(kd / (m.water_density + kd));
    const double wedge = m.slope_normal > 0 ? m.friction + std::sqrt(m.friction * m.friction + 1 / m.slope_normal) : steep;
    p.slope_normal = (effects & EFFECT_SLOPE_NORMAL) != 0 ? f(m.slope_normal) : 0.0F;
    p.wedge_slope = f(std::min(wedge, steep));
    p.wedge_slope2 = f(std::min(wedge * wedge, steep * steep));
    p.wedge_weight = f(1 / (1 + m.slope_normal * std::min(wedge * wedge, steep * steep)));
    const double plane = failing_slope(m.friction, m.slope_normal);
    p.plane_slope2 = f(plane * plane);
    p.plane_rise = f(plane * dx);
    p.inv_plane_rise = f(1 / (plane * dx));
    p.plane_fall = f((plane - m.friction) / (1 + m.slope_normal * plane * plane) * dx);
    p.friction_fall = f(m.friction * dx);
    p.inv_dts = f(1 / dts);
    p.inner_friction = f(m.yield_friction);
    p.rankine = f(rankine(m));
    const double upright = m.friction + std::sqrt(1 + m.friction * m.friction);
    p.passive = f(upright * upright);
    p.bed_adhesion = f(m.bed_adhesion);
    p.adhesion_slip = f(m.bed_adhesion * dts * gravity * m.yield_friction / (4 * yield_cohesion(m, effects)));
    p.flow_rise = m.friction > 0 ? f(std::max(m.flow_friction - m.friction, 0.0) / m.friction) : 0.0F;
    p.flow_length = f(m.flow_length);
    p.flow_beta = f(m.flow_beta);
    p.flow_gamma = f(m.flow_gamma);
    p.internal_friction = f(m.internal_friction);
    const bool retains = (effects & EFFECT_RETENTION) != 0;
    p.retained = retains ? f(m.retention) : -1.0F; // all water is free
    p.inv_drainable = retains ? f(1 / (1 - m.retention)) : 1.0F;
    p.prestress = w.prestress ? 1.0F : 0.0F;

    const double young = m.young_modulus > 0 ? std::max(m.young_modulus, least_stiffness) : 0;
    double lambda = young * m.poisson_ratio / ((1 + m.poisson_ratio) * (1 - 2 * m.poisson_ratio));
    double shear = young / (2 * (1 + m.poisson_ratio));
    if (w.elastic_cap > 0 && lambda + 2 * shear > 0) {
        const double stiffness = lambda + 2 * shear,
                     scale = std::min(1.0, std::max(w.elastic_cap * m.sand_density * dx * dx / (dts * dts * stiffness),
                                                    least_stiffness / stiffness));
        lambda *= scale;
        shear *= scale;
    }
    const double slope = m.yield_friction * (2 * shear + 2 * lambda);
    const double weight = m.sand_density * gravity;
    p.lambda = f(lambda);
    p.shear = f(shear);
    p.inv_two_shear = shear > 0 ? f(0.5 / shear) : 0.0F;
    p.yield_slope = f(slope);
    p.inv_yield_slope = slope > 0 ? f(1 / slope) : 0.0F;
    p.inv_bulk = lambda + shear > 0 ? f(1 / (lambda + shear)) : 0.0F;
    p.cliff_share = weight > 0 ? f(4 / (m.yield_friction * weight)) : 0.0F;
    p.passive_pressure = w.passive_pressure > 0 ? f(w.passive_pressure * weight) : off;
    // The explicit viscous stress is stable with the elastic one while nu dts/dx^2 <= 1/4 - c^2 dts^2/(2 dx^2).
    const double wave = std::sqrt((lambda + 2 * shear) / m.sand_density) * ks;
    // Viscosity of shear takes half of that room at most, the bulk's the rest.
    const double room = std::max(0.0, 0.2 - 0.4 * wave * wave),
                 sheared = std::min(m.sand_viscosity * dts / (dx * dx), 0.5 * room);
    const double viscous = std::min(w.bulk_viscosity * dts / (dx * dx), room - sheared);
    p.viscosity_number = f(sheared);
    p.bulk_viscosity = f(viscous * m.sand_density / ks);
    p.tip_pressure = f(0.5 / m.yield_friction);
    p.inv_friction_yield = f(1 / m.yield_friction);
    p.force_scale = f(ks / m.sand_density);
    p.gradient_clamp = w.gradient_clamp > 0 ? f(w.gradient_clamp) : off;
    p.cohesion_cap = w.cohesion_cap > 0 ? f(2 * m.yield_friction * w.cohesion_cap * weight) : off;
    const auto [phi1, phi2, phi3] = m.saturation;
    const double apex = yield_cohesion(m, effects);
    p.cohesion0 = f(apex * m.cohesion_dry);
    p.cohesion1 = f(apex * m.cohesion_wet);
    p.phi1 = f(phi1);
    p.phi2 = f(phi2);
    p.phi3 = f(phi3);
    p.slope01 = f(apex * (m.cohesion_wet - m.cohesion_dry) / phi1);
    p.slope12 = f(apex * (m.cohesion_capillary - m.cohesion_wet) / (phi2 - phi1));
    p.slope23 = f(apex * m.cohesion_capillary / (phi3 - phi2));
    // Tensor weights: 1 | 2,1 | 3,2,1 by distance; zero weights switch the outer rings off.
    p.smooth0 = f(w.saturation_smoothing + 1);
    p.smooth1 = f(std::max(0, w.saturation_smoothing));
    p.smooth2 = f(std::max(0, w.saturation_smoothing - 1));
    return p;
}

} // namespace wadi
