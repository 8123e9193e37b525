// The two parameter blocks of every stage, shared by the host and by all three stage compilers.
// Only 4-byte scalars, and arrays of whole vec4 at 16-byte offsets, so that the C++ struct and the std140 block
// have the same layout (checked by static_assert in shaders/params.hpp).
#ifndef WADI_STEP_PARAMS_H
#define WADI_STEP_PARAMS_H

#define GHOST 2          // ghost cells on each side of every field
#define LEAD 32          // elements ahead of cell 0 of the first row and behind the last row: rows begin at multiples of 32
#define STRIP 32         // rows of one ledger strip
#define MAX_SOURCES 32   // sources and sinks of one world
#define SOURCE_VECTORS (4 * MAX_SOURCES) // vec4 of all shapes and of the boxes that hold them
#define MAX_EDITS 16     // edits of one submission
#define STAMP_PAGE 1024  // floats; the image of a stamp begins at a multiple of it
#define EDIT_BRUSH 0
#define EDIT_STAMP 1
#define EDIT_PUSH 2
#define EDIT_BALANCE 3   // the engine's own
#define LAYER_TERRAIN 0
#define LAYER_SAND 1
#define LAYER_WATER 2
#define POINT_ROW 64     // points in one row of a POINTS stage
#define FUSED_COLUMNS 32 // cells that one group of a fused stage covers along x; sides of active tiles are multiples or parts of it
#define FUSED_ROWS 16    // and along y
#define MAX_WAKES 36     // rectangles of active tiles that one step wakes: all sources and all sides have room
#define LEAST_GRAVITY_CAP 0.15f // what gravity_cap comes down to in fast water, NUMERICS 2.4b
#define FULL_PORES (-1.0f) // water_in_pores of sand that is full under water, NUMERICS 2.24
#define SAMPLE_FLOATS 12 // results per point of sample_points
#define SOURCE_DISC 0
#define SOURCE_BOX 1
#define MATERIAL_WATER 0
#define MATERIAL_SAND 1
#define SIDE_WALL 0
#define SIDE_DISCHARGE 1
#define SIDE_LEVEL 2
#define SIDE_OUTFLOW 3
#define SIDE_BRINK 4
#define SIDE_WAVES 5      // and a level that lets waves out
#define SIDE_REACH 64       // cells whose bed says how the ground falls at an outflow
#define SIDE_SLOPE_LEAST 1.0e-3f // and how much it does at least
#define SIDE_SLOPE_EVERY 16 // steps from one look at it to the next
#define SIDE_WEST 0
#define SIDE_EAST 1
#define SIDE_SOUTH 2
#define SIDE_NORTH 3
#define LIMIT_WORDS 15   // results per tile of count_limits
// Ledger rows: each holds a 64-bit count of quanta in two words (low, high), one per strip and column.
#define LEDGER_WATER_IN 0
#define LEDGER_WATER_OUT 1
#define LEDGER_SAND_IN 2
#define LEDGER_SAND_OUT 3
#define LEDGER_REFUSED 4 // depth of sources, rain and edits refused because a column would pass the declared largest height
#define LEDGER_ENTRIES 5

// What is fixed for a world until it is re-recorded. At most 512 bytes. SI units.
struct WorldParams {
    int nx;                     // cells along x
    int ny;                     // cells along y
    int pitch;                  // floats from one row to the next
    int strips;                 // ledger strips: ceil((ny + 1) / STRIP)
    int source_count;
    int source_boxes;           // boxes of cells that hold all sources; no two overlap
    int source_rows;            // rows of one column in a piece of a box
    int source_pieces;          // of all boxes
    int side_kind_west;         // SIDE_*
    int side_kind_east;
    int side_kind_south;
    int side_kind_north;
    float dx;                   // cell size [m]
    float inv_dx;               // 1/dx [1/m]
    float gravity;              // [m/s2]

    float quantum;              // Q: every height is a multiple of it [m]; 0 = plain float
    float inv_quantum;          // 1/Q, 0 when Q = 0 [1/m]
    float inv_ledger_quantum;   // quanta per metre in the ledger [1/m]
    float largest_height;       // declared largest column H + hs + W [m]
    float dry_threshold;        // eps [m]
    float film;                 // sand no deeper than this has no velocity [m]

    // water substep, dtw = dt/N; dt in what follows is dtw
    float k;                    // dt/dx [s/m]
    float water_velocity_clamp; // alpha dx/dt [m/s]
    float shock_viscosity;      // c1 dt sqrt(g)/dx [1/sqrt(m)], NUMERICS 2.3; 0 = off
    float gravity_cap_base;     // 0.55 in NUMERICS 2.4b (dimensionless), at least LEAST_GRAVITY_CAP; 1e9 = no cap
    float inv_k2;               // 1/k^2 [m2/s2]
    float rest_surface;         // eta_rest [m]; negative = rule off
    float rest_velocity;        // v_rest [m/s]; negative = rule off
    float diffusion_number;     // min(c_d, 0.2 dx^2/dt) dt/dx^2; diffusion_ahead: c_d dt/dx^2
    float bed_friction_dt;      // dt c of Chezy's law, c dimensionless [s]
    float manning;              // n of Manning's law [s/m^(1/3)]
    float gravity_dt;           // dt g [m/s]
    float bed_shear;            // c of the shear stress rho_w c |u|^2 of pure water on sand
    float bed_shear_dt;         // dt c: what the water loses by it [s]
    float bed_shear_threshold;  // stress over rho_w below which sand stays [m2/s2]
    float bed_load;             // 8/((rho_s/rho_w - 1) g) [s2/m]
    float bed_slope_number;     // 2/dx: how the bed's slope turns bed load downhill [1/m]
    float bed_slope_cap;        // keeps that stable: 0.2 dx over the step [m/s]
    float limiter;              // 1 = outflow limiter on, 0 = off
    float water_drag;           // dt c_e [kg/m3]
    float step_k;               // k of the whole step, N k [s/m]
    float inv_step_k2;          // 1/step_k^2 [m2/s2]
    float inv_substeps;         // N/T: water substeps per sand substep
    float infiltration;         // dt K: depth that enters dry sand by its weight alone [m]
    float suction;              // psi: head with which dry sand draws water in [m]
    float foam_birth;           // rho_w dt/(2 E dx): cover born in a step per depth, wave speed and squared compression [s3/m4]
    float foam_fade;            // share of the foam that fades in a step
    float wetness_fade;         // share of the wetness that dries in a step
    float silt_fall;            // dt w_s: how far silt sinks in a step [m]
    float silt_rate;            // dt M: picked up in a step where the stress is twice the least one [kg/m2]
    float inv_silt_speed2;      // 1 over the squared speed of 1 m of water that has the least one [s2/m2]

    // sand substep
    float ks;                   // dts/dx [s/m]
    float dts;                  // the step over T [s]
    float sand_velocity_clamp;  // alpha dx/dts [m/s]
    float sand_gravity_cap;     // 0.25/ks^2 [m2/s2]; 1e30 = no cap
    float density_ratio;        // rho_w/rho_s
    float water_density;        // [kg/m3]
    float sand_density;         // [kg/m3]
    float friction;             // mu of sand on the ground
    float drag_kd;              // dts c_e [kg/m3]
    float drag_coupling;        // rho_w kd/((rho_w + kd) rho_s): kappa per depth of mixed water over depth of sand
    float drag_share;           // kd/(rho_w + kd): how far drag takes mixed water to the sand's velocity
    float slope_normal;         // chi of NUMERICS 2.18
    float wedge_slope;          // s*: slope of the face behind which Coulomb's wedge pushes most
    float wedge_slope2;         // its square
    float wedge_weight;         // C there: 1/(1 + chi s*^2)
    float plane_slope2;         // square of the slope s_p of the plane on which a wedge of sand gains most
    float plane_rise;           // s_p dx [m]
    float inv_plane_rise;       // its inverse
    float plane_fall;           // what friction leaves of the push on it, (s_p - mu)/(1 + chi s_p^2), times dx [m]
    float friction_fall;        // mu dx [m]
    float inv_dts;              // 1/dts [1/s]
    float inner_friction;       // c_f within the sand
    float rankine;              // s_f = tan(45 deg + phi_f/2)
    float passive;              // Rankine's coefficient of passive earth pressure, tan^2(45 deg + phi/2): how many times its own push sand bears
    float bed_adhesion;         // a: share of the cohesion with which sand clings to its ground
    float adhesion_slip;        // what it takes from a velocity in a substep, per cohesive share [m/s], NUMERICS 2.8
    float flow_rise;            // (mu_2 - mu)/mu: what friction rises by at most, as a share of it (NUMERICS 2.8)
    float flow_length;          // L [m]
    float flow_beta;
    float flow_gamma;
    float cliff_share;          // 4/(c_f rho_s g): share of the cohesion that a cliff needs, per cohesion over depth [m/Pa]
    float internal_friction;    // b: friction within spreading sand, a share of mu
    float viscosity_number;     // nu dts/dx^2 of sand in its plane, at most what the explicit step bears beside bulk_viscosity
    float porosity;             // n: share of the sand that is pores (NUMERICS 2.23); 1 without mixture and in `published`
    float inv_porosity;
    float buoyancy;             // beta: share of the sand that displaces water, 1 - n, 1 for n = 1
    float pressed_grains;       // share of the sand on whose grains a sloping surface of water pushes: 1 - n, 0 without drag
    float retained;             // r: share of its pores in which sand holds water back
    float inv_drainable;        // 1/(1 - r)
    float prestress;            // 1: sand starts in balance, NUMERICS 2.20; 0: unstrained

    // elastoplastic sand
    float lambda;               // Lame's first parameter after the elastic cap [Pa]
    float shear;                // shear modulus after the elastic cap [Pa]
    float inv_two_shear;        // 1/(2 shear)
    float yield_slope;          // A = c_f (2 shear + 2 lambda) [Pa]
    float inv_yield_slope;
    float inv_bulk;             // 1/(lambda + shear)
    float passive_pressure;     // K rho_s g [Pa/m]; 1e30 = compression uncapped
    float bulk_viscosity;       // viscous stress per difference of face velocities [Pa s/m], NUMERICS 2.7
    float tip_pressure;         // largest mean tension per cohesion: 1/(2 c_f)
    float inv_friction_yield;   // 1/c_f
    float force_scale;          // ks/rho_s
    float gradient_clamp;       // largest |dts grad v| entry (0.4)
    float cohesion_cap;         // 1.8 c_f rho_s g [Pa/m]: largest cohesion per metre of sand
    float cohesion0;            // of the yield surface: 4 c_f tan(45 + phi/2) times the material's, published: the material's [Pa]
    float cohesion1;
    float phi1;                 // saturations of the piecewise linear cohesion
    float phi2;
    float phi3;
    float slope01;              // (c1 - c0)/phi1
    float slope12;              // (c2 - c1)/(phi2 - phi1)
    float slope23;              // c2/(phi3 - phi2)
    // Active tiles
    int tile_size;              // side [cells]; 0 = every cell runs
    int tile_rings;             // tiles around a changed one that run in the two steps after it
    int tile_columns;           // of all tiles, the last column and row of faces included
    int tile_rows;

    float smooth0;              // weights of the saturation low-pass at distance 0, 1, 2 cells
    float smooth1;
    float smooth2;
};

// One edit, lengths in cells; what another kind has is 0.
struct EditInput {
    float from_x;               // start of a brush or push, low corner of a rectangle (stamp, balance, values)
    float from_y;
    float along_x;              // from there to the end, or the rectangle's size
    float along_y;
    int kind;                   // EDIT_*
    int layer;                  // LAYER_*
    float amount;               // brush [m], stamp [m per unit of its image], push: its strength, balance: 1 adds it, -1 takes it
    float velocity_x;           // of a push [m/s]
    float velocity_y;
    float radius;               // of a brush or push
    float inv_fade;             // 1/width of its falloff
    float inv_length2;          // 1/length^2 from start to end, 0 for a disc
    int rim_parts;              // of a brush with a hard rim: parts of a cell's side that it counts; 0 = it fades
    int columns;                // of a stamp's image
    int rows;
    int page;                   // where that begins among the images
};

// What changes with every water step. At most 2304 bytes.
struct StepInput {
    int step;                   // index of the step
    float rain;                 // depth of rain in this step [m], a whole number of quanta
    float evaporation;          // largest depth that evaporates in this step [m]
    float interpolation;        // of published outputs: 0 = previous, 1 = current
    vec4 source[MAX_SOURCES];   // depth added or taken [m], face velocity x, y [m/s], 1 if set; with a level: most, level [m], 1 if it drains
    vec4 side[4];               // west, east, south, north: discharge per width [m2/s], level [m] or an outflow's slope,
                                // least ghost depth (negative: the ghost depth) or the wave's elevation [m],
                                // first and last index of the open span
    vec4 side_pace[4];          // of waves: dt over the time below which they leave (0: by the grid); share of bed load; z: open_sides
    EditInput edit[MAX_EDITS];
    vec4 mapped_rain;           // under a rain map: depth of rain where it rains most in this step [m], a whole number of quanta; quanta of it before, modulo 65536
    vec4 wake[MAX_WAKES];       // tiles woken in this step: first column, row, last column, row
    int edit_count;             // edits in this submission of apply_edits
    int point_count;            // points of a POINTS stage
    int wake_count;
    float phase;                // of rounding to whole quanta, in [0, 1) (NUMERICS 2.2)
};
#endif
