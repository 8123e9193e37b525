#include "tests/conformance/stage_reference.hpp"
#include "shaders/effects.h"
#include <algorithm>
#include <cmath>

namespace wadi::conformance {

namespace {

using reference::Solver;

template <class Real> struct Step {
    const char* stage;
    void (Solver<Real>::*run)();
    std::uint32_t needs;
    std::uint32_t without = 0; // bits whose stages do its work instead
};

// In the order of the step plan. The splits of the water are the reference's own: the stages derive them where they read.
template <class Real>
constexpr Step<Real> steps[] = {
    {"mix_source_momentum", &Solver<Real>::mix_source_momentum, EFFECT_SOURCES | EFFECT_WATER, EFFECT_PUBLISHED},
    {"apply_sources", &Solver<Real>::apply_sources, EFFECT_SOURCES},
    {"apply_rain", &Solver<Real>::apply_rain, EFFECT_RAIN},
    {"dilute_water_velocity", &Solver<Real>::dilute_water_velocity, EFFECT_RAIN_MAP, EFFECT_PUBLISHED},
    {"open_pores", &Solver<Real>::open_pores, EFFECT_INFILTRATION},
    {"open_sides", &Solver<Real>::update_open_sides, EFFECT_OPEN_SIDES | EFFECT_WATER},
    {"split_water", &Solver<Real>::split_water, 0},
    {"diffuse_mixed_velocity", &Solver<Real>::diffuse_mixed_velocity, EFFECT_PUBLISHED | EFFECT_DIFFUSION},
    {"diffuse_mixed_height", &Solver<Real>::diffuse_mixed_height, EFFECT_PUBLISHED | EFFECT_DIFFUSION},
    {"spread_mixed_water", &Solver<Real>::spread_mixed_water, EFFECT_PUBLISHED | EFFECT_DIFFUSION},
    {"update_water_boundary_types", &Solver<Real>::update_water_boundary_types, EFFECT_PUBLISHED | EFFECT_WATER},
    {"diffuse_mixed_water", &Solver<Real>::diffuse_mixed_water, EFFECT_DIFFUSION, EFFECT_PUBLISHED},
    {"limit_water_outflow", &Solver<Real>::limit_water_outflow, EFFECT_WATER},
    {"compute_water_flux", &Solver<Real>::compute_water_flux, EFFECT_WATER},
    {"account_sides", nullptr, EFFECT_OPEN_SIDES},
    {"integrate_water_height", &Solver<Real>::integrate_water_height, EFFECT_WATER},
    {"infiltrate", &Solver<Real>::infiltrate, EFFECT_INFILTRATION},
    {"measure_layer_exchange", &Solver<Real>::measure_layer_exchange, EFFECT_PUBLISHED | EFFECT_MIXTURE},
    {"extrapolate_velocity", &Solver<Real>::extrapolate_pure_velocity, EFFECT_PUBLISHED | EFFECT_WATER},
    {"backtrace_water_velocity", &Solver<Real>::backtrace_pure_velocity, EFFECT_PUBLISHED | EFFECT_WATER},
    {"transport_mixed_velocity", &Solver<Real>::transport_mixed_velocity, EFFECT_PUBLISHED | EFFECT_MIXTURE},
    {"give_layer_exchange", &Solver<Real>::give_layer_exchange, EFFECT_PUBLISHED | EFFECT_MIXTURE},
    {"push_water", &Solver<Real>::push_water, EFFECT_PUBLISHED | EFFECT_WATER},
    {"center_water_velocity", &Solver<Real>::center_water_velocity, EFFECT_SECOND_ORDER_WATER, EFFECT_PUBLISHED},
    {"integrate_water_velocity", &Solver<Real>::integrate_water_velocity, EFFECT_WATER, EFFECT_PUBLISHED},
    {"carry_foam", &Solver<Real>::carry_foam, EFFECT_FOAM},
    {"wet_ground", &Solver<Real>::wet_ground, EFFECT_WETNESS},
    {"carry_silt", &Solver<Real>::carry_silt, EFFECT_SILT},
    {"compute_bed_load", &Solver<Real>::compute_bed_load, EFFECT_BED_SHEAR},
    {"compute_saturation", &Solver<Real>::compute_saturation, EFFECT_COHESION, EFFECT_PUBLISHED},
    {"open_sand_sides", &Solver<Real>::update_open_sand_sides, EFFECT_OPEN_SIDES | EFFECT_SAND},
    {"update_sand_boundary_types", &Solver<Real>::update_sand_boundary_types, EFFECT_PUBLISHED | EFFECT_SAND},
    {"limit_sand_outflow", &Solver<Real>::limit_sand_outflow, EFFECT_SAND},
    {"compute_sand_flux", &Solver<Real>::compute_sand_flux, EFFECT_SAND},
    {"integrate_sand_height", &Solver<Real>::integrate_sand_height, EFFECT_SAND},
    {"evolve_deformation_gradient", &Solver<Real>::evolve_deformation_gradient, EFFECT_ELASTOPLASTIC, EFFECT_PUBLISHED},
    {"compute_momentum_exchange", &Solver<Real>::compute_momentum_exchange, EFFECT_MIXTURE, EFFECT_PUBLISHED},
    {"project_deformation_gradient", &Solver<Real>::project_deformation_gradient, EFFECT_ELASTOPLASTIC, EFFECT_PUBLISHED},
    {"bend_sand_velocity", &Solver<Real>::bend_sand_velocity, EFFECT_SAND | EFFECT_SLOPE_NORMAL, EFFECT_PUBLISHED},
    {"raise_friction", &Solver<Real>::raise_friction, EFFECT_SAND | EFFECT_FLOW_FRICTION, EFFECT_PUBLISHED},
    {"integrate_sand_velocity", &Solver<Real>::integrate_sand_velocity, EFFECT_SAND, EFFECT_PUBLISHED},
    {"raise_failing_planes", &Solver<Real>::raise_failing_planes, EFFECT_SAND | EFFECT_SLOPE_NORMAL, EFFECT_PUBLISHED},
    {"apply_friction", &Solver<Real>::apply_friction, EFFECT_SAND, EFFECT_PUBLISHED},
    {"extrapolate_sand_velocity", &Solver<Real>::extrapolate_sand_velocity, EFFECT_PUBLISHED | EFFECT_SAND},
    {"backtrace_sand_velocity", &Solver<Real>::backtrace_sand_velocity, EFFECT_PUBLISHED | EFFECT_SAND},
    {"push_sand", &Solver<Real>::push_sand, EFFECT_PUBLISHED | EFFECT_SAND},
    {"yield_right_stretch", &Solver<Real>::yield_right_stretch, EFFECT_PUBLISHED | EFFECT_ELASTOPLASTIC},
    {"advect_deformation_gradient", &Solver<Real>::advect_deformation_gradient, EFFECT_PUBLISHED | EFFECT_ELASTOPLASTIC},
    {"compute_sand_stress", &Solver<Real>::compute_sand_stress, EFFECT_PUBLISHED | EFFECT_ELASTOPLASTIC},
    {"apply_sand_stress", &Solver<Real>::apply_sand_stress, EFFECT_PUBLISHED | EFFECT_ELASTOPLASTIC},
    {"extrapolate_rim_velocity", &Solver<Real>::extrapolate_rim_velocity, EFFECT_PUBLISHED | EFFECT_ELASTOPLASTIC},
    {"stretch_deformation_gradient", &Solver<Real>::stretch_deformation_gradient, EFFECT_PUBLISHED | EFFECT_ELASTOPLASTIC},
    {"extrapolate_strain", &Solver<Real>::extrapolate_strain, EFFECT_PUBLISHED | EFFECT_ELASTOPLASTIC},
    {"apply_frictional_force", &Solver<Real>::apply_frictional_force, EFFECT_PUBLISHED | EFFECT_SAND},
};

// V on a grid of 2^-22, so that V - I is exact in float; a strain that reaches the yield surface and beyond where wanted.
void settle_stretch(Solver<float>& s, bool rough) {
    if (!s.has(EFFECT_ELASTOPLASTIC)) return;
    const auto snap = [](float v) { return std::nearbyint(v * 4194304.0F) / 4194304.0F; };
    const auto axis = s.axis(false);
    for (int j = 0; j < axis.ny; ++j) {
        for (int i = 0; i < axis.nx; ++i) {
            const std::size_t c = axis.cell(i, j);
            const float size = s.sand[c] > 0.0F ? 0.02F : 0.0F;
            if (rough) {
                s.Vxx[c] += size * band_limited(21, i, j);
                s.Vxy[c] += size * band_limited(22, i, j);
                s.Vyy[c] += size * band_limited(23, i, j);
                if (s.has(EFFECT_PUBLISHED)) s.rotation[c] += 20 * size * band_limited(24, i, j);
            }
            s.Vxx[c] = snap(s.Vxx[c]);
            s.Vxy[c] = snap(s.Vxy[c]);
            s.Vyy[c] = snap(s.Vyy[c]);
            s.rotation[c] = snap(s.rotation[c]);
        }
    }
}

// The device gets the diffusive part as a depth, both solvers keep it as a rate: all three start from the same float.
void settle_diffusion(Pilot& pilot) {
    const auto settle = [&](const reference::Field<float>& narrow, reference::Field<double>& wide) {
        for (std::size_t n = 0; n < narrow.size(); ++n) {
            const float depth = pilot.narrow->P.k * narrow[n];
            wide[n] = static_cast<double>(depth) / pilot.wide->P.k;
        }
    };
    settle(pilot.narrow->diffusion_flux.x, pilot.wide->diffusion_flux.x);
    settle(pilot.narrow->diffusion_flux.y, pilot.wide->diffusion_flux.y);
}

Settings without_quantum(Settings settings) {
    settings.method.quantum = 0;
    return settings;
}

} // namespace

References::References(const Scene& scene)
    : narrow(scene.settings, scene.effects), wide(scene.settings, scene.effects),
      unrounded(without_quantum(scene.settings), scene.effects) {
    narrow.load(scene.fields);
    wide.copy_from(narrow);
    unrounded.copy_from(narrow);
}

void References::run_stage(const std::string& stage) {
    const auto run = [&](auto& solver) {
        const bool splits = stage == "limit_water_outflow" && !solver.has(EFFECT_PUBLISHED);
        if (splits || stage == "diffuse_mixed_velocity" || stage == "diffuse_mixed_water") solver.split_water();
        if (stage == "start_water_velocity") return solver.start_water_velocity();
        run_reference_stage(solver, stage);
    };
    run(narrow);
    run(wide);
    run(unrounded);
}

void References::step() {
    narrow.step();
    wide.step();
    unrounded.step();
}

void References::finish_step() {
    ++narrow.step_index;
    ++wide.step_index;
    ++unrounded.step_index;
}

bool has_counterpart(const std::string& stage) {
    return std::any_of(std::begin(steps<float>), std::end(steps<float>),
                       [&](const Step<float>& step) { return stage == step.stage && step.run != nullptr; });
}

template <class Real> void run_reference_stage(Solver<Real>& solver, const std::string& stage) {
    for (const auto& step : steps<Real>) {
        if (stage == step.stage && step.run != nullptr) (solver.*step.run)();
    }
}

template void run_reference_stage(Solver<float>&, const std::string&);
template void run_reference_stage(Solver<double>&, const std::string&);

Pilot make_pilot(const Scene& scene, const std::string& stage) {
    Pilot pilot;
    pilot.narrow = std::make_unique<Solver<float>>(scene.settings, scene.effects);
    pilot.wide = std::make_unique<Solver<double>>(scene.settings, scene.effects);
    Solver<float>& s = *pilot.narrow;
    StepInputs inputs(scene.settings);
    s.load(scene.fields);
    for (int n = 0; n < scene.pilot_steps; ++n) {
        s.step();
        inputs.next(n);
    }
    pilot.input = inputs.next(scene.pilot_steps);
    pilot.input.interpolation = 0.3F;
    pilot.input.point_count = stage == "sample_points" ? sampled_points : 0;
    // A rotation that is rounding alone would prove nothing.
    if (scene.rough_stretch || s.has(EFFECT_PUBLISHED)) settle_stretch(s, true);
    const bool in_step =
        std::any_of(std::begin(steps<float>), std::end(steps<float>), [&](const auto& step) { return stage == step.stage; });
    for (const auto& step : steps<float>) {
        if (!in_step || stage == step.stage) break;
        if (step.run != nullptr && (scene.effects & step.needs) == step.needs && (scene.effects & step.without) == 0)
            (s.*step.run)();
    }
    settle_stretch(s, false);
    pilot.wide->copy_from(s);
    settle_diffusion(pilot);
    return pilot;
}

} // namespace wadi::conformance
