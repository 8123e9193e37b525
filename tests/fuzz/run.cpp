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

std::string check_books(Run& run, const WorldStats& stats) {
    return run.world->settings().method.published() ? "" : run.world->checking().look(stats).message;
}

std::string same(Run& run, std::uint64_t got, std::uint64_t expected) {
    if (!run.refused.empty()) return "refused: " + run.refused;
    if (!run.failure.empty()) return run.failure;
    return got == expected ? "" : "other bits in the end";
}

} // namespace wadi::fuzz
