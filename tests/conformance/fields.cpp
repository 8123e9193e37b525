#include "tests/conformance/fields.hpp"
#include "engine/step/plan/field_table.hpp"
#include <algorithm>
#include <map>

namespace wadi::conformance {

namespace {

using reference::Faces;
using reference::Field;
using reference::Solver;

template <class Real> const Field<Real>* cell_field(const Solver<Real>& s, const std::string& base) {
    const std::map<std::string, const Field<Real>*> fields = {
        {"terrain", &s.terrain},
        {"sand_height", &s.sand},
        {"water_height", &s.water},
        {"stretch_xx", &s.Vxx},
        {"stretch_xy", &s.Vxy},
        {"stretch_yy", &s.Vyy},
        {"rotation", &s.rotation},
        {"water_scale", &s.pure_scale},
        {"mixed_scale", &s.mixed_scale},
        {"sand_scale", &s.sand_scale},
        {"saturation", &s.saturation},
        {"mixed_predicted", &s.mixed_predicted},
        {"stress_xx", &s.sxx},
        {"stress_xy", &s.sxy},
        {"stress_yy", &s.syy},
        {"cohesive_share", &s.cohesive_share},
        {"roughness", &s.roughness},
        {"mixed_diffused", &s.mixed},
        {"wedge_depth", &s.wedge_depth},
        {"rain_share", &s.rain_share},
        {"water_in_pores", &s.pore_water},
        {"open_sand", &s.open_sand},
        {"felt_water", &s.felt_water},
        {"surface_foam", &s.foam},
        {"wetness", &s.wetness},
        {"silt", &s.silt},
    };
    const auto found = fields.find(base);
    return found == fields.end() ? nullptr : found->second;
}

template <class Real> const Faces<Real>* face_field(const Solver<Real>& s, const std::string& layer) {
    const std::map<std::string, const Faces<Real>*> fields = {
        {"water_velocity", &s.pure_velocity},  {"mixed_velocity", &s.mixed_velocity},
        {"sand_velocity", &s.sand_velocity},   {"water_flux", &s.pure_flux},
        {"mixed_flux", &s.mixed_flux},         {"sand_flux", &s.sand_flux},
        {"pressure", &s.mixed_push},           {"bed_load", &s.bed_load},
        {"water_face_type", &s.pure_type},     {"mixed_face_type", &s.mixed_type},
        {"sand_face_type", &s.sand_type},      {"extrapolated_velocity", &s.extrapolated},
        {"bend_gain", &s.bend_gain},           {"bed_lift", &s.bed_lift},
        {"friction_limit", &s.friction_limit}, {"withheld_push", &s.withheld_push},
        {"layer_exchange", &s.layer_exchange}, {"centered_water_velocity", &s.centered_velocity},
    };
    const auto found = fields.find(layer);
    return found == fields.end() ? nullptr : found->second;
}

bool ends_with_axis(const std::string& base) { return base.ends_with("_x") || base.ends_with("_y"); }

// The stages between the sand's transport and the flip of its height read both heights.
bool reads_both_heights(const std::string& stage) {
    return stage == "evolve_deformation_gradient" || stage == "advect_deformation_gradient" ||
           stage == "compute_momentum_exchange";
}

bool mixed_flux_is_diffusion(const std::string& stage, bool after) {
    return stage == "diffuse_mixed_water" || stage == "limit_water_outflow" || (stage == "compute_water_flux" && !after);
}

} // namespace

FieldName field_of(const std::string& stage, const std::string& binding, std::uint32_t effects) {
    FieldName name{binding, binding.ends_with("_next")};
    if (name.next) name.base.resize(name.base.size() - 5);
    const bool mixture = (effects & EFFECT_MIXTURE) != 0;
    if (name.base.starts_with("centered_mixed")) name.base = name.base.substr(9);
    if (name.base.starts_with("drag_velocity")) name.base = (mixture ? "mixed" : "water") + name.base.substr(4);
    if ((stage == "publish_velocity" || stage == "publish_flow" || stage == "start_water_velocity") &&
        name.base.starts_with("velocity"))
        name.base = "water_" + name.base;
    if (stage == "extrapolate_velocity" || stage.starts_with("backtrace_")) { // one layer's: the reference has run the same
        const char* layer = stage == "backtrace_sand_velocity" ? "sand_" : "water_";
        if (name.base.starts_with("velocity") || name.base.starts_with("face_type")) name.base = layer + name.base;
    }
    if (name.base == "sand_before") name.base = "mixed_predicted"; // as in the water step
    if (name.base == "sand_after") name.base = "sand_height";
    if (stage == "stretch_deformation_gradient" && name.base.starts_with("sand_velocity"))
        name.base = "extrapolated" + name.base.substr(4);
    if (stage == "account_sides" && name.base.starts_with("flux")) name.base = "water_" + name.base;
    // Stages that read published fields, or velocities that were tried: any fields do, equal in some places and not in others.
    const std::map<std::string, const char*> stand_ins = {{"previous_output", "sand_height"},
                                                          {"current_output", "water_height"},
                                                          {"tried_velocity_x", "water_flux_x"},
                                                          {"tried_velocity_y", "water_flux_y"}};
    const std::map<std::string, const char*> surfaces = {{"sand_surface", "terrain"},
                                                         {"previous_sand_surface", "terrain"},
                                                         {"free_surface", "water_height"},
                                                         {"previous_free_surface", "sand_height"}};
    if (const auto found = stand_ins.find(binding); found != stand_ins.end()) name.base = found->second;
    const auto surface = surfaces.find(binding);
    if (stage == "measure_strips" && surface != surfaces.end()) name.base = surface->second;
    return name;
}

bool on_faces(const std::string& base) { return ends_with_axis(base) && !base.starts_with("centre_"); }

bool is_state(const std::string& base) {
    const FieldRow* row = find_field(base);
    return row != nullptr && row->role == FieldRole::state;
}

compute::Range2 values_of(const std::string& base, const WorldParams& params) {
    const bool faces = on_faces(base) || base == "limit_marks";
    return compute::extent_range(faces ? compute::Extent::faces : compute::Extent::cells, params);
}

template <class Real>
std::vector<Real> reference_field(const Solver<Real>& s, const std::string& stage, const FieldName& name, bool after) {
    const int nx = s.settings.grid.nx, ny = s.settings.grid.ny;
    const FieldLayout layout{nx, ny};
    std::vector<Real> out(layout.size(), Real(0));
    const auto put = [&](const Field<Real>& from, int columns, int rows, Real factor, Real shift) {
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i)
                out[layout.index(i, j)] =
                    factor *
                    (from[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i)] - shift);
    };
    if (on_faces(name.base)) {
        const bool is_y = name.base.back() == 'y';
        const std::string layer = name.base.substr(0, name.base.size() - 2);
        const bool diffusion = layer == "mixed_flux" && mixed_flux_is_diffusion(stage, after);
        const Faces<Real>* faces = diffusion ? &s.diffusion_flux : face_field(s, layer);
        if (faces != nullptr)
            put(is_y ? faces->y : faces->x, is_y ? nx : nx + 1, is_y ? ny + 1 : ny, diffusion ? s.P.k : Real(1), Real(0));
        return out;
    }
    const bool before_transport = name.base == "sand_height" && !name.next && reads_both_heights(stage);
    const Field<Real>* cells = before_transport ? &s.sand_before : cell_field(s, name.base);
    const bool diagonal = name.base == "stretch_xx" || name.base == "stretch_yy";
    if (cells != nullptr) put(*cells, nx, ny, Real(1), diagonal ? Real(1) : Real(0));
    return out;
}

template std::vector<float> reference_field(const Solver<float>&, const std::string&, const FieldName&, bool);
template std::vector<double> reference_field(const Solver<double>&, const std::string&, const FieldName&, bool);

template <class Real> void fill_ghosts(std::vector<Real>& field, const std::string& base, const Solver<Real>& s) {
    const int nx = s.settings.grid.nx, ny = s.settings.grid.ny;
    const FieldLayout layout{nx, ny};
    if (base == "terrain") {
        for (int j = -GHOST; j < ny + 1 + GHOST; ++j)
            for (int i = -GHOST; i < nx + 1 + GHOST; ++i)
                field[layout.index(i, j)] = field[layout.index(std::clamp(i, 0, nx - 1), std::clamp(j, 0, ny - 1))];
    }
    if (base != "water_height" || !s.has(EFFECT_OPEN_SIDES)) return;
    for (const bool is_y : {false, true}) {
        const reference::Axis axis = s.axis(is_y);
        const auto at = [&](int a, int b) { return is_y ? layout.index(b, a) : layout.index(a, b); };
        for (int b = 0; b < axis.across(); ++b) {
            field[at(-1, b)] = s.ghost_water.along(axis)[axis.face(0, b)];
            field[at(axis.along(), b)] = s.ghost_water.along(axis)[axis.face(axis.along(), b)];
        }
    }
}

template void fill_ghosts(std::vector<float>&, const std::string&, const Solver<float>&);
template void fill_ghosts(std::vector<double>&, const std::string&, const Solver<double>&);

} // namespace wadi::conformance
