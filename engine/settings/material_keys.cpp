#include "engine/settings/material_keys.hpp"
#include "engine/settings/setting_fields.hpp"
#include <algorithm>
#include <iterator>
#include <map>

namespace wadi {

namespace {

constexpr std::size_t FIELDS = std::size(MATERIAL_FIELDS);

const char* effect_of(const std::string& name) {
    static const std::map<std::string, const char*> effects = {
        {"friction", "sand"},
        {"young_modulus", "elastoplastic"},
        {"poisson_ratio", "elastoplastic"},
        {"yield_friction", "elastoplastic"},
        {"cohesion_dry", "cohesion"},
        {"cohesion_wet", "cohesion"},
        {"cohesion_capillary", "cohesion"},
        {"exchange_rate", "drag"},
        {"diffusion_rate", "diffusion"},
        {"bed_friction", "bed_friction"},
        {"bed_shear", "bed_shear"},
        {"grain_size", "bed_shear"},
    };
    const auto found = effects.find(name);
    return found == effects.end() ? nullptr : found->second;
}

std::vector<MaterialKey> make_keys() {
    std::vector<MaterialKey> keys;
    for (const auto& field : MATERIAL_FIELDS) keys.push_back({field.name, field.least, field.most, effect_of(field.name)});
    for (const char* name : {"saturation[0]", "saturation[1]", "saturation[2]"}) keys.push_back({name, 0, 1, "cohesion"});
    return keys;
}

} // namespace

std::span<const MaterialKey> material_keys() {
    static const std::vector<MaterialKey> keys = make_keys();
    return keys;
}

int find_material_key(std::string_view name) {
    const auto keys = material_keys();
    const auto found = std::find_if(keys.begin(), keys.end(), [&](const MaterialKey& key) { return key.name == name; });
    return found == keys.end() ? -1 : static_cast<int>(found - keys.begin());
}

double material_value(const Material& material, int key) {
    const auto n = static_cast<std::size_t>(key);
    return n < FIELDS ? material.*MATERIAL_FIELDS[n].member : material.saturation[n - FIELDS];
}

void set_material_value(Material& material, int key, double value) {
    const auto n = static_cast<std::size_t>(key);
    (n < FIELDS ? material.*MATERIAL_FIELDS[n].member : material.saturation[n - FIELDS]) = value;
}

Status check_material_change(const char* function, const Settings& settings, int key, double value) {
    Material changed = settings.material;
    set_material_value(changed, key, value);
    const std::string begin = std::string(function) + ": ";
    if (auto status = validate(changed); !status) return error(status.code, begin + status.message);
    const MaterialKey& known = material_keys()[static_cast<std::size_t>(key)];
    for (const auto& [name, force] : settings.effects) {
        if (force == Force::off && known.effect != nullptr && name == known.effect) {
            return error(Code::bad_argument,
                         begin + "material." + known.name + " acts through effects." + name + ", which the level forces off");
        }
    }
    return ok_status();
}

} // namespace wadi
