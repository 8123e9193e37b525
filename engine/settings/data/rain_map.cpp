#include "engine/settings/data/rain_map.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace wadi {

namespace {

constexpr float whole_share = 65536; // rain.glsl

} // namespace

bool rain_is_mapped(const Settings& settings) {
    for (const auto& [name, force] : settings.effects)
        if (name == "rain_map") return force == Force::on;
    return !settings.rain_map.empty();
}

double rain_peak(const Settings& settings) {
    if (!rain_is_mapped(settings) || settings.rain_map.empty()) return 1;
    return static_cast<double>(*std::max_element(settings.rain_map.begin(), settings.rain_map.end()));
}

std::vector<float> rain_shares(const Settings& settings) {
    const auto cells = static_cast<std::size_t>(settings.grid.nx) * static_cast<std::size_t>(settings.grid.ny);
    if (settings.rain_map.empty()) return std::vector<float>(cells, whole_share);
    const auto peak = static_cast<float>(std::max(rain_peak(settings), 1e-30));
    std::vector<float> shares(cells);
    std::transform(settings.rain_map.begin(), settings.rain_map.end(), shares.begin(),
                   [&](float times) { return std::round(times / peak * whole_share); });
    return shares;
}

} // namespace wadi
