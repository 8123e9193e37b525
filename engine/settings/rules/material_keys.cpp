#include "engine/settings/rules/material_keys.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/checks.hpp"
#include "engine/settings/rules/effects.hpp"
#include <algorithm>

namespace wadi {

namespace {

// Numbers of a list come last: so their indices are in command logs and snapshots.
std::vector<const Setting*> find_rows() {
    std::vector<const Setting*> rows;
    for (const bool element : {false, true})
        for (const Setting& row : setting_table())
            if (row.object() == "material" && row.element() == element) rows.push_back(&row);
    return rows;
}

// Made by whoever asks first, for all that ask: a worker's thread later finds it made.
struct Known {
    std::vector<const Setting*> rows = find_rows();
    std::vector<MaterialKey> keys;
    Known() {
        for (const Setting* row : rows)
            keys.push_back({std::string(row->key()), row->values.least, row->values.most, row->effect});
    }
};

const Known& known() {
    static const Known all;
    return all;
}

const Setting& row_of(int key) { return *known().rows[static_cast<std::size_t>(key)]; }

} // namespace

std::span<const MaterialKey> material_keys() { return known().keys; }

int find_material_key(std::string_view name) {
    const auto keys = material_keys();
    const auto found = std::find_if(keys.begin(), keys.end(), [&](const MaterialKey& key) { return key.name == name; });
    return found == keys.end() ? -1 : static_cast<int>(found - keys.begin());
}

double material_value(const Material& material, int key) {
    Settings settings;
    settings.material = material;
    return row_of(key).at.get(settings);
}

void set_material_value(Material& material, int key, double value) {
    Settings settings;
    settings.material = material;
    row_of(key).at.set(settings, value);
    material = settings.material;
}

Status check_material_change(const char* function, const Settings& settings, int key, double value) {
    Material changed = settings.material;
    set_material_value(changed, key, value);
    const std::string begin = std::string(function) + ": ";
    if (auto status = validate(changed); !status) return error(status.code, begin + status.message);
    const MaterialKey& known = material_keys()[static_cast<std::size_t>(key)];
    for (const auto& [name, force] : settings.effects) {
        if (force == Force::off && known.effect != 0 && name == effect_names(known.effect))
            return error(Code::bad_argument,
                         begin + "material." + known.name + " acts through effects." + name + ", which the level forces off");
    }
    return ok_status();
}

} // namespace wadi
