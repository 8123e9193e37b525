#include "write_variant.hpp"
#include <algorithm>
#include <cctype>

namespace tune {
namespace {

/// One patch after the other as one. nlohmann's merge_patch would drop the nulls of the first.
Json composed(Json first, const Json& second) {
    for (const auto& [key, value] : second.items())
        first[key] = first.contains(key) && first[key].is_object() && value.is_object() ? composed(first[key], value) : value;
    return first;
}

/// Where in a level's text a variant can be put in.
struct Places {
    std::size_t variants = std::string::npos; // just inside the brace of "variants"
    bool variants_empty = true;
    std::size_t last_value = 0; // just behind the last value of the level
    std::size_t end = 0;        // its closing brace
};

/// The text has been parsed: its JSON is well formed.
Places find_places(const std::string& text) {
    Places places;
    int depth = 0;
    bool value_follows = false, inside_variants = false; // behind the colon of "variants"; within its braces
    std::string key;
    for (std::size_t n = 0; n < text.size(); ++n) {
        const char c = text[n];
        if (std::isspace(static_cast<unsigned char>(c))) continue;
        if (c == '/' && text[n + 1] == '/') {
            n = text.find('\n', n);
            if (n == std::string::npos) break;
            continue;
        }
        if (c == '/' && text[n + 1] == '*') {
            n = text.find("*/", n + 2) + 1;
            continue;
        }
        if (inside_variants && depth == 2 && c != '}') places.variants_empty = false;
        if (c == '"') {
            const std::size_t start = n + 1;
            for (++n; text[n] != '"'; ++n) n += text[n] == '\\' ? 1 : 0;
            if (depth == 1) key = text.substr(start, n - start);
        } else if (c == ':') {
            value_follows = depth == 1 && key == "variants";
        } else if (c == '{' || c == '[') {
            ++depth;
            if (value_follows) {
                places.variants = n + 1;
                inside_variants = true;
            }
            value_follows = false;
        } else if (c == '}' || c == ']') {
            --depth;
            if (depth == 1) inside_variants = false;
            if (depth == 0) {
                places.end = n;
                break;
            }
        }
        places.last_value = n + 1;
    }
    return places;
}

/// Each key of the patch on a line of its own.
std::string lines_of(const Json& patch, const std::string& indent) {
    std::string text = "{";
    for (const auto& [key, value] : patch.items())
        text += (text.size() > 1 ? ",\n" : "\n") + indent + "    " + Json(key).dump() + ": " + value.dump();
    return text + "\n" + indent + "}";
}

} // namespace

Json variant_of(const Level& level, const Settings& settings) {
    const Json patch = composed(level.variant_patch(), level.patch(settings));
    Json once = level.file_json(), twice = level.json();
    once.merge_patch(patch);
    twice.merge_patch(level.patch(settings));
    // A variant that removes an object and settings within it are no one patch.
    if (nlohmann::json(once) != nlohmann::json(twice))
        throw BadInput("the variant removes what the settings are part of; they fit into no one variant with it");
    return patch;
}

std::string with_variant(const Level& level, const std::string& name, const Json& patch) {
    const bool good = !name.empty() && std::all_of(name.begin(), name.end(),
                                                   [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
    if (!good) throw BadInput("--name \"" + name + "\": want letters, digits, _ and -");
    Json expected = level.file_json();
    if (expected.contains("variants") && expected["variants"].contains(name))
        throw BadInput("the level has a variant \"" + name + "\" already: choose another --name, or remove it from the file");
    expected["variants"][name] = patch;

    std::string text = level.file_text();
    const Places places = find_places(text);
    const std::string variant = "\n        \"" + name + "\": " + lines_of(patch, "        ");
    if (places.variants != std::string::npos) {
        text.insert(places.variants, variant + (places.variants_empty ? "\n    " : ","));
    } else {
        text.insert(places.end, "    \"variants\": {" + variant + "\n    }\n");
        text.insert(places.last_value, 1, ',');
    }
    if (nlohmann::json::parse(text, nullptr, false, true) != nlohmann::json(expected))
        throw BadInput("the variant cannot be put into the level's text");
    return text;
}

bool names_files(const Json& json) {
    if (json.is_object() && json.contains("file")) return true;
    return json.is_structured() && std::any_of(json.begin(), json.end(), [](const Json& part) { return names_files(part); });
}

} // namespace tune
