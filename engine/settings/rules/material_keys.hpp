// The numbers of a material by the names that level files give them: to list them, and to change one of a running world.
#pragma once
#include "engine/settings/data/settings.hpp"
#include <span>
#include <string_view>

namespace wadi {

struct MaterialKey {
    std::string name; // "friction", "saturation[0]"
    double least = 0, most = 0;
    std::uint32_t effect = 0; // through which it acts; 0 = through several
};

/// All of them, by the rows of setting_table(); those of lists (saturation) come last. What snapshots and command logs hold of
/// the index: snapshot_format.hpp, command_format.cpp.
std::span<const MaterialKey> material_keys();
/// Index of a name, or -1.
int find_material_key(std::string_view name);
double material_value(const Material& material, int key);
void set_material_value(Material& material, int key, double value);

/// ok, or bad_argument that begins with `function` where the value is out of range, does not go with the others, or acts through
/// an effect that the level forces off.
Status check_material_change(const char* function, const Settings& settings, int key, double value);

} // namespace wadi
