#include "engine/settings/data/setting_table.hpp"
#include "shaders/params.hpp"
#include <algorithm>
#include <iterator>
#include <type_traits>

namespace wadi {

namespace {

// The words of a choice, in the order of its enumerators.
constexpr const char* strain_transports[] = {"polar", "direct"};
constexpr const char* fused_stages[] = {"auto", "always", "never"};

constexpr Values words(std::span<const char* const> names) { return {0, static_cast<double>(names.size()) - 1, names}; }

constexpr Values flag = {0, 1};

constexpr int sides_of_tiles[] = {0, tiles_where_they_gain, tiles_where_cheap, 8, 16, 32, 64};
constexpr Values tile_sides = {0, 64, {}, sides_of_tiles};

constexpr std::uint32_t several = 0; // effects, of which it needs none

template <class Number> constexpr SettingKind kind_of() {
    if (std::is_enum_v<Number>) return SettingKind::choice;
    if (std::is_same_v<Number, bool>) return SettingKind::flag;
    return std::is_same_v<Number, int> ? SettingKind::whole : SettingKind::number;
}

// A member of Settings, or of one of its members.
template <auto... MEMBERS> auto& member(auto& settings) { return (settings.*....*MEMBERS); }

template <auto... MEMBERS>
constexpr SettingAccess at = {kind_of<std::remove_reference_t<decltype(member<MEMBERS...>(std::declval<Settings&>()))>>(),
                              [](const Settings& settings) { return static_cast<double>(member<MEMBERS...>(settings)); },
                              [](Settings& settings, double value) {
                                  auto& to = member<MEMBERS...>(settings);
                                  to = static_cast<std::remove_reference_t<decltype(to)>>(value);
                              }};

template <auto MEMBER> constexpr SettingAccess grid = at<&Settings::grid, MEMBER>;
template <auto MEMBER> constexpr SettingAccess material = at<&Settings::material, MEMBER>;
template <auto MEMBER> constexpr SettingAccess surface = at<&Settings::surface, MEMBER>;
template <auto MEMBER> constexpr SettingAccess method = at<&Settings::method, MEMBER>;
template <std::size_t N>
constexpr SettingAccess saturation = {SettingKind::number,
                                      [](const Settings& settings) { return settings.material.saturation[N]; },
                                      [](Settings& settings, double value) { settings.material.saturation[N] = value; }};

// clang-format off
constexpr Setting rows[] = {
    {"grid.nx", grid<&Grid::nx>, {1, GRID_MOST}, "cells", several, "size of the grid along x, to the east"},
    {"grid.ny", grid<&Grid::ny>, {1, GRID_MOST}, "cells", several, "size of the grid along y, to the north"},
    {"grid.dx", grid<&Grid::dx>, {DX_LEAST, DX_MOST}, "m", several, "side of the square cells"},
    {"dt", at<&Settings::dt>, {DT_LEAST, DT_MOST}, "s", several, "time step; sand takes method.substeps steps in it, water method.water_substeps"},
    {"gravity", at<&Settings::gravity>, {0, 1000}, "m/s2", several, "acceleration of gravity"},
    {"material.water_density", material<&Material::water_density>, {1, 1e5}, "kg/m3", several, "density of water"},
    {"material.sand_density", material<&Material::sand_density>, {1, 1e5}, "kg/m3", several, "density of sand"},
    {"material.friction", material<&Material::friction>, {0, 10}, "", EFFECT_SAND,
     "Coulomb friction of sand on the ground: its slope at rest"},
    {"material.young_modulus", material<&Material::young_modulus>, {0, 1e12}, "Pa", EFFECT_ELASTOPLASTIC,
     "stiffness of sand; 0 = friction only"},
    {"material.poisson_ratio", material<&Material::poisson_ratio>, {0, 0.49}, "", EFFECT_ELASTOPLASTIC,
     "how much sand widens where it is compressed"},
    {"material.yield_friction", material<&Material::yield_friction>, {0.01, 10}, "", EFFECT_ELASTOPLASTIC,
     "tangent of the inner angle of friction: c_f of the yield surface"},
    {"material.cohesion_dry", material<&Material::cohesion_dry>, {0, 1e12}, "Pa", EFFECT_COHESION, "cohesion of dry sand"},
    {"material.cohesion_wet", material<&Material::cohesion_wet>, {0, 1e12}, "Pa", EFFECT_COHESION, "cohesion at saturation phi1"},
    {"material.cohesion_capillary", material<&Material::cohesion_capillary>, {0, 1e12}, "Pa", EFFECT_COHESION,
     "cohesion at phi2; falls to 0 at phi3"},
    {"material.saturation[0]", saturation<0>, {0, 1}, "", EFFECT_COHESION, "phi1, at least 0.001 above 0"},
    {"material.saturation[1]", saturation<1>, {0, 1}, "", EFFECT_COHESION, "phi2, at least 0.001 above phi1"},
    {"material.saturation[2]", saturation<2>, {0, 1}, "", EFFECT_COHESION, "phi3, at least 0.001 above phi2"},
    {"material.exchange_rate", material<&Material::exchange_rate>, {0, 1e15}, "kg/(m3 s)", EFFECT_DRAG,
     "momentum exchange of sand and the water in it"},
    {"material.diffusion_rate", material<&Material::diffusion_rate>, {0, 1e6}, "m2/s", EFFECT_DIFFUSION,
     "diffusion of water in sand"},
    {"material.bed_friction", material<&Material::bed_friction>, {0, 10}, "", EFFECT_BED_FRICTION,
     "c of Chezy's friction of pure water on its bed; 0 = off"},
    {"material.bed_shear", material<&Material::bed_shear>, {0, 10}, "", EFFECT_BED_SHEAR,
     "c of the stress water_density c u^2 of pure water on sand; 0 = off"},
    {"material.grain_size", material<&Material::grain_size>, {1e-6, 1}, "m", EFFECT_BED_SHEAR,
     "coarser sand needs faster water before bed_shear moves it"},
    {"material.slope_normal", material<&Material::slope_normal>, {0, 2}, "", EFFECT_SLOPE_NORMAL,
     "how far weight and friction follow the slope: 1 = normal to it, 0 = level", InDigest::where_set},
    {"material.internal_friction", material<&Material::internal_friction>, {0, 1}, "", EFFECT_INTERNAL_FRICTION,
     "friction within sand that spreads, a share of friction; 0 = off", InDigest::where_set},
    {"material.sand_viscosity", material<&Material::sand_viscosity>, {0, 10}, "m2/s", EFFECT_INTERNAL_FRICTION,
     "viscosity of sand in its plane; 0 = off", InDigest::where_set},
    {"material.retention", material<&Material::retention>, {0, 0.95}, "", EFFECT_RETENTION,
     "depth of water per depth of sand that pores hold back; 0 = none", InDigest::where_set},
    {"material.manning", material<&Material::manning>, {0, MANNING_MOST}, "s/m^(1/3)", EFFECT_BED_FRICTION,
     "Manning's n of the bed under pure water, beside bed_friction; 0 = off", InDigest::where_set},
    {"material.bed_adhesion", material<&Material::bed_adhesion>, {0, 1}, "", EFFECT_ELASTOPLASTIC,
     "share of its cohesion with which sand clings to the ground under it; 0 = none", InDigest::where_set},
    {"material.flow_friction", material<&Material::flow_friction>, {0, 10}, "", EFFECT_FLOW_FRICTION,
     "what friction rises to in thin fast sand; no more than friction = to nothing", InDigest::where_set},
    {"material.flow_length", material<&Material::flow_length>, {0, 10}, "m", EFFECT_FLOW_FRICTION,
     "thickness of sand below which friction rises, a few grains; 0 = it never does", InDigest::where_set},
    {"material.flow_beta", material<&Material::flow_beta>, {0.01, 10}, "", EFFECT_FLOW_FRICTION,
     "how little deep sand feels of it: 0.65 for sand, 0.136 for glass beads", InDigest::where_set},
    {"material.flow_gamma", material<&Material::flow_gamma>, {0, 10}, "", EFFECT_FLOW_FRICTION,
     "what sand at rest feels of it, as a Froude number: 0.77 for sand, 0 for glass beads", InDigest::where_set},
    {"material.porosity", material<&Material::porosity>, {0.01, 1}, "", EFFECT_MIXTURE,
     "share of the sand that is pores, 0.4 for sand; 1 = as large as the sand", InDigest::where_set},
    {"material.conductivity", material<&Material::conductivity>, {0, 10}, "m/s", EFFECT_INFILTRATION,
     "how fast water that stands on sand enters it, 1e-4 for sand; 0 = at once", InDigest::where_set},
    {"material.suction", material<&Material::suction>, {0, 10}, "m", EFFECT_INFILTRATION,
     "head with which dry sand draws water in", InDigest::where_set},
    {"method.substeps", method<&Method::substeps>, {1, 64}, "", EFFECT_SAND, "sand substeps per water step"},
    {"method.water_substeps", method<&Method::water_substeps>, {1, WATER_SUBSTEPS_MOST}, "", EFFECT_WATER,
     "water substeps per step, ahead of the sand's", InDigest::where_set},
    {"method.outflow_limiter", method<&Method::outflow_limiter>, flag, "", several, "no cell gives away more than it has"},
    {"method.quantum", method<&Method::quantum>, {-1, 1e6}, "m", several,
     "heights are multiples of it, a power of two; -1 = chosen, 0 = off"},
    {"method.largest_height", method<&Method::largest_height>, {1e-3, 1e6}, "m", several,
     "largest column of terrain, sand and water"},
    {"method.dry_threshold", method<&Method::dry_threshold>, {1e-12, 1}, "m", several, "shallower cells are dry"},
    {"method.velocity_clamp", method<&Method::velocity_clamp>, {0.01, 1e6}, "", several,
     "speeds stay below velocity_clamp * dx / dt, dt of the substep"},
    {"method.gravity_cap", method<&Method::gravity_cap>, {0, 1e6}, "", EFFECT_WATER,
     "slows waves that dt cannot follow; 0 = off"},
    {"method.sand_gravity_cap", method<&Method::sand_gravity_cap>, {0, 1e6}, "", EFFECT_SAND, "gravity_cap of sand; 0 = off"},
    {"method.elastic_cap", method<&Method::elastic_cap>, {0, 1e6}, "", EFFECT_ELASTOPLASTIC,
     "softens sand that the sand substep cannot follow; 0 = off"},
    {"method.shock_viscosity", method<&Method::shock_viscosity>, {0, 1}, "", EFFECT_WATER,
     "keeps bores from ringing; smooth waves pass; 0 = off"},
    {"method.bulk_viscosity", method<&Method::bulk_viscosity>, {0, 1e3}, "m2/s", EFFECT_ELASTOPLASTIC,
     "damps waves of stress in sand; 0 = off"},
    {"method.rest_rule", method<&Method::rest_rule>, flag, "", EFFECT_WATER,
     "water level within two height quanta, and as slow as one push of them, stands"},
    {"method.passive_pressure", method<&Method::passive_pressure>, {0, 1e6}, "", EFFECT_ELASTOPLASTIC,
     "compression that sand bears, in units of its weight; 0 = off"},
    {"method.gradient_clamp", method<&Method::gradient_clamp>, {0, 1e6}, "", EFFECT_ELASTOPLASTIC,
     "largest strain increment of a sand substep; 0 = off"},
    {"method.cohesion_cap", method<&Method::cohesion_cap>, {0, 1e6}, "", EFFECT_COHESION,
     "largest tension that cohesion bears / (sand_density g depth); 0 = off"},
    {"method.prestress", method<&Method::prestress>, flag, "", EFFECT_ELASTOPLASTIC,
     "sand drawn, poured or stamped starts in balance if cohesion holds it", InDigest::where_set},
    {"method.saturation_smoothing", method<&Method::saturation_smoothing>, {0, 2}, "cells", EFFECT_COHESION,
     "radius of the low-pass of saturation"},
    {"method.water_transport_order", method<&Method::water_transport_order>, {1, 2}, "", EFFECT_WATER,
     "2: heights and flux-form velocities move with limited slopes"},
    {"method.sand_transport_order", method<&Method::sand_transport_order>, {1, 2}, "", EFFECT_SAND,
     "2: heights and flux-form velocities of sand move with limited slopes", InDigest::where_set},
    {"method.strain_transport", method<&Method::strain_transport>, words(strain_transports), "", EFFECT_ELASTOPLASTIC,
     "published: angle and stretch move apart, or F as it is", InDigest::where_set},
    {"surface.foam_half_life", surface<&Surface::foam_half_life>, {0, FADING_MOST}, "s", EFFECT_FOAM,
     "time after which half of the foam is left; 0 = it never fades", InDigest::where_set},
    {"surface.foam_energy", surface<&Surface::foam_energy>, {FOAM_ENERGY_LEAST, 1e9}, "J/m2", EFFECT_FOAM,
     "energy that breaking water loses to cover itself with foam", InDigest::where_set},
    {"surface.wetness_half_life", surface<&Surface::wetness_half_life>, {0, FADING_MOST}, "s", EFFECT_WETNESS,
     "time after which ground is half dry; 0 = it never dries", InDigest::where_set},
    {"surface.silt_speed", surface<&Surface::silt_speed>, {SILT_SPEED_LEAST, 100}, "m/s", EFFECT_SILT,
     "speed past sand above which water 1 m deep gets muddy", InDigest::where_set},
    {"surface.silt_rate", surface<&Surface::silt_rate>, {0, 1000}, "kg/(m2 s)", EFFECT_SILT,
     "silt that rises where the stress is twice that of this speed", InDigest::where_set},
    {"surface.silt_settling", surface<&Surface::silt_settling>, {0, 100}, "m/s", EFFECT_SILT,
     "speed at which silt sinks; 0 = water never clears", InDigest::where_set},
    {"active_tiles", at<&Settings::active_tiles>, tile_sides, "cells", several,
     "side of tiles, left out at rest; 0 = off, 1, 2 = where that gains", InDigest::no},
    {"fused_stages", at<&Settings::fused_stages>, words(fused_stages), "", several,
     "several stages in one pass; auto: where the device gains from it", InDigest::no},
};
// clang-format on

const Settings& defaults() {
    static const Settings untouched;
    return untouched;
}

} // namespace

std::string_view Setting::object() const {
    const std::string_view text = path;
    const auto dot = text.find('.');
    return dot == text.npos ? "" : text.substr(0, dot);
}

std::string_view Setting::key() const {
    const std::string_view text = path;
    return text.substr(text.find('.') + 1); // npos + 1 = 0
}

double Setting::normal() const { return at.get(defaults()); }

bool Setting::required() const { return normal() < values.least; }

std::span<const Setting> setting_table() { return rows; }

const Setting* find_setting(std::string_view path) {
    const auto found = std::find_if(std::begin(rows), std::end(rows), [&](const Setting& s) { return path == s.path; });
    return found == std::end(rows) ? nullptr : found;
}

const std::vector<std::string>& side_names() {
    static const std::vector<std::string> names = {"west", "east", "south", "north"};
    return names;
}

} // namespace wadi
