// The reference solver: the equations of engine/NUMERICS.md (section numbers in the comments are its sections),
// written without looking at the stages, in float or double. Plain loops, every intermediate field public, so that a
// single stage can be compared with a backend's. Choices where the page is silent: README.md.
#pragma once
#include "engine/settings/data/settings.hpp"
#include "tests/reference/grid.hpp"
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace wadi::reference {

/// Numbers that stay fixed while the time step does, in the solver's own precision.
template <class Real> struct Constants {
    Real dx{}, dt{}, substep{};       // [m], [s], [s]: substep = dt / T
    Real k{}, k_sand{};               // dt/dx, substep/dx [s/m]
    Real gravity{};                   // [m/s2]
    Real rho_w{}, rho_s{};            // [kg/m3]
    Real friction{};                  // mu of Coulomb friction
    Real yield_friction{};            // c_f
    Real rankine{};                   // s_f of 2.7
    Real adhesion{};                  // a of 2.8
    Real fast_friction{};             // mu_2 of 2.8
    Real flow_length{}, flow_beta{};  // L [m], beta of 2.8
    Real flow_gamma{};                // gamma of 2.8
    Real porosity{};                  // n of 2.23
    Real conductivity{}, suction{};   // K [m/s], psi [m] of 2.24
    Real displaces{}, pressed{};      // beta, share of grains that a sloping surface of water pushes (2.23)
    Real c0{}, c1{}, c2{};            // cohesion of the yield surface [Pa]
    Real yield_cohesion{};            // its share of the material's
    Real phi1{}, phi2{}, phi3{};      // saturation
    Real exchange{};                  // c_e [kg/(m3 s)], 0 without the drag effect
    Real diffusion{};                 // min(c_d, 0.2 dx2/dt) [m2/s]
    Real bed_friction{};              // c of Chezy's law, 0 without its effect
    Real manning{};                   // n of the material [s/m^(1/3)]
    Real bed_shear{};                 // c, 0 without its effect
    Real bed_threshold{}, bed_rate{}; // [m2/s2], [s2/m]
    Real lambda{}, shear{};           // Lame constants [Pa], capped (2.7)
    Real eps{}, film{};               // dry threshold, and that of moving sand [m]
    Real quantum{}, largest_height{}; // [m]; quantum 0 = plain arithmetic
    Real clamp{}, clamp_sand{};       // alpha dx/dt, alpha dx/substep [m/s]
    Real alpha{};                     // the clamp's factor
    Real gravity_cap{}, sand_gravity_cap{};
    Real rest_surface{}, rest_velocity{}; // [m], [m/s]
    Real passive_pressure{}, gradient_clamp{}, cohesion_cap{};
    Real shock_viscosity{}; // c1 of 2.3
    Real viscosity{};       // bulk viscosity of sand [Pa s], bounded for stability (2.7)
    Real chi{}, wedge{};    // 2.18: slope-normal factor, slope s* of Coulomb's wedge (infinite without chi)
    Real plane{};           // 2.18: slope s_p of the failing plane
    Real spread_friction{}; // 2.18: b, share of mu
    Real shear_number{};    // 2.18: nu substep/dx^2 of the in-plane viscosity, bounded for stability
    Real retained{};        // 2.19: share of the pores that hold back
    int substeps{};
    int smoothing{}; // radius of the saturation's low-pass [cells]
    bool limiter{};
};

template <class Real> class Solver {
  public:
    /// `mask` is a legal combination of shaders/effects.h bits; elastoplastic needs young_modulus > 0.
    Solver(const Settings& world, std::uint32_t mask);

    /// Sets the state; heights are rounded to the nearest quantum, face velocities are means of the two cells.
    void load(const InitialFields& fields);
    /// Takes over state, intermediate fields and running totals of a solver of the same scene in either precision.
    template <class Other> void copy_from(const Solver<Other>& other);
    /// Changes the time step (convergence studies); the state stays.
    void set_time_step(double dt);
    /// One water step with its T sand substeps.
    void step();

    // Stages, in the order in which step() calls them.
    void mix_source_momentum();
    void apply_sources();
    void apply_rain();
    void dilute_water_velocity();
    void update_open_sides();                    // 2.9, water
    void start_water_velocity();                 // 2.16, in step 0 -> pure_velocity
    void open_pores();                           // 2.24 -> open_sand
    void split_water();                          // mixed = min(W, P), pure = W - mixed
    void update_water_boundary_types();          // 2.12 -> pure_type, mixed_type
    void diffuse_mixed_velocity();               // 2.15 -> mixed_velocity
    void diffuse_mixed_water();                  // 2.1 -> diffusion_flux
    void limit_water_outflow();                  // 2.2 -> pure_scale, mixed_scale
    void compute_water_flux();                   // 2.2 -> pure_flux, mixed_flux
    void integrate_water_height();               // 2.2 -> water, pure_predicted, mixed_predicted, pure, mixed
    void extrapolate_pure_velocity();            // 2.12 -> extrapolated
    void backtrace_pure_velocity();              // 2.12 -> pure_velocity
    void transport_mixed_velocity();             // both for the mixed water
    void damp_shocks(const Faces<Real>& before); // 2.3
    void infiltrate();                           // 2.24 -> pore_water, mixed, pure
    void center_water_velocity();                // 2.16 -> centered_velocity, pure_flux
    void integrate_water_velocity();             // 2.3, 2.4 -> pure_velocity, mixed_velocity, mixed_push
    void carry_foam();                           // 2.25 -> foam
    void wet_ground();                           // 2.26 -> wetness
    void carry_silt();                           // 2.27 -> silt
    void compute_bed_load();                     // 2.11 -> bed_load
    void compute_saturation();                   // 2.7 -> saturation
    void update_open_sand_sides();               // 2.9, sand: in every substep
    void update_sand_boundary_types();           // 2.12 -> sand_type
    void limit_sand_outflow();                   // 2.2 -> sand_scale
    void compute_sand_flux();                    // 2.2 -> sand_flux
    void integrate_sand_height();                // 2.5 -> sand, sand_before, pure, mixed, mixed_before
    void evolve_deformation_gradient();          // 2.5, 2.6 -> Vxx, Vxy, Vyy
    void project_deformation_gradient();         // 2.7 -> Vxx, Vxy, Vyy, sxx, sxy, syy, cohesive_share
    void extrapolate_sand_velocity();            // 2.12 -> extrapolated
    void backtrace_sand_velocity();              // 2.12 -> sand_velocity
    void bend_sand_velocity();                   // 2.3 -> bend_gain, bed_lift
    void raise_friction();                       // 2.8 -> bed_lift
    void integrate_sand_velocity();              // 2.3, 2.7, 2.4c, 2.18 -> sand_velocity, friction_limit, withheld_push
    void raise_failing_planes();                 // 2.18 -> wedge_depth
    void advect_deformation_gradient();          // 2.13 -> Vxx, Vxy, Vyy, rotation
    void stretch_deformation_gradient();         // 2.13, after the velocity -> Vxx, Vxy, Vyy, rotation
    void compute_momentum_exchange();            // 2.4a after the sand height, then mixed_push on mixed_velocity
    void apply_friction();                       // 2.8 -> sand_velocity, mixed_velocity (pure_velocity in the single-layer mask)
    // 2.21, water as the paper has it
    void diffuse_mixed_height();   // -> mixed
    void spread_mixed_water();     // -> water
    void measure_layer_exchange(); // from mixed_predicted to mixed -> layer_exchange
    void give_layer_exchange();    // -> pure_velocity, mixed_velocity
    void push_water();             // 2.4b to d without guards -> pure_velocity, mixed_velocity
    // 2.22, sand by Algorithm 1
    void push_sand();                // -> sand_velocity, mixed_velocity (pure_velocity in the single-layer mask)
    void yield_right_stretch();      // -> Vxx, Vxy, Vyy
    void compute_sand_stress();      // -> sxx, sxy, syy
    void apply_sand_stress();        // -> sand_velocity
    void extrapolate_rim_velocity(); // of the sand behind its stress -> extrapolated
    void extrapolate_strain();       // -> Vxx, Vxy, Vyy, rotation
    void apply_frictional_force();   // -> sand_velocity, mixed_velocity (pure_velocity in the single-layer mask)

    bool has(std::uint32_t effect) const { return (effects & effect) != 0; }
    Axis axis(bool is_y) const { return {is_y, settings.grid.nx, settings.grid.ny}; }
    double time() const { return static_cast<double>(step_index) * settings.dt; }

    Settings settings;
    std::uint32_t effects;
    Constants<Real> P;
    std::int64_t step_index = 0;

    // State (section 1). Velocities of walls are 0. Without mixture pure_velocity is the velocity of all water.
    Field<Real> terrain, sand, water; // H, hs, W [m]
    Field<Real> Vxx, Vxy, Vyy;        // left stretch of the sand; 2.13: right stretch, or F's symmetric part
    Field<Real> rotation;             // 2.13: angle, or (Fyx - Fxy)/2
    Field<Real> wedge_depth;          // 2.18: sand above the failing plane [m]
    Field<Real> pore_water;           // 2.24: what pores hold at most, -1 where they are full under water [m]
    Field<Real> foam, wetness, silt;  // 2.25 to 2.27
    Faces<Real> sand_velocity, pure_velocity, mixed_velocity; // us, uw, um [m/s]

    // Intermediate fields. Fluxes are depths per step, k q [m].
    Field<Real> pure, mixed; // h_w, M; without mixture pure = W is the water layer
    Field<Real> pure_predicted, mixed_predicted;
    Field<Real> pure_scale, mixed_scale, sand_scale;
    Faces<Real> diffusion_flux; // q_D [m2/s]
    Faces<Real> pure_flux, mixed_flux, sand_flux;
    Faces<Real> centered_velocity;                // uw at the time of the heights [m/s]
    Faces<Real> bed_load;                         // [m2/s]
    Faces<Real> mixed_push;                       // d_f, pressure's change of um per sand substep [m/s]
    Faces<Real> layer_exchange;                   // 2.21: momentum that mixed water gains, per area and density [m2/s]
    Faces<Real> pure_type, mixed_type, sand_type; // boundary types: 0 untracked, 1 tracked, 2 fixed
    Faces<Real> extrapolated;                     // velocity of one layer
    Field<Real> saturation;                       // phibar
    Field<Real> open_sand, felt_water;            // 2.24: what the stages of water and sand take for hs and W
    Field<Real> mixed_diffused;                   // 2.21: mixed water that has spread ahead of transport [m]
    Field<Real> sand_before, mixed_before;        // hs^n and min(W, P^n)
    Field<Real> sxx, sxy, syy;                    // Cauchy stress [Pa]
    Field<Real> cohesive_share;                   // R of 2.18, 0 without elastoplastic
    Faces<Real> friction_limit, withheld_push;    // 2.18: N, k_sand g_f (K - C r) d (1 - r^ f) [m/s]
    Faces<Real> bend_gain, bed_lift;              // 2.3: of bends: what they add to us [m/s], g_b [m/s2]
    Field<Real> roughness;                        // of each cell beyond P.manning [s/m^(1/3)]
    std::array<Field<Real>, 3> from_sources;      // by sources of water in this step: depth, and its momentum along x and y
    Real rained{};                                // depth of rain in this step [m], under a map where it rains most
    double rain_peak = 1;                         // how many times settings.rain that is
    Field<Real> rain_share;                       // of it on each cell, in 1/65536
    Faces<Real> ghost_water;                      // depth outside the open sides [m], on boundary faces
    struct SideMemory {                           // 2.9, state of an outer face
        Real stream{};                            // waves: the stream's velocity outward [m/s]
        Real error{}, mean{};                     // outflow: e and m
        Real rise{}, above{};                     // of the bed's line: per cell inward, above the last cell's bed [m]
    };
    struct RimMemory {
        std::vector<SideMemory> x, y;
        std::vector<SideMemory>& along(const Axis& axis) { return axis.is_y ? y : x; }
        const std::vector<SideMemory>& along(const Axis& axis) const { return axis.is_y ? y : x; }
    };
    RimMemory side_memory;

    // What sources, rain and open sides added, as sums of depths [m]: exact in double with a quantum.
    double water_added = 0;
    double sand_added = 0;
    bool mean_corner_shear = false; // negative control of 2.7: shear at corners from mean heights
    std::int64_t refused = 0;       // cell additions that would have passed the declared largest height

    /// 2.20: strain V* - 1 of sand `depth` deep with `held` of water at which it is in balance.
    Real balance(Real depth, Real held) const;

  private:
    using Side = wadi::Side;
    template <class Other> friend class Solver;
    enum class Layer : std::uint8_t { pure, mixed, sand };
    std::size_t cells() const { return terrain.size(); }
    /// f(axis, a, b) for every face between two cells.
    template <class F> void for_inner_faces(F f) const;

    /// 2.2: what a step adds to a flux, in quanta, before it is cut to whole ones.
    Real rounding_phase(Layer layer, const Axis& ax, std::size_t face) const;
    Real raw_flux(Layer layer, const Axis& axis, int a, int b) const;
    void limit_outflow(Layer layer, Real k, Field<Real>& scale) const;
    void limited_flux(Layer layer, Real k, const Field<Real>& scale, Faces<Real>& flux) const;
    /// Depth that the four fluxes add to cell (i, j).
    Real gain(const Faces<Real>& flux, int i, int j) const;
    const Faces<Real>& velocity_of(Layer layer) const;
    Real face_depth(Layer layer, const Axis& axis, int a, int b, Real u) const;
    void advect(std::uint32_t second_order, const Field<Real>& height, const Faces<Real>& flux, const Faces<Real>& carried,
                Real k, Faces<Real>& velocity) const;
    void advect_velocity_second_order(const Field<Real>& height, const Faces<Real>& flux, const Faces<Real>& carried, Real k,
                                      Faces<Real>& velocity) const;
    void advect_velocity(const Field<Real>& height, const Faces<Real>& flux, Faces<Real>& velocity) const;
    struct Corners {
        bool within = false, south = false, north = false; // south and north along x: on the sides of low and high numbers
        bool any() const { return within || south || north; }
    };
    Corners corners(const Faces<Real>& velocity, const Axis& ax, int a, int b) const;
    template <class Height, class Surface> void update_types(Height height, Surface surface, Faces<Real>& type) const;
    void extrapolate(const Faces<Real>& velocity, const Faces<Real>& type);
    void backtrace(const Faces<Real>& type, Real k, Faces<Real>& velocity) const;
    void exchange_split(const Field<Real>& mixed_old, const Field<Real>& pure_old, const Field<Real>& mixed_new);
    Real water_gravity(Real fastest, Real deepest) const;
    Real bed_drag(std::size_t L, std::size_t R, Real depth) const;
    Real friction_rate(std::size_t L, std::size_t R) const;
    Real depth_beside(std::size_t from, std::size_t to) const;
    void enter_sand(Real& uw, Real& um, std::size_t L, std::size_t R, Real beside) const;
    Real sand_gravity(Real deepest) const;
    Real across_face(const Faces<Real>& velocity, const Axis& axis, int a, int b) const; // mean of the four around
    void water_face(const Faces<Real>& pure_old, const Faces<Real>& mixed_old, const Axis& axis, int a, int b);
    void advect_stretch();
    std::array<Real, 4> velocity_gradient(const Field<Real>& depth, int i, int j) const; // substep * (xx, xy, yx, yy)
    void stretch_by_velocity_gradient(int i, int j);
    Real cohesion(Real phi, Real depth) const;
    Real least_stress(Real depth, Real coh, Real k) const;
    void change_strain(std::size_t cell, Real added);
    void bound_balance();
    /// 2.18: C and r of a face, 1 and 1 without slope_normal, and how much of its cohesion clings to the ground; d is the rise of
    /// the bed of sand across it.
    struct Slope {
        Real d, C, r, clings, q;
    };
    struct Course {
        Real u, w, a, e; // velocity along and across a face [m/s], slope of the ground along and across
    };
    Course course_at(const Faces<Real>& velocity, const Axis& axis, int a, int b) const;
    bool beyond_head(const Faces<Real>& old, const Axis& axis, int a, int b, Real u) const;
    Real wedge_share(std::size_t left, std::size_t right) const;
    Real wedge_push(const Axis& axis, int a, int b, const Slope& slope, Real own) const;
    Slope slope_at(const Axis& axis, int a, int b) const;
    Real open_rise(const Axis& axis, int a, int b, bool of_ground) const;
    Real culmann_excess(Real slope) const;
    Real culmann_share(Real slope, Real bed, Real C_bed, Real at_rest, Real in_one_cell) const;
    Real deeper_cohesion(std::size_t left, std::size_t right) const;
    /// 2.19 and 2.8: of a face's sand the depth with full pores and that of water held above, as shares.
    struct Pores {
        Real full, held;
    };
    Pores pores_at(std::size_t left, std::size_t right) const;
    Real full_depth(Real sand_depth, Real stands) const;
    Real pore_room(Real depth) const;
    Real standing(Real held, Real depth) const;
    Real standing(std::size_t cell) const;
    Real in_pores(std::size_t cell) const;
    static constexpr Real surface_quantum = Real(1) / Real(1048576); // of 2.25
    Real open_water(std::size_t cell) const;
    static Real less_share(Real amount, Real share, Real least);
    Real after_fading(Real amount, double half_life, Real least) const;
    Field<Real> drift(const Field<Real>& held, const Field<Real>& moves, Real pace) const;
    bool waits(std::size_t cell) const;
    Real seen_depth(std::size_t cell) const;
    Real transport_depth(std::size_t cell) const;
    Real pure_surface(std::size_t cell) const;
    Real coupled_depth(std::size_t cell) const;
    Real open_depth(std::size_t cell) const;
    Real water_surface(std::size_t cell) const;
    Real felt_surface(std::size_t cell) const;
    Real water_at_level(std::size_t cell, Real level) const;
    Real lifts(std::size_t one, std::size_t other) const;
    Real stressed(Real cohesive) const;
    Real level_friction(const Axis& axis, int a, int b) const;
    Real adhesion(std::size_t left, std::size_t right) const;
    Real shared_depth(std::size_t one, std::size_t other) const;
    Real thinnest(const Field<Real>& height) const; // of faces that move
    Real relative_permeability(std::size_t cell) const;
    Real diffusion(const Axis& axis, int a, int b) const; // 2.1 through an inner face [m2/s]
    void slow_from_within(const Faces<Real>& old, const Axis& axis, int a, int b);
    void shear_in_plane(const Faces<Real>& old, const Axis& axis, int a, int b);
    void add_stress(const Axis& axis, int a, int b);
    void add_gravity(const Faces<Real>& old, const Axis& axis, int a, int b);
    Real sand_load(std::size_t cell) const;
    struct Stretch {
        Real xx, xy, yy;
    };
    static bool strain_of(const Stretch& stretch, Real& tr, Real& dd, Real& dxy);
    Stretch right_stretch_of(std::size_t cell, Real& cs, Real& sn) const;
    void set_right_stretch(std::size_t cell, const Stretch& stretch, Real cs, Real sn);
    void step_robust();
    void step_published();
    void step_published_water();
    void step_published_sand();

    double quanta(double& total, double amount) const;
    void add_depth(Field<Real>& field, std::size_t cell, Real amount, double& ledger);
    void apply_source(const Source& source, double& total);
    /// f(side, axis, far end) for the four sides.
    template <class F> void for_sides(F f);
    bool in_span(const Side& side, int b) const;
    void leave(Faces<Real>& velocity, const Axis& axis, bool far_end, int b, Real fastest) const;
    Real capacity(Real speed) const; // 2.11: bed load of water so fast [m2/s]
    void open_bed_load(const Side& side, const Axis& axis, bool far_end, int b);
    std::pair<Real, Real> bed_line(const Axis& axis, bool far_end, int b) const;
    void run_off(const Axis& axis, bool far_end, int b, Real given);
    void seep(const Axis& axis, int a, int b, Real level, Real gain);
    void update_side(const Side& side, const Axis& axis, bool far_end);
    Real clear_depth(std::size_t N, Real level) const;
    Real beside_level(std::size_t N, Real level, Real u) const;
    Real level_face(const Axis& axis, int a, int b, Real level);
    Real waves_face(const Axis& axis, int a, int b, Real still, Real level, Real absorbs);
    void fall(const Axis& axis, bool far_end, int b);

    std::vector<double> source_totals_; // depth given so far, before rounding to quanta [m]
    double rain_total_ = 0;
    double evaporation_total_ = 0;
    std::array<double, 4> side_totals_{}; // of discharges
};

/// Linear between samples, constant outside; 0 without samples.
double sample(const TimeSeries& series, double time);

extern template class Solver<float>;
extern template class Solver<double>;
extern template void Solver<float>::copy_from(const Solver<float>&);
extern template void Solver<double>::copy_from(const Solver<float>&);

} // namespace wadi::reference
