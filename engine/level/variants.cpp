#include "engine/level/variants.hpp"
#include "engine/settings/rules/messages.hpp"

namespace wadi {

Result<std::vector<std::string>> take_variant(Json& level, const std::optional<std::string>& wanted) {
    std::vector<std::string> names;
    Json variants = Json::object();
    if (level.is_object() && level.contains("variants")) {
        variants = level["variants"];
        level.erase("variants");
    }
    if (!variants.is_object())
        return error(Code::bad_file, "variants: want an object of names and changes, found " + json_text(variants));
    for (const auto& [name, change] : variants.items()) {
        const std::string path = "variants." + name;
        if (!change.is_object()) return error(Code::bad_file, path + ": want an object, found " + json_text(change));
        for (const char* key : {"format_version", "name", "variants"}) {
            if (change.contains(key)) return error(Code::bad_file, path + "." + key + ": a variant cannot change it");
        }
        names.push_back(name);
    }
    if (!wanted) return names;
    if (!variants.contains(*wanted)) {
        if (names.empty()) return error(Code::bad_argument, "variant: \"" + *wanted + "\", but the level has no variants");
        return error(Code::bad_argument, "variant: \"" + *wanted + "\" is not known" + suggestion(*wanted, names));
    }
    level.merge_patch(variants[*wanted]);
    return names;
}

} // namespace wadi
