#include "engine/reads/describe_tables.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/effects.hpp"
#include "engine/settings/rules/messages.hpp"
#include "engine/step/plan/step_plan.hpp"
#include "shaders/stage_table.hpp"
#include <algorithm>
#include <vector>

namespace wadi {

namespace {

using Strings = std::vector<std::string>;

std::string joined(const Strings& words, const std::string& between) {
    std::string text;
    for (const auto& word : words) text += (text.empty() ? "" : between) + word;
    return text;
}

std::string quoted(std::string_view text, char mark) { return std::string(1, mark).append(text).append(1, mark); }
std::string code(std::string_view text) { return quoted(text, '`'); }

std::string row(const Strings& cells) {
    std::string text = "|";
    for (const auto& cell : cells) text += cell.empty() ? " |" : " " + cell + " |";
    return text + "\n";
}

std::string heading(const Strings& cells) { return row(cells) + row(Strings(cells.size(), "---")); }

// Effects and choices of a mask as words.
Strings names_of(std::uint32_t mask) {
    Strings names;
    for (const auto& effect : effect_rows)
        if ((mask & effect.bit) != 0) names.emplace_back(effect.name);
    for (const auto& choice : choice_rows)
        if ((mask & choice.bit) != 0) names.emplace_back(choice.name);
    return names;
}

// {"velocity_x?", "velocity_y?"} as "velocity_x/y?": names in a row that differ in x and y alone.
Strings folded(const Strings& names) {
    const auto without_axes = [](std::string name) {
        for (std::size_t at = 0; (at = name.find('_', at)) != std::string::npos; ++at) {
            const std::size_t end = std::min(name.find_first_of("_?", at + 1), name.size());
            const std::string word = name.substr(at + 1, end - at - 1);
            if (!word.empty() && word.find_first_not_of("xy") == std::string::npos)
                return std::pair{name.substr(0, at + 1) + name.substr(end), std::pair{at + 1, word}};
        }
        return std::pair{name, std::pair{name.size(), std::string()}};
    };
    Strings result;
    std::string last;
    std::size_t insert_at = 0;
    for (const auto& name : names) {
        const auto [stem, axes] = without_axes(name);
        if (!axes.second.empty() && stem == last) {
            result.back().insert(insert_at, "/" + axes.second);
            insert_at += axes.second.size() + 1;
        } else {
            result.push_back(name);
            insert_at = axes.first + axes.second.size();
        }
        last = stem;
    }
    return result;
}

std::string normal_text(const Setting& setting) {
    if (setting.required()) return "";
    const double value = setting.normal();
    if (setting.at.kind == SettingKind::flag) return value != 0 ? "true" : "false";
    if (setting.at.kind == SettingKind::choice) return code(setting.values.names[static_cast<std::size_t>(value)]);
    return number_text(value);
}

std::string range_text(const Setting& setting) {
    const auto& [least, most, names, among] = setting.values;
    if (setting.at.kind == SettingKind::flag) return "true, false";
    Strings words;
    for (const char* name : names) words.push_back(code(name));
    for (const int one : among) words.push_back(std::to_string(one));
    return words.empty() ? number_text(least) + " ... " + number_text(most) : joined(words, ", ");
}

std::string describe_settings() {
    std::string text = heading({"key", "unit", "range", "default", "effect", "meaning"});
    for (const Setting& setting : setting_table())
        text += row({code(setting.path), setting.unit, range_text(setting), normal_text(setting),
                     joined(names_of(setting.effect), ", "), setting.meaning});
    return text;
}

std::string describe_effects() {
    std::string text = heading({"effect", "needs", "on by itself when", "meaning"});
    for (const Effect& effect : effect_table())
        text += row({code(effect.name), joined(names_of(effect.needs), ", "), effect.when, effect.meaning});
    text += "\n" + heading({"choice", "needs", "setting", "meaning"});
    for (const Choice& choice : choice_table())
        text += row({code(choice.name), joined(names_of(choice.needs), ", "), choice.when, choice.meaning});
    return text;
}

// Fields that have a partner in some plan.
bool takes_turns(std::string_view field) {
    for (const std::uint32_t mask : {all_effects, (all_effects & ~never_published) | EFFECT_PUBLISHED}) {
        const StepPlan plan = make_step_plan(mask, 1);
        const PlanField* found = plan.find(std::string(field));
        if (found != nullptr && found->ping_pong) return true;
    }
    return false;
}

std::string describe_fields() {
    const char* roles[] = {"state", "state", "scratch", "ledger", "fixed", "shapes", "tiles", "published"};
    std::string text = heading({"field", "role", "symbol", "place", "unit", "exists with", "meaning"});
    const auto table = field_table();
    for (std::size_t n = 0; n < table.size();) {
        const FieldRow& first = table[n];
        Strings names, symbols;
        bool west = false, south = false;
        do {
            names.emplace_back(table[n].name);
            if (*table[n].symbol != '\0') symbols.emplace_back(table[n].symbol);
            west = west || table[n].place == FieldPlace::west_face;
            south = south || table[n].place == FieldPlace::south_face;
        } while (++n < table.size() && *table[n].meaning == '\0');
        const std::string role = std::string(roles[static_cast<int>(first.role)]) + (takes_turns(first.name) ? " x2" : "");
        const std::string faces =
            std::string(west ? "west" : "") + (west && south ? ", " : "") + (south ? "south" : "") + " face";
        text += row({code(joined(folded(names), ", ")), role, joined(symbols, ", "),
                     west || south                     ? faces
                     : first.place == FieldPlace::cell ? "cell"
                     : first.role == FieldRole::rim    ? "outer face"
                                                       : "",
                     first.unit, joined(names_of(first.needs), ", "), first.meaning});
    }
    return text;
}

// In lines of at most so many characters, the first word of each behind `begin`.
std::string wrapped(const std::string& begin, const Strings& words) {
    constexpr std::size_t widest = 130;
    std::string text, line = begin;
    for (std::size_t n = 0; n < words.size(); ++n) {
        const std::string word = words[n] + (n + 1 < words.size() ? "," : "");
        if (line.size() + 1 + word.size() > widest) {
            text += line + "\n";
            line = std::string(begin.size(), ' ');
        }
        line += " " + word;
    }
    return text + line + "\n";
}

std::string describe_stages() {
    using namespace compute;
    const char* extents[] = {"cells",        "faces",  "rim",   "strips",    "source_pieces",
                             "source_cells", "points", "tiles", "tile_rows", "tile_lines"};
    const char* accesses[] = {"    reads  ", "    writes ", "    updates"};
    std::string text;
    for (const StageInfo& stage : stage_table()) {
        if (stage.fused()) continue;
        text += std::string(stage.name) + "  " + extents[static_cast<int>(stage.extent)];
        if (const Strings tested = names_of(stage.tested_effects); !tested.empty()) text += "  tests " + joined(tested, ", ");
        text += "\n";
        for (const Access access : {Access::in, Access::out, Access::inout}) {
            Strings names;
            for (const StageBinding& binding : stage.bindings)
                if (binding.access == access) names.push_back(std::string(binding.name) + (binding.condition != 0 ? "?" : ""));
            if (!names.empty()) text += wrapped(accesses[static_cast<int>(access)], folded(names));
        }
    }
    return text;
}

std::string json(double value) { return number_text(value); }

std::string json(std::string_view text) { return quoted(text, '"'); }

std::string schema_of(const Setting& setting) {
    const auto& [least, most, names, among] = setting.values;
    const double normal = setting.normal();
    std::string text, value = json(normal);
    Strings allowed;
    for (const char* name : names) allowed.push_back(json(std::string_view(name)));
    for (const int one : among) allowed.push_back(std::to_string(one));
    if (!allowed.empty()) {
        text = "\"enum\": [" + joined(allowed, ", ") + "]";
    } else if (setting.at.kind == SettingKind::flag) {
        text = "\"type\": \"boolean\"";
    } else {
        text = std::string("\"type\": ") + (setting.at.kind == SettingKind::whole ? "\"integer\"" : "\"number\"") +
               ", \"minimum\": " + json(least) + ", \"maximum\": " + json(most);
    }
    if (setting.at.kind == SettingKind::flag) value = normal != 0 ? "true" : "false";
    if (!names.empty()) value = allowed[static_cast<std::size_t>(normal)];
    const std::string unit = *setting.unit == '\0' ? "" : " [" + std::string(setting.unit) + "]";
    return "{" + text + ", \"description\": " + json(setting.meaning + unit) +
           (setting.required() ? "" : ", \"default\": " + value) + "}";
}

// {"material": {"friction": {...}, ...}, ...}; what stands beside the objects is in "".
std::string describe_schema() {
    Strings objects;
    for (const std::string_view object : {"", "grid", "material", "method", "surface"}) {
        Strings keys;
        for (const Setting& setting : setting_table())
            if (setting.object() == object) keys.push_back("    " + json(setting.key()) + ": " + schema_of(setting));
        objects.push_back("  " + json(object) + ": {\n" + joined(keys, ",\n") + "\n  }");
    }
    Strings effects;
    for (const Effect& effect : effect_table())
        effects.push_back("    " + json(std::string_view(effect.name)) + ": {\"$ref\": \"#/$defs/force\"}");
    objects.push_back("  \"effects\": {\n" + joined(effects, ",\n") + "\n  }");
    return "{\n" + joined(objects, ",\n") + "\n}\n";
}

} // namespace

Result<std::string> describe_table(const std::string& name) {
    const std::pair<const char*, std::string (*)()> tables[] = {{"settings", describe_settings},
                                                                {"effects", describe_effects},
                                                                {"fields", describe_fields},
                                                                {"stages", describe_stages},
                                                                {"schema", describe_schema}};
    Strings known;
    for (const auto& [table, describe] : tables) {
        if (name == table) return describe();
        known.emplace_back(table);
    }
    return error(Code::not_found, "no table is called \"" + name + "\"" + suggestion(name, known));
}

} // namespace wadi
