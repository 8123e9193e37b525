#include "engine/step/plan/field_table.hpp"
#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>

namespace wadi {

namespace {

using enum FieldRole;
using enum FieldPlace;
constexpr bool in_hash = true, no_hash = false;
constexpr int no_host = -1;
constexpr std::uint32_t always = 0;

// clang-format off
constexpr FieldRow rows[] = {
    {"terrain", state, cell, no_hash, 0, "H", "m", always, "ground; only edits change it"},
    {"sand_height", state, cell, in_hash, 1, "hs", "m", EFFECT_SAND, "depth of sand on the ground"},
    {"water_height", state, cell, in_hash, 2, "W", "m", EFFECT_WATER, "depth of all water, pure and inside the sand"},
    {"stretch_xx", state, cell, in_hash, 12, "Vxx", "1", EFFECT_ELASTOPLASTIC,
     "left stretch less the identity (published: NUMERICS 2.13)"},
    {"stretch_xy", state, cell, in_hash, 13, "Vxy", "1", EFFECT_ELASTOPLASTIC, ""},
    {"stretch_yy", state, cell, in_hash, 14, "Vyy", "1", EFFECT_ELASTOPLASTIC, ""},
    {"sand_velocity_x", state, west_face, in_hash, 8, "us", "m/s", EFFECT_SAND, "velocity of sand"},
    {"sand_velocity_y", state, south_face, in_hash, 9, "vs", "m/s", EFFECT_SAND, ""},
    {"water_velocity_x", state, west_face, in_hash, 6, "uw", "m/s", EFFECT_WATER,
     "velocity of pure water; without mixture of all water"},
    {"water_velocity_y", state, south_face, in_hash, 7, "vw", "m/s", EFFECT_WATER, ""},
    {"mixed_velocity_x", state, west_face, in_hash, 10, "um", "m/s", EFFECT_MIXTURE, "velocity of the water inside the sand"},
    {"mixed_velocity_y", state, south_face, in_hash, 11, "vm", "m/s", EFFECT_MIXTURE, ""},
    {"rotation", state, cell, in_hash, no_host, "", "rad or 1", EFFECT_ELASTOPLASTIC | EFFECT_PUBLISHED,
     "angle of R, or antisymmetric part of F (NUMERICS 2.13)"},
    {"wedge_depth", state, cell, in_hash, no_host, "hz", "m", EFFECT_SLOPE_NORMAL, "sand above the plane on which it can slide"},
    {"side_memory", rim, none, in_hash, no_host, "", "", EFFECT_WATER | EFFECT_OPEN_SIDES,
     "what waves and outflows have learnt of a stream (NUMERICS 2.9)"},
    {"water_in_pores", state, cell, in_hash, no_host, "", "m", EFFECT_INFILTRATION,
     "water in the pores, -1 where they are full under water (NUMERICS 2.24)"},
    {"surface_foam", state, cell, in_hash, 16, "foam", "1", EFFECT_FOAM, "foam on the water and what it left ashore; 1 covers the cell"},
    {"wetness", state, cell, in_hash, 17, "wet", "1", EFFECT_WETNESS, "how wet the ground is: 1 under water, then drying"},
    {"silt", state, cell, in_hash, 18, "silt", "kg/m2", EFFECT_SILT, "what makes water muddy, per area of the ground"},
    {"roughness", fixed, cell, no_hash, no_host, "", "s/m^(1/3)", EFFECT_ROUGHNESS, "Manning's n beyond that of the material"},
    {"rain_share", fixed, cell, no_hash, no_host, "", "1/65536", EFFECT_RAIN_MAP, "how much falls of the rain where it rains most"},
    {"water_scale", scratch, cell, no_hash, no_host, "", "1", EFFECT_WATER, "outflow limiter of pure water"},
    {"mixed_scale", scratch, cell, no_hash, no_host, "", "1", EFFECT_MIXTURE, "outflow limiter of mixed water"},
    {"sand_scale", scratch, cell, no_hash, no_host, "", "1", EFFECT_SAND, "outflow limiter of sand"},
    {"water_flux_x", scratch, west_face, no_hash, no_host, "", "m", EFFECT_WATER, "depth of pure water moved in the step"},
    {"water_flux_y", scratch, south_face, no_hash, no_host, "", "m", EFFECT_WATER, ""},
    {"mixed_flux_x", scratch, west_face, no_hash, no_host, "", "m", EFFECT_MIXTURE, "depth of mixed water moved in the step"},
    {"mixed_flux_y", scratch, south_face, no_hash, no_host, "", "m", EFFECT_MIXTURE, ""},
    {"sand_flux_x", scratch, west_face, no_hash, no_host, "", "m", EFFECT_SAND, "depth of sand moved in the substep"},
    {"sand_flux_y", scratch, south_face, no_hash, no_host, "", "m", EFFECT_SAND, ""},
    {"mixed_predicted", scratch, cell, no_hash, no_host, "", "m", EFFECT_MIXTURE, "mixed water before the split is taken anew"},
    {"open_sand", scratch, cell, no_hash, no_host, "", "m", EFFECT_INFILTRATION, "depth of sand whose pores hold what is in them, all of it where no water waits above"},
    {"felt_water", scratch, cell, no_hash, no_host, "", "m", EFFECT_INFILTRATION, "water as the sand feels it: without what waits above pores that have room"},
    {"mixed_diffused", scratch, cell, no_hash, no_host, "", "m", EFFECT_DIFFUSION | EFFECT_PUBLISHED, "mixed water that has spread ahead of transport"},
    {"layer_exchange_x", scratch, west_face, no_hash, no_host, "", "m2/s", EFFECT_MIXTURE | EFFECT_PUBLISHED,
     "momentum of water that gets mixed / (area density)"},
    {"layer_exchange_y", scratch, south_face, no_hash, no_host, "", "m2/s", EFFECT_MIXTURE | EFFECT_PUBLISHED, ""},
    {"centered_water_velocity_x", scratch, west_face, no_hash, no_host, "", "m/s", EFFECT_WATER | EFFECT_SECOND_ORDER_WATER,
     "uw at the time of the heights"},
    {"centered_water_velocity_y", scratch, south_face, no_hash, no_host, "", "m/s", EFFECT_WATER | EFFECT_SECOND_ORDER_WATER, ""},
    {"bed_load_x", scratch, west_face, no_hash, no_host, "", "m2/s", EFFECT_BED_SHEAR, "volume flux of bed load per width"},
    {"bed_load_y", scratch, south_face, no_hash, no_host, "", "m2/s", EFFECT_BED_SHEAR, ""},
    {"water_face_type_x", scratch, west_face, no_hash, no_host, "", "1", EFFECT_WATER | EFFECT_PUBLISHED,
     "untracked, tracked or fixed face of pure water"},
    {"water_face_type_y", scratch, south_face, no_hash, no_host, "", "1", EFFECT_WATER | EFFECT_PUBLISHED, ""},
    {"mixed_face_type_x", scratch, west_face, no_hash, no_host, "", "1", EFFECT_MIXTURE | EFFECT_PUBLISHED,
     "untracked, tracked or fixed face of mixed water"},
    {"mixed_face_type_y", scratch, south_face, no_hash, no_host, "", "1", EFFECT_MIXTURE | EFFECT_PUBLISHED, ""},
    {"sand_face_type_x", scratch, west_face, no_hash, no_host, "", "1", EFFECT_SAND | EFFECT_PUBLISHED,
     "untracked, tracked or fixed face of the sand"},
    {"sand_face_type_y", scratch, south_face, no_hash, no_host, "", "1", EFFECT_SAND | EFFECT_PUBLISHED, ""},
    {"extrapolated_velocity_x", scratch, west_face, no_hash, no_host, "", "m/s", EFFECT_PUBLISHED,
     "velocity of one layer, untracked faces filled"},
    {"extrapolated_velocity_y", scratch, south_face, no_hash, no_host, "", "m/s", EFFECT_PUBLISHED, ""},
    {"pressure_x", scratch, west_face, no_hash, no_host, "", "m/s", EFFECT_MIXTURE, "the mixed water's push in one sand substep"},
    {"pressure_y", scratch, south_face, no_hash, no_host, "", "m/s", EFFECT_MIXTURE, ""},
    {"saturation", scratch, cell, no_hash, no_host, "", "1", EFFECT_COHESION, "low-passed saturation of the sand"},
    {"stress_xx", scratch, cell, no_hash, no_host, "", "Pa", EFFECT_ELASTOPLASTIC, "Cauchy stress of the sand"},
    {"stress_xy", scratch, cell, no_hash, no_host, "", "Pa", EFFECT_ELASTOPLASTIC, ""},
    {"stress_yy", scratch, cell, no_hash, no_host, "", "Pa", EFFECT_ELASTOPLASTIC, ""},
    {"cohesive_share", scratch, cell, no_hash, no_host, "", "1", EFFECT_SLOPE_NORMAL | EFFECT_ELASTOPLASTIC,
     "cohesion over what a cliff of this depth needs"},
    {"friction_limit_x", scratch, west_face, no_hash, no_host, "", "m/s", EFFECT_SAND,
     "what friction takes from a velocity in the substep at most"},
    {"friction_limit_y", scratch, south_face, no_hash, no_host, "", "m/s", EFFECT_SAND, ""},
    {"withheld_push_x", scratch, west_face, no_hash, no_host, "", "m/s", EFFECT_SLOPE_NORMAL | EFFECT_WATER,
     "what sand bears uphill in the substep beyond its push"},
    {"withheld_push_y", scratch, south_face, no_hash, no_host, "", "m/s", EFFECT_SLOPE_NORMAL | EFFECT_WATER, ""},
    {"bend_gain_x", scratch, west_face, no_hash, no_host, "", "m/s", EFFECT_SLOPE_NORMAL, "what bends of the ground add to the sand's velocity in the substep"},
    {"bend_gain_y", scratch, south_face, no_hash, no_host, "", "m/s", EFFECT_SLOPE_NORMAL, ""},
    {"bed_lift_x", scratch, west_face, no_hash, no_host, "", "m/s2", EFFECT_SLOPE_NORMAL, "what they add to the gravity that presses sand onto it"},
    {"bed_lift_y", scratch, south_face, no_hash, no_host, "", "m/s2", EFFECT_SLOPE_NORMAL, ""},
    {"source_ledger", ledger, none, no_hash, no_host, "", "quanta", always,
     "what sources, rain and edits moved, 64 bits in two words"},
    {"water_side_ledger", ledger, none, no_hash, no_host, "", "quanta", EFFECT_WATER | EFFECT_OPEN_SIDES,
     "water through the outer faces"},
    {"sand_side_ledger", ledger, none, no_hash, no_host, "", "quanta", EFFECT_SAND | EFFECT_OPEN_SIDES,
     "sand through the outer faces"},
    {"source_shapes", shapes, none, no_hash, no_host, "", "m", EFFECT_SOURCES, "centres, radii and boxes of the sources; boxes of cells that hold them"},
    {"activity", tiles, none, no_hash, no_host, "", "steps", always, "step in which a bit of the tile changed last"},
    {"active_tiles", tiles, none, no_hash, no_host, "", "", always, "which tiles run in this step"},
    {"active_counts", tiles, none, no_hash, no_host, "", "tiles", always, "how many of them in each row of tiles"},
    {"active_list", tiles, none, no_hash, no_host, "", "", always, "their list"},
    {"active_dispatch", tiles, none, no_hash, no_host, "", "groups", always, "groups of an indirect dispatch over the list"},
    {"active_looked", tiles, none, no_hash, no_host, "", "steps", EFFECT_WATER | EFFECT_SAND,
     "step in which a tile was looked into last"},
    {"active_water_seen", tiles, none, no_hash, no_host, "", "steps", EFFECT_WATER | EFFECT_SAND,
     "step in which it was seen to hold water"},
    {"active_sand_seen", tiles, none, no_hash, no_host, "", "steps", EFFECT_WATER | EFFECT_SAND,
     "step in which it was seen to hold sand"},
    {"water_depth", published, cell, no_hash, 3, "hw", "m", always, "pure water above the sand, W - min(W, P)"},
    {"free_surface", published, cell, no_hash, 4, "surface", "m", always, "H + max(D, hs): what a viewer sees"},
    {"surface_saturation", published, cell, no_hash, 5, "phi", "1", always, "D/(D + hs) where there is sand, else 0"},
    {"limits", published, cell, no_hash, 15, "limits", "1", always, "guards that hold the cell in the next step, as bits"},
};
// clang-format on

const FieldRow* find_exactly(std::string_view name) {
    const auto found = std::find_if(std::begin(rows), std::end(rows), [&](const FieldRow& row) { return row.name == name; });
    return found == std::end(rows) ? nullptr : found;
}

} // namespace

std::span<const FieldRow> field_table() { return rows; }

const FieldRow* find_field(std::string_view name) {
    if (const FieldRow* row = find_exactly(name)) return row;
    for (const std::string_view material : {"_water", "_sand", "_mixture"}) {
        if (!name.ends_with(material)) continue;
        const FieldRow* row = find_exactly(name.substr(0, name.size() - material.size()));
        if (row != nullptr && row->role == tiles) return row;
    }
    return nullptr;
}

const FieldRow& field_row(std::string_view name) {
    if (const FieldRow* row = find_field(name)) return *row;
    throw std::logic_error("the field '" + std::string(name) + "' has no row in engine/step/plan/field_table.cpp");
}

const FieldRow* find_host_field(int host) {
    const auto found =
        std::find_if(std::begin(rows), std::end(rows), [&](const FieldRow& row) { return host >= 0 && row.host == host; });
    return found == std::end(rows) ? nullptr : found;
}

} // namespace wadi
