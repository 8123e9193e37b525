#include "tests/fuzz/run.hpp"
#include "tests/conformance/worlds.hpp"
#include <algorithm>
#include <cmath>

namespace wadi::fuzz {

std::string text(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.9g", value);
    return buffer;
}

void Run::note(const char* what, const Status& status) {
    if (!status && failure.empty()) failure = std::string(what) + ": " + code_name(status.code) + ": " + status.message;
}

Run open(const Case& c, Session& session) {
    Run run;
    auto world = conformance::open_world(session, c.scene);
    if (world)
        run.world = std::move(*world);
    else
        run.refused = world.status().message;
    return run;
}

void queue(Run& run, const Case& c, std::uint64_t from) {
    std::vector<Edit> later;
    for (const Edit& edit : c.commands)
        if (edit.step >= from) later.push_back(edit);
    if (run.good() && !later.empty()) run.note("edit", run.world->commands().edit(later));
}

void step(Run& run, int count) {
    if (run.good() && count > 0) run.note("step", run.world->step(static_cast<std::uint32_t>(count)));
}

std::uint64_t hash(Run& run) {
    if (!run.good()) return 0;
    auto value = run.world->reader().hash();
    run.note("hash", value.status());
    return value ? *value : 0;
}

bool blown_up(const Settings& settings, const WorldStats& s) {
    if (!settings.method.published()) return false;
    return s.not_finite > 0 || std::max(s.largest_sand, s.largest_water) > 1e6 * settings.method.largest_height;
}

// Where the ledger is exact: a quantum, a limiter, and no column that could have passed the declared largest height.
std::string check_books(Run& run, const Case& c, const WorldStats& s, double raised) {
    const auto& m = c.scene.settings.method;
    if (m.published()) return {}; // it may blow up, and has neither quanta nor caps
    if (s.not_finite > 0) return std::to_string(s.not_finite) + " values are not finite";
    double ground = 0;
    for (const float h : c.scene.fields.terrain) ground = std::max(ground, std::fabs(static_cast<double>(h)));
    for (const Edit& edit : c.commands)
        if (edit.kind != EditKind::push && edit.layer == EditLayer::terrain) ground += std::fabs(edit.amount);
    // Twice: a column may stand higher between two sand steps than at the end of either step (1.5 times, seed 947002751).
    run.too_high = run.too_high || !(ground + raised + 2 * (s.largest_sand + s.largest_water) < m.largest_height);
    if (s.smallest_height < 0) return "a height is " + text(s.smallest_height) + " m";
    const std::int64_t water = s.water_quanta - (s.water_initial + s.ledger.water_in - s.ledger.water_out),
                       sand = s.sand_quanta - (s.sand_initial + s.ledger.sand_in - s.ledger.sand_out);
    if (height_quantum(m) > 0 && !run.too_high && (water != 0 || sand != 0))
        return "off the ledger by " + std::to_string(water) + " quanta of water and " + std::to_string(sand) + " of sand";
    const auto& set = run.world->settings();
    const double clamp = m.velocity_clamp * set.grid.dx / set.dt * (1 + 1e-6);
    if (s.largest_water_speed > clamp) return "water at " + text(s.largest_water_speed) + " m/s, the clamp is " + text(clamp);
    if (s.largest_sand_speed > clamp * m.substeps)
        return "sand at " + text(s.largest_sand_speed) + " m/s, the clamp is " + text(clamp * m.substeps);
    return {};
}

std::string same(Run& run, std::uint64_t got, std::uint64_t expected) {
    if (!run.refused.empty()) return "refused: " + run.refused;
    if (!run.failure.empty()) return run.failure;
    return got == expected ? "" : "other bits in the end";
}

} // namespace wadi::fuzz
