// The level digest: that of the levels that ship, as snapshots and command logs hold it.
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/level_digest.hpp"
#include "tests/unit/level_text.hpp"
#include <doctest/doctest.h>

using namespace wadi;
using namespace level_text;

TEST_CASE("level digest: of the shipped levels, which older snapshots hold") {
    // Changes only where a level itself does: then its snapshots and command logs of before are refused, the changelog says so,
    // and its number is to be replaced. A new setting changes none (engine/saves/README.md, Older saves).
    const std::pair<const char*, std::uint64_t> levels[] = {
        {"beach", 3791430135325981710u},      {"canyon", 3014186152427248135u}, {"castle", 12928769157647407096u},
        {"dam_break", 15137642373119595880u}, {"flush", 10252739562935237152u}, {"letters", 13563642716355832467u},
        {"piles", 654329089190002482u},       {"seepage", 793414438401673331u}, {"spring", 16250010896528242060u},
        {"wadi", 785892584679966680u},
    };
    for (const auto& [name, digest] : levels) {
        const auto level = load_level((samples() / name / "level.json").string(), {});
        REQUIRE_MESSAGE(level, message(level));
        CHECK_MESSAGE(level_digest(level->settings) == digest, name << " " << level_digest(level->settings));
    }
}

TEST_CASE("level digest: of a level that sets everything") {
    const auto level = parse(R"("gravity": 3,
        "material": {"water_density": 1001, "sand_density": 2001, "friction": 0.51, "young_modulus": 2.5e5, "poisson_ratio": 0.31,
            "yield_friction": 0.41, "cohesion_dry": 1, "cohesion_wet": 2.1e4, "cohesion_capillary": 2.2e4,
            "saturation": [0.21, 0.26, 0.34], "exchange_rate": 1.1e5, "diffusion_rate": 0.02, "bed_friction": 0.04,
            "bed_shear": 0.03, "grain_size": 2e-3, "slope_normal": 0.9, "internal_friction": 0.3, "sand_viscosity": 0.02,
            "retention": 0.45},
        "method": {"name": "published", "substeps": 4, "outflow_limiter": false, "quantum": 0.25, "largest_height": 17,
            "dry_threshold": 2e-5, "velocity_clamp": 0.36, "gravity_cap": 0.56,
            "sand_gravity_cap": 0.26, "elastic_cap": 0.21, "shock_viscosity": 0, "bulk_viscosity": 0.02, "rest_rule": false,
            "passive_pressure": 2, "gradient_clamp": 0.41, "cohesion_cap": 0.91,
            "saturation_smoothing": 1, "strain_transport": "direct", "water_transport_order": 2})");
    REQUIRE_MESSAGE(level, message(level));
    CHECK_MESSAGE(level_digest(level->settings) == 16847324541051533882u, level_digest(level->settings));
}

TEST_CASE("level digest: roughness counts, cell by cell") {
    Settings none;
    none.grid = {2, 1, 0.5};
    Settings some = none, other = none;
    some.roughness = {0.01F, 0.02F};
    other.roughness = {0.02F, 0.01F};
    CHECK(level_digest(some) != level_digest(none));
    CHECK(level_digest(some) != level_digest(other));
    Settings rained_on = none;
    rained_on.rain_map = some.roughness;
    CHECK(level_digest(rained_on) != level_digest(none));
    CHECK(level_digest(rained_on) != level_digest(some));
}

TEST_CASE("level digest: every row that the digest covers changes it, no other does") {
    Settings normal;
    normal.grid = {20, 10, 0.5};
    normal.dt = 0.01;
    for (const Setting& row : setting_table()) {
        CAPTURE(row.path);
        Settings other = normal;
        const double value = row.at.get(normal);
        row.at.set(other, value == row.values.most ? row.values.least : row.values.most);
        CHECK((level_digest(other) != level_digest(normal)) == (row.in_digest != InDigest::no));
    }
}
