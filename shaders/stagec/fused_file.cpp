#include "fused_file.hpp"
#include "writers.hpp"
#include <algorithm>

namespace stagec {
namespace {

Margins margins_of(const std::vector<std::string>& a, const std::string& place) {
    const bool fits = a.size() == 4 && std::all_of(a.begin(), a.end(), [](const std::string& n) {
                          return n == "0" || n == "1" || n == "2"; // cells around a group's own
                      });
    if (!fits) fail(place + ": PHASE takes (west, south, east, north), each 0, 1 or 2 cells");
    return {a[0][0] - '0', a[1][0] - '0', a[2][0] - '0', a[3][0] - '0'};
}

// "name=field" reads and writes another field than the binding's name says, "name>field" only writes it.
FusedPart part_of(const std::vector<std::string>& a, std::size_t first, const std::string& folder, const std::string& place) {
    FusedPart part;
    part.place = place;
    const std::string stage = a.size() > first ? a[first] : "";
    const std::string path = find_stage(folder + "/../stages", stage);
    if (path.empty()) fail(place + ": no stage \"" + stage + "\"");
    part.stage = parse_stage(path);
    for (const auto& b : part.stage.bindings) {
        if (b.access != "OUT") part.reads[b.name] = b.name;
        if (b.access != "IN") part.writes[b.name] = b.name;
    }
    for (std::size_t n = first + 1; n < a.size(); ++n) {
        const auto at = a[n].find_first_of("=>");
        if (at == std::string::npos) fail(place + ": \"" + a[n] + "\" is neither binding = field nor binding > field");
        const std::string name = a[n].substr(0, at), field = a[n].substr(at + 1);
        if (!part.reads.count(name) && !part.writes.count(name)) fail(place + ": " + part.stage.name + " has no binding " + name);
        if (a[n][at] == '=' && part.reads.count(name)) part.reads[name] = field;
        if (part.writes.count(name)) part.writes[name] = field;
    }
    return part;
}

void add_binding(FusedStage& fused, const std::string& field, const std::string& type, const char* access, unsigned condition,
                 const std::string& place) {
    for (auto& b : fused.stage.bindings) {
        if (b.name != field) continue;
        if (b.type != type) fail(place + ": " + field + " is bound as " + b.type + " and as " + type);
        if (b.access != access) fail(place + ": " + field + " is read from memory and kept: another group may have written it");
        if (b.condition != std::to_string(condition) + "u") {
            if (b.condition != "0u" && condition != 0) fail(place + ": " + field + " exists under two conditions");
            b.condition = "0u";
        }
        return;
    }
    Binding b;
    b.name = field;
    b.type = type;
    b.access = access;
    b.condition = std::to_string(condition) + "u";
    b.slot = static_cast<int>(fused.stage.bindings.size());
    fused.stage.bindings.push_back(b);
}

// Finds out what is read from memory, what is kept there, and where the rest lives.
// `tested`: effects that the file itself asks.
void resolve(FusedStage& fused, const Effects& effects, std::set<std::string> tested) {
    for (std::size_t n = 0; n < fused.parts.size(); ++n) {
        const auto& part = fused.parts[n];
        for (const auto& b : part.stage.bindings) {
            if (b.type != "float") fail(part.place + ": " + part.stage.name + " has a binding that is no float");
        }
        tested.insert(part.stage.tested.begin(), part.stage.tested.end());
        for (const auto& [name, field] : part.reads) {
            bool never = false;
            const unsigned condition = condition_of(fused, part, binding_of(part.stage, name), effects, never);
            if (never) continue;
            if (!writes_before(fused, n, field)) {
                add_binding(fused, field, binding_of(part.stage, name).type, "IN", condition, part.place);
                continue;
            }
            auto& keeping = fused.fields[field];
            bool same_phase = true;
            for (std::size_t w = 0; w < n; ++w)
                for (const auto& [other, written] : fused.parts[w].writes)
                    if (written == field) same_phase &= fused.parts[w].phase == part.phase;
            keeping = std::max(keeping, same_phase ? Keeping::own_index : Keeping::window);
        }
        for (const auto& [name, field] : part.writes) {
            bool never = false;
            condition_of(fused, part, binding_of(part.stage, name), effects, never);
            if (!never) fused.fields.emplace(field, Keeping::nowhere);
        }
    }
    for (const auto& [field, kept] : fused.kept) {
        if (!fused.fields.count(field)) fail(kept.place + ": KEEP names " + field + ", which no part writes");
        const FusedPart& part = fused.parts[last_writer(fused, field)];
        for (const auto& [name, written] : part.writes) {
            bool never = false;
            const unsigned condition = condition_of(fused, part, binding_of(part.stage, name), effects, never);
            if (written == field && !never)
                add_binding(fused, field, binding_of(part.stage, name).type, "OUT", condition | (kept.condition & ~fused.needs),
                            kept.place);
        }
    }
    for (const auto& [field, keeping] : fused.fields) {
        if (!fused.kept.count(field) && keeping == Keeping::nowhere)
            fail(fused.parts[last_writer(fused, field)].place + ": nobody reads " + field);
    }
    for (const auto& name : tested) {
        if ((effects.at(name) & (fused.needs | fused.without)) == 0) fused.stage.tested.push_back(name);
    }
    for (auto& part : fused.parts) {
        auto& add = part.reach = part.stage.reach;
        const bool far = (effect_bits(part.stage.far, effects, part.stage.path) & fused.without) == 0;
        for (int* n : {&add.west, &add.south, &add.east, &add.north})
            if (!far) *n = std::min(*n, 1);
        auto& sum = fused.stage.reach;
        sum = {sum.west + add.west, sum.south + add.south, sum.east + add.east, sum.north + add.north};
    }
}

} // namespace

const Binding& binding_of(const Stage& stage, const std::string& name) {
    const auto found =
        std::find_if(stage.bindings.begin(), stage.bindings.end(), [&](const Binding& b) { return b.name == name; });
    if (found == stage.bindings.end()) fail(stage.path + ": no binding " + name);
    return *found;
}

unsigned condition_of(const FusedStage& fused, const FusedPart& part, const Binding& b, const Effects& effects, bool& never) {
    const unsigned bits = effect_bits(b.condition, effects, part.stage.path) | part.condition;
    never = (bits & fused.without) != 0;
    return bits & ~fused.needs;
}

bool writes_before(const FusedStage& fused, std::size_t part, const std::string& field) {
    for (std::size_t n = 0; n < part; ++n)
        for (const auto& [name, written] : fused.parts[n].writes)
            if (written == field) return true;
    return false;
}

std::size_t last_writer(const FusedStage& fused, const std::string& field) {
    std::size_t last = fused.parts.size();
    for (std::size_t n = 0; n < fused.parts.size(); ++n)
        for (const auto& [name, written] : fused.parts[n].writes)
            if (written == field) last = n;
    return last;
}

Margins read_margins(const FusedStage& fused) {
    Margins most;
    for (const auto& part : fused.parts) {
        const Margins& m = fused.phases[part.phase];
        const Reach& r = part.reach;
        most = {std::max(most.west, m.west + r.west), std::max(most.south, m.south + r.south),
                std::max(most.east, m.east + r.east), std::max(most.north, m.north + r.north)};
    }
    return most;
}

std::vector<SharedRows> windows(const FusedStage& fused) {
    std::vector<SharedRows> all;
    for (const auto& field : fields_kept(fused, Keeping::window)) {
        SharedRows rows{field};
        for (const auto& part : fused.parts)
            for (const auto& [name, written] : part.writes)
                if (written == field) {
                    rows.south = std::max(rows.south, fused.phases[part.phase].south);
                    rows.north = std::max(rows.north, fused.phases[part.phase].north);
                }
        all.push_back(rows);
    }
    return all;
}

std::vector<SharedRows> staged(const FusedStage& fused) {
    const Margins m = read_margins(fused);
    std::vector<SharedRows> all;
    for (const auto& field : fused.staged) all.push_back({field, m.south, m.north});
    return all;
}

std::size_t shared_bytes(const FusedStage& fused) {
    std::size_t rows = 0;
    for (const auto& array : windows(fused)) rows += static_cast<std::size_t>(array.rows());
    for (const auto& array : staged(fused)) rows += static_cast<std::size_t>(array.rows());
    return rows * shared_pitch * sizeof(float);
}

FusedStage fitted(FusedStage fused, std::size_t bytes) {
    while (!fused.staged.empty() && shared_bytes(fused) > bytes) fused.staged.pop_back();
    return fused;
}

std::vector<std::string> fields_kept(const FusedStage& fused, Keeping keeping) {
    std::vector<std::string> names;
    for (const auto& [name, where] : fused.fields)
        if (where == keeping) names.push_back(name);
    return names;
}

namespace {

using Arguments = std::vector<std::string>;

void read_word(FusedStage& fused, const std::string& word, const Arguments& a, const std::string& folder, const Effects& effects,
               const std::string& place, std::set<std::string>& asked) {
    const auto bits = [&](const std::string& expression) { return effect_bits(expression, effects, place); };
    if (a.empty() || a[0].empty()) fail(place + ": " + word + " takes arguments in parentheses");
    if (word == "FUSED") {
        fused.stage.struct_name = a[0];
    } else if (word == "NEEDS") {
        fused.needs = bits(a[0]);
    } else if (word == "WITHOUT") {
        fused.without = bits(a[0]);
    } else if (word == "GROUPS") {
        if (a[0].size() != 1 || a[0][0] < '2' || a[0][0] > '6') fail(place + ": GROUPS takes a number from 2 to 6");
        fused.groups = a[0][0] - '0';
    } else if (word == "PHASE") {
        fused.phases.push_back(margins_of(a, place));
    } else if (word == "RUN" || word == "RUN_IF") {
        if (fused.phases.empty()) fail(place + ": RUN ahead of the first PHASE");
        const bool conditional = word == "RUN_IF";
        FusedPart part = part_of(a, conditional ? 1 : 0, folder, place);
        part.condition = conditional ? bits(a[0]) & ~fused.needs : 0;
        if (conditional)
            for (const auto& name : effects_in(a[0])) part.stage.tested.push_back(name);
        part.phase = fused.phases.size() - 1;
        fused.parts.push_back(part);
    } else if (word == "KEEP") {
        for (const auto& field : a) fused.kept[field] = {false, 0, place};
    } else if (word == "KEEP_RIM_IF") {
        for (const auto& name : effects_in(a[0])) asked.insert(name);
        for (std::size_t n = 1; n < a.size(); ++n) fused.kept[a[n]] = {true, bits(a[0]) & ~fused.needs, place};
    } else if (word == "CELLS_EACH") {
        if (a[0] != "1" && a[0] != "2") fail(place + ": CELLS_EACH takes 1 or 2");
        fused.cells_each = a[0][0] - '0';
    } else if (word == "STAGED") {
        fused.staged = a;
        fused.staged_place = place;
    } else if (word == "EMPTY_WITHOUT") {
        fused.empty.without = a;
        fused.empty.place = place;
    } else if (word == "EMPTY_COPIES") {
        for (const auto& text : a) {
            const auto at = text.find('=');
            if (at == std::string::npos) fail(place + ": \"" + text + "\" is not kept field = field");
            fused.empty.copies[text.substr(0, at)] = text.substr(at + 1);
        }
    } else if (word == "LEAN_WITHOUT") {
        fused.lean.less = bits(a[0]);
        fused.lean.without.assign(a.begin() + 1, a.end());
        fused.lean.place = place;
    } else if (word == "NEVER_EMPTY_IF") {
        for (const auto& name : effects_in(a[0])) asked.insert(name);
        fused.empty.never = bits(a[0]);
    } else {
        fail(place + ": unknown word " + word);
    }
}

// Fields that tell what a group holds, and those that it copies, must be read from memory whatever the mask.
void check_contents(const FusedStage& fused) {
    const auto check = [&](const std::string& field, const std::string& place) {
        const auto& all = fused.stage.bindings;
        const bool read =
            std::any_of(all.begin(), all.end(), [&](const Binding& b) { return b.name == field && b.access == "IN"; });
        if (!read) fail(place + ": no part reads " + field + " from memory");
    };
    for (const auto& field : fused.empty.without) check(field, fused.empty.place);
    for (const auto& field : fused.lean.without) check(field, fused.lean.place);
    for (const auto& field : fused.staged) check(field, fused.staged_place);
    for (const auto& [field, from] : fused.empty.copies) {
        check(from, fused.empty.place);
        if (!fused.kept.count(field)) fail(fused.empty.place + ": " + field + " is not kept");
    }
}

} // namespace

FusedStage parse_fused(const std::string& path, const Effects& effects) {
    FusedStage fused;
    fused.stage.path = path;
    fused.stage.name = stem(path);
    fused.stage.extent = "FACES";
    fused.stage.fused = true;
    const auto slash = path.find_last_of('/');
    const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash);
    const Source source = read_source(path);
    std::set<std::string> asked;
    for (std::size_t at = skip_blanks(source.text, 0); at < source.text.size(); at = skip_blanks(source.text, at)) {
        const std::string word = word_at(source.text, at);
        const std::size_t behind = at + word.size();
        if (word.empty()) source.fail(at, std::string("a word was expected, not ") + source.text[at]);
        read_word(fused, word, arguments(source, behind), folder, effects, source.place(at), asked);
        at = behind_bracket(source, skip_blanks(source.text, behind));
    }
    if (fused.stage.struct_name.empty()) source.fail(0, "no FUSED(Name)");
    resolve(fused, effects, asked);
    check_contents(fused);
    const auto check_bytes = [&](const char* what, std::size_t bytes, std::size_t most) {
        if (bytes <= most) return;
        source.fail(0, what + std::to_string(bytes) + " bytes, at most " + std::to_string(most) + " are shared");
    };
    check_bytes("windows of ", shared_bytes(fitted(fused, 0)), shared_bytes_everywhere);
    check_bytes("windows and staged fields of ", shared_bytes(fused), shared_bytes_cuda);
    return fused;
}

} // namespace stagec
