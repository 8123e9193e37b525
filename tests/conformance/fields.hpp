// Between Wadi's fields (one ghosted layout, V - I, pitch) and the reference solver's dense arrays.
#pragma once
#include "shaders/stage_table.hpp"
#include "tests/reference/solver.hpp"
#include <string>
#include <vector>

namespace wadi::conformance {

/// A binding of a stage as a field of the step plan: "drag_velocity_x_next" under the mixture is mixed_velocity_x.
struct FieldName {
    std::string base;  // plan name
    bool next = false; // the binding is the "_next" buffer
};
FieldName field_of(const std::string& stage, const std::string& binding, std::uint32_t effects);

/// Where a field has values: velocities and fluxes on faces, all else in cells.
bool on_faces(const std::string& base);
/// True for what stays between steps: ghosts hold 0 (terrain: the edge), while a scratch field has values in its extent only.
bool is_state(const std::string& base);

/// Index range of a field's values: FACES or CELLS.
compute::Range2 values_of(const std::string& base, const WorldParams& params);

/// A reference field in Wadi's layout, zero outside its range. `stage` decides what a name means at that moment:
/// sand_height is the height before the substep's transport for the stages that also read sand_height_next, and the mixed flux
/// is the diffusive part before compute_water_flux. Before a stage (`after` false) or after it.
template <class Real>
std::vector<Real> reference_field(const reference::Solver<Real>& solver, const std::string& stage, const FieldName& name,
                                  bool after);

/// Fills the ghosts a state field must have: 0, the terrain's edge, and the water outside open sides.
template <class Real> void fill_ghosts(std::vector<Real>& field, const std::string& base, const reference::Solver<Real>& solver);

extern template std::vector<float> reference_field(const reference::Solver<float>&, const std::string&, const FieldName&, bool);
extern template std::vector<double> reference_field(const reference::Solver<double>&, const std::string&, const FieldName&, bool);
extern template void fill_ghosts(std::vector<float>&, const std::string&, const reference::Solver<float>&);
extern template void fill_ghosts(std::vector<double>&, const std::string&, const reference::Solver<double>&);

} // namespace wadi::conformance
