// What a world is made of: grid, material, method, sides, sources. Plain data in SI units with defaults; the level
// loader fills it from JSON, hosts fill it by hand. validate() checks every field and names field and range.
#pragma once
#include "engine/compute/status.hpp"
#include "engine/settings/data/edit.hpp"
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace wadi {

/// Cell-centred grid. Row j = 0 is the south side, column i = 0 the west side.
struct Grid {
    int nx = 0;
    int ny = 0;
    double dx = 0;
};

/// Sand and water properties. Sources: paper Table 1 and section 3.3; values NUMERICS.md section 4.
struct Material {
    double water_density = 1000;
    double sand_density = 2000;
    double friction = 0.5; // mu
    double young_modulus = 2e5;
    double poisson_ratio = 0.3;
    double yield_friction = 0.4; // c_f
    double cohesion_dry = 0;     // c0
    double cohesion_wet = 8.5e3; // c1
    double cohesion_capillary = 8.5e3;
    std::array<double, 3> saturation = {0.2, 0.25, 0.33};
    double exchange_rate = 1e5; // c_e
    double diffusion_rate = 0.01;
    double bed_shear = 0;
    double grain_size = 1e-3;
    double bed_friction = 0;        // c of NUMERICS 2.4
    double slope_normal = 1;        // chi of NUMERICS 2.18
    double internal_friction = 0.4; // b of NUMERICS 2.18, a share of friction
    double sand_viscosity = 0.05;   // nu of NUMERICS 2.18, in the plane
    double retention = 0.4925;      // r of NUMERICS 2.19: W/hs that pores hold back
    double manning = 0;             // n of NUMERICS 2.4
    double bed_adhesion = 1;        // a of NUMERICS 2.8
    double flow_friction = 0.95;    // mu_2 of NUMERICS 2.8
    double flow_length = 0;         // L of NUMERICS 2.8; 0 = friction is the same at every speed
    double flow_beta = 0.65;        // beta, gamma of NUMERICS 2.8
    double flow_gamma = 0.77;
    double porosity = 1;     // n of NUMERICS 2.23; 1 = pores as large as the sand
    double conductivity = 0; // K of NUMERICS 2.24; 0 = water enters pores at once
    double suction = 0.05;   // psi of NUMERICS 2.24
    friend bool operator==(const Material&, const Material&) = default;
};

/// What moves with the sand of its deformation gradient F in the method published (NUMERICS 2.13): the angle of R and the right
/// stretch P apart (F = R P), or F as it is.
enum class StrainTransport : std::uint8_t { polar, direct };

inline constexpr int WATER_SUBSTEPS_MOST = 8; // each has an input of its own in one submission

/// How water and sand are stepped. Every guard is off at a neutral value, so that any one can be studied alone.
struct Method {
    std::string name = "robust";
    int substeps = 3;               // T
    int water_substeps = 1;         // N: the water's passes of a step, each of dt/N
    bool outflow_limiter = true;    // NUMERICS 2.2
    double quantum = -1;            // NUMERICS 2.2
    double largest_height = 16;     // of H + hs + W
    double dry_threshold = 1e-5;    // eps
    double velocity_clamp = 0.35;   // alpha: |u| <= alpha dx/dt
    double gravity_cap = 0.55;      // NUMERICS 2.4b
    double sand_gravity_cap = 0.25; // NUMERICS 2.7
    double elastic_cap = 0.2;       // lambda + 2 mu <= elastic_cap rho_s dx^2/dts^2
    double shock_viscosity = 0.25;  // c1 of NUMERICS 2.3
    double bulk_viscosity = 0;      // NUMERICS 2.7
    bool rest_rule = true;          // NUMERICS 2.4e
    double passive_pressure = 1;    // K of the compression cap, NUMERICS 2.7
    double gradient_clamp = 0.4;    // largest |dts grad v| entry
    double cohesion_cap = 0.9;      // tension <= cohesion_cap rho_s g hs, NUMERICS 2.7
    bool prestress = true;          // NUMERICS 2.20
    int saturation_smoothing = 2;
    StrainTransport strain_transport = StrainTransport::polar; // direct: published only
    int water_transport_order = 1;                             // NUMERICS 2.2, 2.3, 2.16
    int sand_transport_order = 1;                              // the same

    bool published() const { return name == "published"; }
};

/// What water carries and leaves behind to be seen; moves nothing. NUMERICS 2.25 to 2.27.
struct Surface {
    double foam_half_life = 4;
    double foam_energy = 500;
    double wetness_half_life = 30;
    double silt_speed = 0.7;
    double silt_rate = 0.005;
    double silt_settling = 0.01;
};

/// A value over time: linear between samples, constant outside. One sample = constant.
struct TimeSeries {
    std::vector<std::pair<double, double>> samples; // (time [s], value), times increasing
    double at(double time) const;
    friend bool operator==(const TimeSeries&, const TimeSeries&) = default;
};

enum class SideKind : std::uint8_t { wall, discharge, level, outflow, brink, waves };
enum class SideName : std::uint8_t { west, east, south, north };

/// One side of the domain; open between `from` and `to` along it, wall elsewhere.
struct Side {
    SideKind kind = SideKind::wall;
    double from = 0;      // [m] from the side's south or west end
    double to = 1e30;     // [m]
    TimeSeries value;     // discharge [m3/s] into the domain, or free surface outside [m]
    double depth = 0;     // of a discharge while it is less than its critical depth [m]; 0: critical or what stands inside
    TimeSeries wave = {}; // of waves: elevation of what comes in [m]; none: still
    double slope = 0;     // of an outflow: fall of the ground beyond; 0: that of the bed inside
    double sediment = -1; // bed load, in shares of what the water there can carry; negative: all that leaves, none that enters
    double absorb = 0; // of level and waves [s]: what is shorter leaves; 0: a level holds, waves take it from the grid's length

    bool has_level() const { return kind == SideKind::level || kind == SideKind::waves; }
};

enum class SourceShape : std::uint8_t { point, disc, box };
enum class SourceMaterial : std::uint8_t { water, sand };

/// A source (or sink, where the rate is negative) of water or sand.
struct Source {
    SourceShape shape = SourceShape::disc;
    SourceMaterial material = SourceMaterial::water;
    std::array<double, 2> center = {0, 0};    // point and disc [m]
    double radius = 0;                        // disc [m]
    std::array<double, 4> box = {0, 0, 0, 0}; // x0, y0, x1, y1 [m]
    TimeSeries rate;                          // depth per time [m/s], where there is no discharge
    bool set_velocity = false;
    std::array<double, 2> velocity = {0, 0}; // forced on the water's faces inside while the rate is positive [m/s]
    TimeSeries discharge = {};               // volume per time, shared by the cells that it covers [m3/s]
    TimeSeries level = {}; // surface that a source of water holds in each cell [m]; rate or discharge is then the most it brings
    bool drain = false;    // with a level: takes away what stands above, too
    friend bool operator==(const Source&, const Source&) = default;
};

/// What of its settings may change while a world runs.
struct LiveSettings {
    Material material;
    std::vector<Source> sources;
    friend bool operator==(const LiveSettings&, const LiveSettings&) = default;
};

/// What the level wants of one effect: derived from content, or forced.
enum class Force : std::uint8_t { automatic, on, off };

/// Whether a step's stages run fused; automatic: where the device gains from it (engine/step/README.md).
enum class FusedStages : std::uint8_t { automatic, always, never };

/// Settings::active_tiles: tiles of chosen_tile_side cells while little of the world is awake; and the same only with fused
/// stages, in large grids, and where that takes an eighth more memory at most.
inline constexpr int tiles_where_they_gain = 1, tiles_where_cheap = 2, chosen_tile_side = 32;

/// Everything but the fields themselves. Units, ranges and meaning of what is one number, flag or choice: setting_table.cpp.
struct Settings {
    Grid grid;
    double dt = 0;
    double gravity = 9.81;
    Material material;
    Method method;
    Surface surface;
    std::array<Side, 4> sides;                          // indexed by SideName
    std::vector<Source> sources;                        // at most MAX_SOURCES (32)
    TimeSeries rain;                                    // [m/s]
    TimeSeries evaporation;                             // [m/s]
    std::vector<ScriptedEdit> edits;                    // at most 1000; the world queues them itself
    std::vector<std::pair<std::string, Force>> effects; // names of shaders/effect_rows.hpp
    /// Bits of the effects that the host draws: foam, wetness and silt are on by themselves where it does.
    std::uint32_t drawn_effects = 0;
    /// What each cell adds to material.manning, 0 ... 1 s/m^(1/3), in the order of InitialFields; empty = nothing.
    std::vector<float> roughness;
    /// How many times `rain` falls on each cell, 0 ... RAIN_TIMES_MOST, in the order of InitialFields; empty = once everywhere.
    std::vector<float> rain_map;
    /// Tiles in which nothing changes any more are left out of a step. How a world is run, not what it is: every bit stays, also
    /// in snapshots and between worlds that have it and that do not.
    int active_tiles = tiles_where_cheap; // side [cells]; 0 = off; the two words above: the world chooses while it runs
    /// Every bit stays.
    FusedStages fused_stages = FusedStages::automatic;
    /// What the water's passes take for dt: the time step over method.water_substeps [s].
    double water_dt() const { return dt / method.water_substeps; }
    LiveSettings live() const { return {material, sources}; }
    void set_live(const LiveSettings& live) {
        material = live.material;
        sources = live.sources;
    }
    /// Of active tiles [cells]; 0 = there are none.
    int tile_side() const {
        return active_tiles == tiles_where_they_gain || active_tiles == tiles_where_cheap ? chosen_tile_side : active_tiles;
    }
};

/// Initial fields in row-major nx * ny order, row 0 in the south; empty = zero everywhere.
struct InitialFields {
    std::vector<float> terrain;    // H [m]
    std::vector<float> sand;       // hs, depth of sand on the terrain [m]
    std::vector<float> water;      // W, depth of all water [m]
    std::vector<float> velocity_x; // of water and mixed water at cell centres [m/s]
    std::vector<float> velocity_y;
    std::vector<float> sand_velocity_x; // [m/s]
    std::vector<float> sand_velocity_y;
};

/// Q: the height quantum the settings ask for [m]; 0 = plain float (NUMERICS 2.2).
double height_quantum(const Method& method);

} // namespace wadi
