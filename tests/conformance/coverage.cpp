#include "tests/conformance/coverage.hpp"
#include "tests/conformance/case.hpp"
#include "tests/conformance/masks.hpp"
#include "tests/conformance/stage_checks.hpp"
#include <cstdio>
#include <set>

namespace wadi::conformance {

namespace {

// How many of `all` occur as a parameter of the cases.
std::size_t met(const std::vector<CaseSpec>& cases, const char* key, std::span<const char* const> all) {
    std::size_t count = 0;
    for (const std::string value : all) {
        for (const CaseSpec& spec : cases) {
            if (spec.get(key, "") != value) continue;
            ++count;
            break;
        }
    }
    return count;
}

} // namespace

int print_coverage() {
    int missing = 0;
    auto all = stage_suite().list();
    for (const CaseSpec& spec : fused_suite().list()) all.push_back(spec);
    std::printf("%-30s %9s %6s %7s %8s %9s  %s\n", "stage", "masks", "cases", "grids", "scenes", "methods", "compared with");
    const auto stages = compute::stage_table();
    for (std::size_t n = 0; n < stages.size(); ++n) {
        const std::string name(stages[n].name);
        std::vector<CaseSpec> cases;
        std::set<std::uint32_t> tested;
        for (const CaseSpec& spec : all) {
            if (spec.name != name) continue;
            cases.push_back(spec);
            if (auto mask = parse_effects(spec.get("effects", ""))) tested.insert(*mask & stages[n].tested_effects);
        }
        const auto masks = stage_masks(static_cast<int>(n));
        std::size_t covered = 0;
        for (const std::uint32_t mask : masks) {
            if (tested.contains(mask & stages[n].tested_effects)) {
                ++covered;
                continue;
            }
            ++missing;
            std::printf("MISSING: %s under %s\n", name.c_str(), effects_text(mask).c_str());
        }
        const bool reference = has_counterpart(name), definition = has_definition(name);
        const bool fused = stages[n].fused();
        if (!reference && !definition && !fused) ++missing;
        const char* with = fused                     ? "its parts"
                           : reference && definition ? "reference, definition"
                           : reference               ? "reference"
                           : definition              ? "definition"
                                                     : "NOTHING";
        std::printf("%-30s %4zu/%-4zu %6zu %3zu/%-3zu %4zu/%-3zu %5zu/%-3zu  %s\n", name.c_str(), covered, masks.size(),
                    cases.size(), met(cases, "grid", grid_names()), grid_names().size(), met(cases, "scene", scene_names()),
                    scene_names().size(), met(cases, "method", method_names_of_cases()), method_names_of_cases().size(), with);
    }
    for (const Suite* suite : {&contract_suite(), &stage_suite(), &step_suite(), &invariant_suite(), &fused_suite()})
        std::printf("%-9s %4zu cases: %s\n", suite->name, suite->list().size(), suite->meaning);
    std::printf("%d missing\n", missing);
    return missing > 0 ? 1 : 0;
}

} // namespace wadi::conformance
