// What the stages are given of a world's settings: numbers that a float holds, whatever the settings are.
#include "engine/settings/data/method_presets.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "engine/settings/rules/checks.hpp"
#include "engine/step/plan/world_params.hpp"
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <string>

using namespace wadi;

namespace {

/// Next to nothing and the ends; nothing where the setting is no number.
std::vector<double> ends(const Setting& row) {
    if (row.at.kind != SettingKind::number) return {};
    std::vector<double> values = {row.values.least, row.values.most};
    for (const double value : {5e-324, 1e-300, 1e-50, 1e-45, 1e-40, 1e-35, 1e-30, 1e-20, 1e-10})
        if (value > row.values.least && value < row.values.most) values.push_back(value);
    return values;
}

/// Words that are no finite float; whole numbers of the struct are small and read as floats next to 0.
int not_finite(const WorldParams& params) {
    std::array<std::uint32_t, sizeof(WorldParams) / 4> words{};
    static_assert(sizeof(words) == sizeof(WorldParams));
    std::memcpy(words.data(), &params, sizeof params);
    int count = 0;
    for (const std::uint32_t word : words) count += std::isfinite(std::bit_cast<float>(word)) ? 0 : 1;
    return count;
}

} // namespace

TEST_CASE("world params: finite for any two settings at their ends or next to nothing") {
    Settings base;
    base.grid = {12, 9, 0.5};
    base.dt = 0.01;
    WorldParams broken = derive_params(base, ~0u); // negative control
    REQUIRE(not_finite(broken) == 0);
    broken.inv_bulk = 1 / 0.0F;
    REQUIRE(not_finite(broken) == 1);
    int cases = 0;
    for (const Setting& first : setting_table()) {
        for (const double value : ends(first)) {
            for (const Setting& second : setting_table()) {
                for (const double other : ends(second)) {
                    Settings settings = base;
                    first.at.set(settings, value);
                    second.at.set(settings, other);
                    if (!validate(settings)) continue;
                    ++cases;
                    const int wrong = not_finite(derive_params(settings, ~0u));
                    if (wrong > 0)
                        FAIL_CHECK(std::string(first.path)
                                   << " " << value << ", " << std::string(second.path) << " " << other << ": " << wrong);
                }
            }
        }
    }
    CHECK(cases > 10000);
}
