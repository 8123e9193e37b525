#include "springs.hpp"

namespace viewer {

std::vector<Spring> list_springs(const Simulation& simulation, uint32_t first) {
    wadi_world_info info = wadi_default_world_info();
    check(wadi_world_get_info(simulation.world, &info), "describing the world");
    std::vector<Spring> springs;
    for (uint32_t n = first; n < info.source_count; ++n) {
        wadi_source source = wadi_default_source();
        check(wadi_world_get_source(simulation.world, n, &source), "the sources");
        springs.push_back({n,
                           source.sand != 0,
                           {static_cast<float>(source.center[0]), static_cast<float>(source.center[1])},
                           static_cast<float>(source.radius),
                           source.rate_count > 0 ? static_cast<float>(source.rate[0].value) : 0.0f});
    }
    return springs;
}

uint32_t free_spring(const Simulation& simulation, uint32_t first) {
    uint32_t next = first;
    for (const Spring& spring : list_springs(simulation, first)) {
        if (spring.rate == 0) return spring.index;
        next = spring.index + 1;
    }
    return next;
}

void set_spring(const Simulation& simulation, const Spring& spring) {
    const wadi_sample rate{0, static_cast<double>(spring.rate)};
    wadi_source source = wadi_default_source();
    source.sand = spring.sand ? 1 : 0;
    source.center[0] = static_cast<double>(spring.middle.x);
    source.center[1] = static_cast<double>(spring.middle.y);
    source.radius = static_cast<double>(spring.radius);
    source.rate = &rate;
    source.rate_count = 1;
    check(wadi_world_set_source(simulation.world, spring.index, &source), "placing a source");
}

} // namespace viewer
