// Regions that the device checks against regions that the host checks.
#include "tests/fuzz/run.hpp"
#include <algorithm>
#include <cmath>

namespace wadi::fuzz {

namespace {

// Often a quarter of the way between quanta, now and then higher or lower than may be.
std::vector<float> draw(Random& random, std::size_t count, const Method& method) {
    const double quantum = height_quantum(method), most = method.largest_height;
    const double size = most * random.log(1e-4, 0.6);
    std::vector<float> values(count);
    for (float& value : values) {
        double height = random.chance(0.1) ? 0 : random.real(0, size);
        if (quantum > 0 && random.chance(0.7)) height = (std::floor(height / quantum) + 0.25 * random.whole(0, 3)) * quantum;
        value = static_cast<float>(random.chance(1e-3) ? random.pick({-1.0, 2.0}) * most : height);
    }
    return values;
}

ValueSource source_of(const std::vector<float>& values, int nx) {
    return {.handle = reinterpret_cast<std::uintptr_t>(values.data()), .row_pitch = static_cast<std::uint64_t>(nx) * 4};
}

} // namespace

std::string check_values(const Case& c, const Case& twin, Session& session, Session& other, Random& random) {
    Run host = open(c, session), device = open(twin, other);
    if (!host.good() || !device.good()) return host.failure + device.failure;
    queue(host, c);
    queue(device, twin);
    const Grid grid = c.scene.settings.grid;
    for (int done = 0; done < c.steps && host.good() && device.good(); ++done) {
        while (random.chance(0.5)) {
            Region region;
            region.i0 = random.whole(0, grid.nx - 1);
            region.j0 = random.whole(0, grid.ny - 1);
            region.nx = random.whole(1, grid.nx - region.i0);
            region.ny = random.whole(1, grid.ny - region.j0);
            const EditLayer layer = random.pick({EditLayer::terrain, EditLayer::sand, EditLayer::water});
            const auto values = draw(random, region.cells(), c.scene.settings.method);
            // Where nothing is left of the values by rounding the host leaves out a material that the device then has.
            const double half = height_quantum(c.scene.settings.method) / 2;
            const bool nothing =
                std::all_of(values.begin(), values.end(), [&](float v) { return static_cast<double>(v) <= half; });
            const std::uint32_t material = layer == EditLayer::terrain ? 0
                                           : layer == EditLayer::sand  ? EFFECT_SAND
                                                                       : EFFECT_WATER;
            if (nothing && (host.world->plan().effects & material) != material) continue;
            const auto written = host.world->commands().write_region(layer, region, values);
            if (!written && written.code != Code::bad_argument) host.note("write_region", written);
            if (!written) continue; // what the device would cut
            const auto same_values = device.world->commands().write_values(layer, region, source_of(values, region.nx));
            device.note("write_values", same_values);
        }
        auto stats = host.world->reader().stats();
        host.note("stats", stats.status());
        if (!stats) break;
        if (blown_up(c.scene.settings, *stats)) return {};
        const std::uint64_t expected = hash(host);
        if (!host.good()) break;
        if (auto wrong = same(device, hash(device), expected); !wrong.empty())
            return "values after step " + std::to_string(done) + ": " + wrong;
        step(host, 1);
        step(device, 1);
    }
    return host.failure + device.failure;
}

} // namespace wadi::fuzz
