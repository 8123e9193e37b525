// Set-up and the order of the stages (section 3).
#include "tests/reference/solver.hpp"
#include "tests/reference/backtrace.inl"
#include "tests/reference/deformation.inl"
#include "tests/reference/prestress.inl"
#include "tests/reference/published.inl"
#include "tests/reference/rim.inl"
#include "tests/reference/sand.inl"
#include "tests/reference/slope.inl"
#include "tests/reference/surface.inl"
#include "tests/reference/water.inl"

namespace wadi::reference {

double sample(const TimeSeries& series, double time) {
    const auto& points = series.samples;
    if (points.empty()) return 0;
    if (time <= points.front().first) return points.front().second;
    for (std::size_t n = 1; n < points.size(); ++n) {
        const auto& [t0, v0] = points[n - 1];
        const auto& [t1, v1] = points[n];
        if (time < t1) return v0 + (v1 - v0) * ((time - t0) / (t1 - t0));
    }
    return points.back().second;
}

/// 2.18: the largest root of 2 chi s^3 - 3 mu chi s^2 - mu, from beyond it, where the cubic is convex.
double failing_slope(double mu, double chi) {
    if (chi <= 0) return 1e9;
    double s = 1.5 * mu + std::cbrt(mu / (2 * chi));
    for (int n = 0; n < 60 && s > 0; ++n) s -= (chi * s * s * (2 * s - 3 * mu) - mu) / (6 * chi * s * (s - mu));
    return std::clamp(s, 0.1, 1e9);
}

template <class Real> Solver<Real>::Solver(const Settings& world, std::uint32_t mask) : settings(world), effects(mask) {
    const Material& material = world.material;
    const Method& method = world.method;
    P.dx = static_cast<Real>(world.grid.dx);
    P.gravity = static_cast<Real>(world.gravity);
    P.rho_w = static_cast<Real>(material.water_density);
    P.rho_s = static_cast<Real>(material.sand_density);
    P.friction = static_cast<Real>(material.friction);
    P.yield_friction = static_cast<Real>(material.yield_friction);
    // 2.7: tan(45 deg + phi/2) of the yield surface's friction angle.
    const double rankine = material.yield_friction + std::sqrt(1 + material.yield_friction * material.yield_friction);
    P.rankine = static_cast<Real>(rankine);
    P.adhesion = static_cast<Real>(material.bed_adhesion);
    P.fast_friction = static_cast<Real>(std::max(material.flow_friction, material.friction));
    P.flow_length = static_cast<Real>(material.flow_length);
    P.flow_beta = static_cast<Real>(material.flow_beta);
    P.flow_gamma = static_cast<Real>(material.flow_gamma);
    // 2.23: one layer of water, and the paper, know no pores; as large as the sand they leave no grains.
    const double porosity = has(EFFECT_MIXTURE) && !has(EFFECT_PUBLISHED) ? material.porosity : 1;
    P.porosity = static_cast<Real>(static_cast<float>(porosity));
    P.conductivity = static_cast<Real>(material.conductivity);
    P.suction = static_cast<Real>(material.suction);
    P.displaces = static_cast<Real>(porosity < 1 ? 1 - porosity : 1);
    P.pressed = static_cast<Real>(has(EFFECT_DRAG) ? 1 - porosity : 0);
    const double measured = has(EFFECT_SLOPE_NORMAL) ? 0.78 : 1;
    const double apex = has(EFFECT_PUBLISHED) ? 1 : measured * 4 * material.yield_friction * rankine;
    P.yield_cohesion = static_cast<Real>(apex);
    P.c0 = static_cast<Real>(apex * material.cohesion_dry);
    P.c1 = static_cast<Real>(apex * material.cohesion_wet);
    P.c2 = static_cast<Real>(apex * material.cohesion_capillary);
    P.phi1 = static_cast<Real>(material.saturation[0]);
    P.phi2 = static_cast<Real>(material.saturation[1]);
    P.phi3 = static_cast<Real>(material.saturation[2]);
    P.exchange = has(EFFECT_DRAG) ? static_cast<Real>(porosity * material.exchange_rate) : Real(0);
    P.bed_friction = has(EFFECT_BED_FRICTION) ? static_cast<Real>(material.bed_friction) : Real(0);
    P.manning = has(EFFECT_BED_FRICTION) ? static_cast<Real>(material.manning) : Real(0);
    P.bed_shear = has(EFFECT_BED_SHEAR) ? static_cast<Real>(material.bed_shear) : Real(0);
    const double submerged = std::max(material.sand_density / material.water_density - 1, 0.05) * world.gravity;
    P.bed_threshold = static_cast<Real>(0.047 * submerged * material.grain_size);
    P.bed_rate = static_cast<Real>(submerged > 0 ? 8 / submerged : 0);
    P.largest_height = static_cast<Real>(method.largest_height);
    const double quantum = method.quantum < 0 ? std::exp2(std::ceil(std::log2(method.largest_height)) - 24) : method.quantum;
    P.quantum = static_cast<Real>(quantum);
    const double grain = std::exp2(std::ceil(std::log2(method.largest_height)) - 24); // of heights as floats
    P.eps = P.film = static_cast<Real>(method.dry_threshold);
    if (!has(EFFECT_PUBLISHED)) P.film = std::min(P.eps, static_cast<Real>(2 * grain));
    P.alpha = static_cast<Real>(method.velocity_clamp);
    P.gravity_cap = static_cast<Real>(method.gravity_cap);
    P.sand_gravity_cap = static_cast<Real>(method.sand_gravity_cap);
    P.rest_surface = P.rest_velocity = Real(-1);
    if (method.rest_rule) { // two quanta, and the speed that one step's push of three gives; without a quantum those of the float
                            // grid
        const double least = quantum > 0 ? quantum : grain;
        P.rest_surface = static_cast<Real>(2 * least);
        P.rest_velocity = static_cast<Real>(world.dt / world.grid.dx * world.gravity * 3 * least);
    }
    P.passive_pressure = static_cast<Real>(method.passive_pressure);
    P.gradient_clamp = static_cast<Real>(method.gradient_clamp);
    P.shock_viscosity = static_cast<Real>(method.shock_viscosity);
    P.cohesion_cap = static_cast<Real>(method.cohesion_cap);
    P.chi = static_cast<Real>(material.slope_normal);
    P.wedge = static_cast<Real>(material.friction + std::sqrt(material.friction * material.friction + 1 / material.slope_normal));
    P.plane = static_cast<Real>(failing_slope(material.friction, material.slope_normal));
    P.spread_friction = static_cast<Real>(material.internal_friction);
    P.retained = static_cast<Real>(material.retention);
    P.substeps = method.substeps;
    P.smoothing = method.saturation_smoothing;
    P.limiter = method.outflow_limiter;
    set_time_step(world.dt);

    const std::size_t nx = static_cast<std::size_t>(world.grid.nx);
    const std::size_t ny = static_cast<std::size_t>(world.grid.ny);
    for (Field<Real>* field : {&terrain,
                               &sand,
                               &water,
                               &Vxy,
                               &pure,
                               &mixed,
                               &pure_predicted,
                               &mixed_predicted,
                               &pure_scale,
                               &mixed_scale,
                               &sand_scale,
                               &saturation,
                               &sand_before,
                               &mixed_before,
                               &sxx,
                               &sxy,
                               &syy,
                               &rotation,
                               &cohesive_share,
                               &wedge_depth,
                               &pore_water,
                               &open_sand,
                               &felt_water,
                               &mixed_diffused,
                               &foam,
                               &wetness,
                               &silt})
        field->assign(nx * ny, Real(0));
    Vxx.assign(nx * ny, Real(1));
    Vyy.assign(nx * ny, Real(1));
    for (Faces<Real>* faces :
         {&sand_velocity, &pure_velocity,     &mixed_velocity, &diffusion_flux, &pure_flux,   &mixed_flux, &sand_flux,
          &bed_load,      &centered_velocity, &mixed_push,     &layer_exchange, &ghost_water, &pure_type,  &mixed_type,
          &sand_type,     &extrapolated,      &friction_limit, &withheld_push,  &bend_gain,   &bed_lift}) {
        faces->x.assign((nx + 1) * ny, Real(0));
        faces->y.assign(nx * (ny + 1), Real(0));
    }
    side_memory.x.assign((nx + 1) * ny, {});
    side_memory.y.assign(nx * (ny + 1), {});
    roughness.assign(nx * ny, Real(0));
    if (has(EFFECT_ROUGHNESS))
        std::transform(world.roughness.begin(), world.roughness.end(), roughness.begin(),
                       [](float n) { return static_cast<Real>(n); });
    rain_share.assign(nx * ny, Real(65536));
    if (has(EFFECT_RAIN_MAP) && !world.rain_map.empty()) {
        rain_peak = static_cast<double>(*std::max_element(world.rain_map.begin(), world.rain_map.end()));
        for (std::size_t c = 0; c < nx * ny; ++c)
            rain_share[c] =
                static_cast<Real>(rain_peak > 0 ? std::round(static_cast<double>(world.rain_map[c]) / rain_peak * 65536) : 0);
    }
    source_totals_.assign(world.sources.size(), 0.0);
}

template <class Real> void Solver<Real>::set_time_step(double dt) {
    settings.dt = dt;
    P.dt = static_cast<Real>(dt);
    P.substep = P.dt / Real(P.substeps);
    P.k = P.dt / P.dx;
    P.k_sand = P.substep / P.dx;
    P.clamp = P.alpha / P.k;
    P.clamp_sand = P.alpha / P.k_sand;
    P.diffusion = static_cast<Real>(settings.material.diffusion_rate);
    if (!has(EFFECT_PUBLISHED)) P.diffusion = std::min(P.diffusion, Real(0.2) * P.dx * P.dx / P.dt);
    const Real E = static_cast<Real>(settings.material.young_modulus);
    const Real nu = static_cast<Real>(settings.material.poisson_ratio);
    P.lambda = E * nu / ((Real(1) + nu) * (Real(1) - Real(2) * nu));
    P.shear = E / (Real(2) * (Real(1) + nu));
    const Real cap = static_cast<Real>(settings.method.elastic_cap);
    if (cap > Real(0) && E > Real(0)) {
        const Real stiffest = cap * P.rho_s * P.dx * P.dx / (P.substep * P.substep);
        const Real factor = std::min(Real(1), stiffest / (P.lambda + Real(2) * P.shear));
        P.lambda *= factor;
        P.shear *= factor;
    }
    const Real wave = std::sqrt((P.lambda + Real(2) * P.shear) / P.rho_s); // speed of pressure waves in sand
    const Real courant = wave * P.k_sand;
    const Real room = std::max(Real(0), Real(0.2) - Real(0.4) * courant * courant);
    const Real shear = static_cast<Real>(settings.material.sand_viscosity) * P.substep / (P.dx * P.dx);
    P.shear_number = std::min(shear, room / Real(2));
    const Real number =
        std::min(static_cast<Real>(settings.method.bulk_viscosity) * P.substep / (P.dx * P.dx), room - P.shear_number);
    P.viscosity = number * P.rho_s * P.dx * P.dx / P.substep;
}

template <class Real> void Solver<Real>::load(const InitialFields& fields) {
    const auto heights = [&](const std::vector<float>& from, Field<Real>& to) {
        for (std::size_t c = 0; c < from.size(); ++c) {
            const Real h = static_cast<Real>(from[c]);
            to[c] = P.quantum > Real(0) ? std::nearbyint(h / P.quantum) * P.quantum : h;
        }
    };
    const auto velocities = [&](const std::vector<float>& from_x, const std::vector<float>& from_y, Faces<Real>& to) {
        for_inner_faces([&](const Axis& ax, int a, int b) {
            const std::vector<float>& from = ax.is_y ? from_y : from_x;
            if (from.empty()) return;
            to.along(ax)[ax.face(a, b)] =
                mean(static_cast<Real>(from[ax.cell(a - 1, b)]), static_cast<Real>(from[ax.cell(a, b)]));
        });
    };
    heights(fields.terrain, terrain);
    if (has(EFFECT_SAND)) heights(fields.sand, sand);
    if (has(EFFECT_WATER)) heights(fields.water, water);
    for (std::size_t c = 0; c < cells(); ++c)
        pore_water[c] = water[c] > Real(0) && water[c] >= pore_room(sand[c]) ? Real(-1) : water[c];
    for (std::size_t c = 0; c < cells(); ++c) Vxx[c] = Vyy[c] = Real(1) + balance(sand[c], water[c]);
    if (settings.method.prestress && has(EFFECT_COHESION) && has(EFFECT_SLOPE_NORMAL)) bound_balance();
    if (has(EFFECT_SAND)) velocities(fields.sand_velocity_x, fields.sand_velocity_y, sand_velocity);
    if (has(EFFECT_WATER)) velocities(fields.velocity_x, fields.velocity_y, pure_velocity);
    if (has(EFFECT_MIXTURE)) velocities(fields.velocity_x, fields.velocity_y, mixed_velocity);
    split_water();
}

template <class Real> template <class Other> void Solver<Real>::copy_from(const Solver<Other>& other) {
    const auto copy = [](const Field<Other>& from, Field<Real>& to) {
        for (std::size_t n = 0; n < to.size(); ++n) to[n] = static_cast<Real>(from[n]);
    };
    const auto field = [&](Field<Other> Solver<Other>::*from, Field<Real> Solver<Real>::*to) { copy(other.*from, this->*to); };
    const auto faces = [&](Faces<Other> Solver<Other>::*from, Faces<Real> Solver<Real>::*to) {
        copy((other.*from).x, (this->*to).x);
        copy((other.*from).y, (this->*to).y);
    };
    using A = Solver<Other>;
    using B = Solver<Real>;
    field(&A::terrain, &B::terrain);
    field(&A::sand, &B::sand);
    field(&A::water, &B::water);
    field(&A::Vxx, &B::Vxx);
    field(&A::Vxy, &B::Vxy);
    field(&A::Vyy, &B::Vyy);
    field(&A::rotation, &B::rotation);
    field(&A::pure, &B::pure);
    field(&A::mixed, &B::mixed);
    field(&A::pure_predicted, &B::pure_predicted);
    field(&A::mixed_predicted, &B::mixed_predicted);
    field(&A::pure_scale, &B::pure_scale);
    field(&A::mixed_scale, &B::mixed_scale);
    field(&A::sand_scale, &B::sand_scale);
    field(&A::saturation, &B::saturation);
    field(&A::sand_before, &B::sand_before);
    field(&A::mixed_before, &B::mixed_before);
    field(&A::sxx, &B::sxx);
    field(&A::sxy, &B::sxy);
    field(&A::syy, &B::syy);
    field(&A::cohesive_share, &B::cohesive_share);
    faces(&A::sand_velocity, &B::sand_velocity);
    faces(&A::pure_velocity, &B::pure_velocity);
    faces(&A::mixed_velocity, &B::mixed_velocity);
    faces(&A::diffusion_flux, &B::diffusion_flux);
    faces(&A::pure_flux, &B::pure_flux);
    faces(&A::mixed_flux, &B::mixed_flux);
    faces(&A::sand_flux, &B::sand_flux);
    faces(&A::centered_velocity, &B::centered_velocity);
    faces(&A::bed_load, &B::bed_load);
    faces(&A::mixed_push, &B::mixed_push);
    faces(&A::layer_exchange, &B::layer_exchange);
    faces(&A::ghost_water, &B::ghost_water);
    const auto remembers = [](const auto& from, auto& to) {
        for (std::size_t n = 0; n < to.size(); ++n)
            to[n] = {static_cast<Real>(from[n].stream), static_cast<Real>(from[n].error), static_cast<Real>(from[n].mean),
                     static_cast<Real>(from[n].rise), static_cast<Real>(from[n].above)};
    };
    remembers(other.side_memory.x, side_memory.x);
    remembers(other.side_memory.y, side_memory.y);
    faces(&A::pure_type, &B::pure_type);
    faces(&A::mixed_type, &B::mixed_type);
    faces(&A::sand_type, &B::sand_type);
    faces(&A::extrapolated, &B::extrapolated);
    faces(&A::friction_limit, &B::friction_limit);
    faces(&A::withheld_push, &B::withheld_push);
    faces(&A::bend_gain, &B::bend_gain);
    faces(&A::bed_lift, &B::bed_lift);
    field(&A::wedge_depth, &B::wedge_depth);
    field(&A::pore_water, &B::pore_water);
    field(&A::open_sand, &B::open_sand);
    field(&A::felt_water, &B::felt_water);
    field(&A::mixed_diffused, &B::mixed_diffused);
    field(&A::foam, &B::foam);
    field(&A::wetness, &B::wetness);
    field(&A::silt, &B::silt);
    rained = static_cast<Real>(other.rained);
    water_added = other.water_added;
    sand_added = other.sand_added;
    refused = other.refused;
    step_index = other.step_index;
    source_totals_ = other.source_totals_;
    rain_total_ = other.rain_total_;
    evaporation_total_ = other.evaporation_total_;
    side_totals_ = other.side_totals_;
}

template <class Real> void Solver<Real>::step() {
    mix_source_momentum();
    apply_sources();
    apply_rain();
    dilute_water_velocity();
    split_water();
    has(EFFECT_PUBLISHED) ? step_published() : step_robust();
    ++step_index;
}

template <class Real> void Solver<Real>::step_robust() {
    update_open_sides();
    if (has(EFFECT_WATER)) {
        split_water();
        if (step_index == 0 && has(EFFECT_SECOND_ORDER_WATER)) start_water_velocity();
        diffuse_mixed_water();
        limit_water_outflow();
        compute_water_flux();
        integrate_water_height();
        infiltrate();
        if (has(EFFECT_SECOND_ORDER_WATER)) center_water_velocity();
        integrate_water_velocity();
        carry_foam();
        wet_ground();
        carry_silt();
    }
    if (has(EFFECT_BED_SHEAR)) compute_bed_load();
    if (has(EFFECT_COHESION)) compute_saturation();
    for (int substep = 0; has(EFFECT_SAND) && substep < P.substeps; ++substep) {
        update_open_sand_sides();
        limit_sand_outflow();
        compute_sand_flux();
        integrate_sand_height();
        if (has(EFFECT_ELASTOPLASTIC)) {
            evolve_deformation_gradient();
            project_deformation_gradient();
        }
        if (has(EFFECT_SLOPE_NORMAL)) bend_sand_velocity();
        if (has(EFFECT_FLOW_FRICTION)) raise_friction();
        integrate_sand_velocity();
        if (has(EFFECT_SLOPE_NORMAL)) raise_failing_planes();
        if (has(EFFECT_MIXTURE)) compute_momentum_exchange();
        apply_friction();
    }
}

template class Solver<float>;
template class Solver<double>;
template void Solver<float>::copy_from(const Solver<float>&);
template void Solver<double>::copy_from(const Solver<float>&);

} // namespace wadi::reference
