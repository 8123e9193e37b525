// The paper's Algorithm 1, line by line (NUMERICS 2.12 to 2.15, 2.21, 2.22); its stages: shaders/stages/published.
#include "engine/step/plan/plan_builder.hpp"

namespace wadi {

namespace {

// Semi-Lagrangian transport of one layer's velocities, by the boundary types from before its height moved (NUMERICS 2.12).
void plan_backtrace(PlanBuilder& b, const std::string& layer, const char* backtrace) {
    const std::string velocity = layer + "_velocity_", type = layer + "_face_type_";
    const Names names = {
        {"velocity_x", velocity + "x"}, {"velocity_y", velocity + "y"}, {"face_type_x", type + "x"}, {"face_type_y", type + "y"}};
    b.run("extrapolate_velocity", {}, names);
    b.run(backtrace, {velocity + "x", velocity + "y"}, names);
}

// What has spread ahead of transport is moved as mixed water, whether the sand is that high or not.
Names spread_heights(const PlanBuilder& b) {
    return b.has(EFFECT_DIFFUSION) ? Names{{"sand_height", "mixed_diffused"}} : Names{};
}

// Momentum of water that changes layer, from velocities ahead of advection to those behind it (NUMERICS 2.21).
Names exchange_over(const std::string& before, const std::string& after) {
    return {{"sand_before", before}, {"sand_after", after}};
}

// Project_ and Evolve_Deformation_Gradient, behind the sand's new height.
void plan_strain(PlanBuilder& b) {
    const std::vector<std::string> strain = {"stretch_xx", "stretch_xy", "stretch_yy", "rotation"};
    const Names moved = {{"sand_height", next_name("sand_height")}};
    b.run("yield_right_stretch", {}, moved);
    b.run("advect_deformation_gradient", strain);
    b.run("compute_sand_stress", {}, moved);
    b.run("apply_sand_stress", {}, moved);
    b.run("update_sand_boundary_types", {}, moved);
    b.run("extrapolate_velocity", {},
          {{"velocity_x", "sand_velocity_x"},
           {"velocity_y", "sand_velocity_y"},
           {"face_type_x", "sand_face_type_x"},
           {"face_type_y", "sand_face_type_y"}});
    Names stretched = moved;
    stretched.merge(Names{{"sand_velocity_x", "extrapolated_velocity_x"}, {"sand_velocity_y", "extrapolated_velocity_y"}});
    b.run("stretch_deformation_gradient", {}, stretched);
    b.run("extrapolate_strain", strain, moved);
}

} // namespace

// Diffuse_Mixed_Water.
void plan_published_diffusion(PlanBuilder b) {
    if (!b.has(EFFECT_DIFFUSION)) return;
    b.run("diffuse_mixed_velocity", {"mixed_velocity_x", "mixed_velocity_y"});
    b.run("diffuse_mixed_height");
    b.run("spread_mixed_water");
}

void plan_published_water(PlanBuilder b) {
    if (!b.has(EFFECT_WATER)) return;
    b.run("update_water_boundary_types", {}, spread_heights(b));
    // Integrate_Water_Height
    b.run("limit_water_outflow", {}, spread_heights(b));
    b.run("compute_water_flux", {}, spread_heights(b));
    if (b.has(EFFECT_OPEN_SIDES)) account_water(b);
    b.run("integrate_water_height", {"water_height"}, spread_heights(b));
    if (b.has(EFFECT_MIXTURE)) b.run("measure_layer_exchange", {}, exchange_over("mixed_predicted", "sand_height"));
    // Integrate_Water_Velocity
    std::vector<std::string> moved = {"water_velocity_x", "water_velocity_y"};
    plan_backtrace(b, "water", "backtrace_water_velocity");
    if (b.has(EFFECT_MIXTURE)) {
        moved.insert(moved.end(), {"mixed_velocity_x", "mixed_velocity_y"});
        plan_backtrace(b, "mixed", "backtrace_water_velocity");
        b.run("give_layer_exchange", {}, exchange_over("mixed_predicted", "sand_height"));
    }
    b.run("push_water", moved);
    if (b.has(EFFECT_BED_SHEAR)) b.run("compute_bed_load");
}

void plan_published_sand(PlanBuilder b) {
    if (!b.has(EFFECT_SAND)) return;
    if (b.has(EFFECT_OPEN_SIDES)) b.run("open_sand_sides");
    b.run("update_sand_boundary_types");
    plan_sand_height(b); // Integrate_Sand_Height
    // Integrate_Sand_Velocity
    plan_backtrace(b, "sand", "backtrace_sand_velocity");
    Names push = drag_names(b);
    push.emplace("sand_height", next_name("sand_height"));
    b.run("push_sand", {}, push);
    if (b.has(EFFECT_ELASTOPLASTIC)) plan_strain(b);
    if (!b.has(EFFECT_MIXTURE)) return;
    for (const char* stage : {"measure_layer_exchange", "give_layer_exchange"}) { // Compute_Momentum_Exchange
        b.run(stage, {}, exchange_over("sand_height", next_name("sand_height")));
        b.only_where_both_run();
    }
}

void plan_published_friction(PlanBuilder b) {
    if (b.has(EFFECT_SAND)) b.run("apply_frictional_force", {"sand_velocity_x", "sand_velocity_y"}, drag_names(b));
}

} // namespace wadi
