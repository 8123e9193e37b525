// The numbers of Material and Method with their names in a level file and their ranges. One table for the loader, for
// validate() and for the test of the schema. Units and meaning: engine/settings/settings.hpp.
#pragma once
#include "engine/settings/settings.hpp"
#include <string>
#include <vector>

namespace wadi {

template <class Owner, class Number> struct SettingField {
    const char* name;
    Number Owner::*member;
    Number least;
    Number most;
};

inline constexpr SettingField<Material, double> MATERIAL_FIELDS[] = {
    {"water_density", &Material::water_density, 1, 1e5},
    {"sand_density", &Material::sand_density, 1, 1e5},
    {"friction", &Material::friction, 0, 10},
    {"young_modulus", &Material::young_modulus, 0, 1e12},
    {"poisson_ratio", &Material::poisson_ratio, 0, 0.49},
    {"yield_friction", &Material::yield_friction, 0.01, 10},
    {"cohesion_dry", &Material::cohesion_dry, 0, 1e12},
    {"cohesion_wet", &Material::cohesion_wet, 0, 1e12},
    {"cohesion_capillary", &Material::cohesion_capillary, 0, 1e12},
    {"exchange_rate", &Material::exchange_rate, 0, 1e15},
    {"diffusion_rate", &Material::diffusion_rate, 0, 1e6},
    {"bed_friction", &Material::bed_friction, 0, 10},
    {"bed_shear", &Material::bed_shear, 0, 10},
    {"grain_size", &Material::grain_size, 1e-6, 1},
};

inline constexpr SettingField<Method, double> METHOD_FIELDS[] = {
    {"quantum", &Method::quantum, -1, 1e6},
    {"largest_height", &Method::largest_height, 1e-3, 1e6},
    {"dry_threshold", &Method::dry_threshold, 1e-12, 1},
    {"velocity_clamp", &Method::velocity_clamp, 0.01, 1e6},
    {"gravity_cap", &Method::gravity_cap, 0, 1e6},
    {"gravity_cap_least", &Method::gravity_cap_least, 0, 1e6},
    {"sand_gravity_cap", &Method::sand_gravity_cap, 0, 1e6},
    {"elastic_cap", &Method::elastic_cap, 0, 1e6},
    {"shock_viscosity", &Method::shock_viscosity, 0, 1},
    {"bulk_viscosity", &Method::bulk_viscosity, 0, 1},
    {"rest_surface", &Method::rest_surface, 0, 1},
    {"rest_velocity", &Method::rest_velocity, 0, 100},
    {"passive_pressure", &Method::passive_pressure, 0, 1e6},
    {"gradient_clamp", &Method::gradient_clamp, 0, 1e6},
    {"cohesion_cap", &Method::cohesion_cap, 0, 1e6},
    {"stress_taper", &Method::stress_taper, 0, 1e3},
};

inline constexpr SettingField<Method, int> METHOD_COUNTS[] = {
    {"substeps", &Method::substeps, 1, 64},
    {"saturation_smoothing", &Method::saturation_smoothing, 0, 2},
    {"water_transport_order", &Method::water_transport_order, 1, 2},
};

/// What semi-Lagrangian transport can follow: it looks one cell back.
inline constexpr double SEMI_LAGRANGIAN_CLAMP_MOST = 1;

inline constexpr int GRID_MOST = 16384;
inline constexpr double DX_LEAST = 1e-4, DX_MOST = 1e4; // [m]
inline constexpr double DT_LEAST = 1e-7, DT_MOST = 100; // [s]
inline constexpr double GRAVITY_MOST = 1000;            // [m/s2]
inline constexpr double RAIN_MOST = 1;                  // rain and evaporation [m/s]
inline constexpr double RATE_MOST = 1e4;                // of a source [m/s]
inline constexpr double SPEED_MOST = 1e4;               // set by a source or as an initial velocity [m/s]
inline constexpr double DISCHARGE_MOST = 1e9;           // through a side [m3/s]
inline constexpr std::size_t EDITS_MOST = 1000;         // of a level
inline constexpr double EDIT_TIME_MOST = 1e9;           // of a level's edit [s]
inline constexpr double EDIT_EVERY_LEAST = 1e-3;        // [s]
inline constexpr double SATURATION_GAP = 1e-3;          // least distance of 0, phi1, phi2 and phi3

/// Names as level files write them; sides are indexed by SideName.
const std::vector<std::string>& effect_names();
const std::vector<std::string>& side_names();
const std::vector<std::string>& velocity_transport_names();
const std::vector<std::string>& strain_transport_names();
const std::vector<std::string>& drag_friction_names();
const std::vector<std::string>& diffusion_names();

} // namespace wadi
