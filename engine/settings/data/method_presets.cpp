#include "engine/settings/data/method_presets.hpp"

namespace wadi {

namespace {

constexpr const char* robust = "robust";
constexpr const char* paper_like = "paper_like";
constexpr const char* published = "published";

// Sand as the paper has it.
Material level_ground() {
    Material material;
    material.slope_normal = material.internal_friction = material.sand_viscosity = material.retention = 0;
    return material;
}

// The paper's choices as far as they fit into Wadi's own order of a step.
void choose_paper_like(Method& chosen) {
    chosen.velocity_transport = VelocityTransport::semi_lagrangian;
    chosen.strain_transport = StrainTransport::polar;
    chosen.drag_friction = DragFriction::sequence;
    chosen.diffusion = Diffusion::laplacian;
    // The one guard that the paper names is the velocity clamp, without a number: it stays that of robust. So does the
    // outflow limiter, without which the paper's mass claim does not hold.
    chosen.quantum = 0;
    chosen.gravity_cap = chosen.gravity_cap_least = chosen.sand_gravity_cap = chosen.elastic_cap = 0;
    chosen.rest_rule = false;
    chosen.shock_viscosity = 0;
    chosen.passive_pressure = chosen.gradient_clamp = chosen.cohesion_cap = 0;
    chosen.saturation_smoothing = 0;
    chosen.prestress = false;
}

// The rest of them, to the letter (NUMERICS 0.1).
void choose_published(Method& chosen) {
    choose_paper_like(chosen);
    chosen.diffusion = Diffusion::laplacian_ahead;
    chosen.mixed_pressure = MixedPressure::at_once;
    chosen.layer_exchange = LayerExchange::accelerate;
    chosen.sand_substep = SandSubstep::algorithm_1;
    chosen.corner_shear = CornerShear::central;
    chosen.strain_rim = StrainRim::extrapolated;
    chosen.outflow_limiter = false;
    chosen.velocity_clamp = 0.25; // the most with which four faces take no more than a cell holds
}

} // namespace

const std::vector<std::string>& method_names() {
    static const std::vector<std::string> names = {robust, paper_like, published};
    return names;
}

void choose_method(Settings& settings, const std::string& name) {
    Method& method = settings.method;
    const bool papers = name == paper_like || name == published;
    const bool known = name == robust || papers;
    Method chosen = known ? Method{} : method; // the defaults are robust
    chosen.name = name;
    chosen.substeps = method.substeps;
    chosen.largest_height = method.largest_height;
    chosen.dry_threshold = method.dry_threshold;
    if (name == paper_like) choose_paper_like(chosen);
    if (name == published) choose_published(chosen);
    if (known) {
        const Material usual = papers ? level_ground() : Material{};
        Material& material = settings.material;
        material.slope_normal = usual.slope_normal;
        material.internal_friction = usual.internal_friction;
        material.sand_viscosity = usual.sand_viscosity;
        material.retention = usual.retention;
    }
    method = chosen;
}

} // namespace wadi
