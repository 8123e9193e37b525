#include "engine/settings/data/method_presets.hpp"

namespace wadi {

namespace {

constexpr const char* robust = "robust"; // Method{}
constexpr const char* published = "published";

// Sand as the paper has it.
Material level_ground() {
    Material material;
    material.slope_normal = material.internal_friction = material.sand_viscosity = material.retention = 0;
    return material;
}

// Without guards, to the letter (NUMERICS 0.1).
void choose_published(Method& chosen) {
    chosen.outflow_limiter = false;
    chosen.velocity_clamp = 0.25; // the most with which four faces take no more than a cell holds
    chosen.quantum = 0;
    chosen.gravity_cap = chosen.sand_gravity_cap = chosen.elastic_cap = 0;
    chosen.rest_rule = false;
    chosen.shock_viscosity = 0;
    chosen.passive_pressure = chosen.gradient_clamp = chosen.cohesion_cap = 0;
    chosen.saturation_smoothing = 0;
    chosen.prestress = false;
}

} // namespace

const std::vector<std::string>& method_names() {
    static const std::vector<std::string> names = {robust, published};
    return names;
}

void choose_method(Settings& settings, const std::string& name) {
    Method& method = settings.method;
    const bool known = name == robust || name == published;
    Method chosen = known ? Method{} : method;
    chosen.name = name;
    chosen.substeps = method.substeps;
    if (name != published) chosen.water_substeps = method.water_substeps; // the paper has one water step
    chosen.largest_height = method.largest_height;
    chosen.dry_threshold = method.dry_threshold;
    if (name == published) choose_published(chosen);
    if (known) {
        const Material usual = name == published ? level_ground() : Material{};
        Material& material = settings.material;
        material.slope_normal = usual.slope_normal;
        material.internal_friction = usual.internal_friction;
        material.sand_viscosity = usual.sand_viscosity;
        material.retention = usual.retention;
    }
    method = chosen;
}

} // namespace wadi
