// Settings at the ends of their ranges and next to nothing, whatever the case is otherwise.
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/checks.hpp"
#include "engine/settings/rules/edit_checks.hpp"
#include "tests/fuzz/fuzz_case.hpp"
#include "tests/fuzz/random.hpp"
#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

namespace wadi::fuzz {

namespace {

// Not the grid, which the fields are drawn on, and not the limiter, without which the ledger does not hold.
bool drawn(const Setting& row) { return row.object() != "grid" && std::string_view(row.path) != "method.outflow_limiter"; }

double end_of(const Setting& row, Random& random) {
    const auto [least, most] = std::pair{row.values.least, row.values.most};
    if (!row.values.among.empty()) return row.values.among[random.next() % row.values.among.size()];
    if (row.at.kind != SettingKind::number) return random.whole(static_cast<int>(least), static_cast<int>(most));
    switch (random.whole(0, 3)) {
    case 0:
        return least;
    case 1:
        return most;
    case 2:
        return std::max(least, random.pick({5e-324, 1e-300, 1e-100, 1e-50, 1e-45, 1e-42, 1e-39, 1e-37, 1e-30, 1e-20, 1e-10}));
    default:
        return std::clamp(random.log(1e-9 * most, most), least, most);
    }
}

} // namespace

bool draw_ends(Random& random, Case& c) {
    std::vector<const Setting*> rows;
    for (const Setting& row : setting_table())
        if (drawn(row)) rows.push_back(&row);
    bool any = false;
    for (int n = random.whole(1, 3); n > 0; --n) {
        const Setting& row = *rows[random.next() % rows.size()];
        Settings changed = c.scene.settings;
        row.at.set(changed, end_of(row, random));
        // What a loader or a call refuses is no case.
        const auto refused = [&](const Edit& edit) { return !check_edit("", 0, edit, changed, {}, 0); };
        if (!validate(changed) || !validate(c.scene.fields, changed) ||
            std::any_of(c.commands.begin(), c.commands.end(), refused))
            continue;
        c.scene.settings = changed;
        any = true;
    }
    return any;
}

} // namespace wadi::fuzz
