#include "tests/conformance/perf_tiles.hpp"
#include "tests/conformance/worlds.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

namespace wadi::conformance {

namespace {

constexpr std::uint32_t all_effects = 2047 | EFFECT_SHOCK_VISCOSITY; // without bed load
constexpr int first_steps = 40; // until the rock sleeps, and a device at rest has raised its clocks

// The random scene in a basin of `share` of the area, 20 m below the rock around it.
Result<Scene> make_basin(int size, double share) {
    auto scene = make_large_scene(size, "random", all_effects & ~std::uint32_t{EFFECT_SOURCES | EFFECT_RAIN | EFFECT_OPEN_SIDES});
    if (!scene) return scene;
    scene->settings.method.largest_height += 20;
    const int side = static_cast<int>(std::lround(size * std::sqrt(share))), low = (size - side) / 2, high = low + side;
    auto& f = scene->fields;
    for (int j = 0; j < size; ++j) {
        for (int i = 0; i < size; ++i) {
            if (i >= low && i < high && j >= low && j < high) continue;
            const auto at = static_cast<std::size_t>(j) * static_cast<std::size_t>(size) + static_cast<std::size_t>(i);
            f.terrain[at] += 20;
            for (auto* field : {&f.sand, &f.water, &f.velocity_x, &f.velocity_y, &f.sand_velocity_x, &f.sand_velocity_y})
                if (!field->empty()) (*field)[at] = 0;
        }
    }
    return scene;
}

// Milliseconds per step by the host's clock: steps are submitted without waiting and the device finishes them all.
Result<double> time_steps(World& world, int steps) {
    const auto start = std::chrono::steady_clock::now();
    if (auto status = world.step(static_cast<std::uint32_t>(steps)); !status) return status;
    if (auto status = world.device().wait(world.stepper().ticket()); !status) return status;
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count() / steps;
}

Result<std::uint64_t> measure(Session& session, const Scene& scene, double share, const PerfTilesOptions& options) {
    auto world = open_world(session, scene);
    if (!world) return world.status();
    auto warm = time_steps(**world, first_steps);
    std::vector<double> times;
    while (warm && times.size() < static_cast<std::size_t>(options.repeats)) {
        warm = time_steps(**world, options.steps);
        if (warm) times.push_back(*warm);
    }
    if (!warm) return warm.status();
    std::sort(times.begin(), times.end());
    auto stats = (*world)->reader().stats();
    if (!stats) return stats.status();
    const double awake = stats->tiles > 0 ? static_cast<double>(stats->active_tiles) / static_cast<double>(stats->tiles) : 1.0;
    std::printf("%s,%d,%.3f,%d,%s,%.3f,%.4f,%.4f,%.4f,%.1f,%016llx\n", session.target().label().c_str(), options.size, share,
                scene.settings.active_tiles, (*world)->plan().fused ? "yes" : "no", awake, times.front(), times[times.size() / 2],
                times.back(), static_cast<double>((*world)->state().device().bytes()) / 1048576,
                static_cast<unsigned long long>(stats->hash));
    std::fflush(stdout);
    return stats->hash;
}

} // namespace

Status run_perf_tiles(Session& session, const PerfTilesOptions& options) {
    auto device = session.device();
    if (!device) return device.status();
    std::printf("backend,size,share,tiles,fused,awake,min_ms,median_ms,max_ms,world_mib,hash\n");
    for (const double share : options.shares) {
        auto scene = make_basin(options.size, share);
        if (!scene) return scene.status();
        std::optional<std::uint64_t> expected;
        for (const bool fused : {false, true}) {
            if (fused && (*device)->tuning().fused_gain_cells == 0) continue;
            if (!fused && options.fused_only) continue;
            scene->settings.fused_stages = fused ? FusedStages::always : FusedStages::never;
            for (const int side : options.tiles) {
                scene->settings.active_tiles = side;
                auto hash = measure(session, *scene, share, options);
                if (!hash) return hash.status();
                if (*hash != expected.value_or(*hash)) return error(Code::internal, "the last row ends in another state");
                expected = *hash;
            }
        }
    }
    return ok_status();
}

} // namespace wadi::conformance
