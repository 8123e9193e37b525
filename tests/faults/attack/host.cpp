// What every room does as a host.
#include "tests/faults/attack/attack.hpp"
#include <cstdio>
#include <fstream>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace attack {

std::atomic<int> wrong{0};

bool expect(bool good, const std::string& what) {
    if (good) return true;
    ++wrong;
    std::fprintf(stderr, "WRONG: %s (%s)\n", what.c_str(), wadi_get_last_error());
    return false;
}

std::string backend = "cpu";

namespace {
std::string level_text(int n) {
    const std::string size = std::to_string(n);
    return R"({ "format_version": 1, "name": "attack", "grid": { "nx": )" + size + R"(, "ny": )" + size +
           R"(, "dx": 0.5 }, "dt": 0.02, "terrain": [ { "shape": "plane", "height": 0.15, "slope_x": 0.02 } ],)"
           R"("water": [ { "shape": "box", "from": [0, 0], "to": [4.5, 6.25], "height": 1.5 } ],)"
           R"("sand": [ { "shape": "cone", "center": [8.5, 8], "radius": 3.5, "height": 1.25 } ],)"
           R"("sources": [ { "shape": "disc", "center": [3, 3], "radius": 0.75, "rate": [[0, 0.25], [1, 0.125]] } ],)"
           R"("rain": 1e-5, "evaporation": 1e-5, "sides": { "east": { "kind": "outflow" } } })";
}
} // namespace

wadi_result make(int n, wadi_world_id& world) {
    auto options = wadi_default_device_options();
    options.backend = backend.c_str();
    options.threads = 2;
    return wadi_create_world_from_level_text(level_text(n).c_str(), nullptr, nullptr, nullptr, &options, &world);
}

wadi_edit brush(wadi_layer layer) {
    auto edit = wadi_default_edit();
    edit.layer = layer;
    edit.x0 = edit.y0 = 5.5;
    edit.radius = 1.5;
    edit.amount = 0.0625;
    return edit;
}

bool ledger_holds(wadi_world_id world) {
    auto stats = wadi_default_world_stats();
    return wadi_world_get_stats(world, &stats) == WADI_OK && stats.water_drift_quanta == 0 && stats.sand_drift_quanta == 0;
}

std::uint64_t session() {
    wadi_world_id world{};
    if (!expect(make(32, world) == WADI_OK, "create")) return 0;
    const auto edit = brush(WADI_LAYER_SAND);
    bool good = wadi_world_step(world, 5) == WADI_OK && wadi_world_edit(world, &edit, 1) == WADI_OK;
    size_t bytes = 0;
    good = good && wadi_world_save(world, nullptr, &bytes) == WADI_OK;
    std::vector<unsigned char> snapshot(bytes);
    good = good && wadi_world_save(world, snapshot.data(), &bytes) == WADI_OK && wadi_world_step(world, 3) == WADI_OK &&
           wadi_world_load(world, snapshot.data(), bytes) == WADI_OK;
    for (int n = 0; n < 10; ++n) good = good && wadi_world_step(world, 1) == WADI_OK; // an update drops time where all is busy
    std::uint64_t hash = 0;
    good = good && ledger_holds(world) && wadi_world_get_hash(world, &hash) == WADI_OK;
    expect(good, "a session");
    expect(wadi_destroy_world(world) == WADI_OK, "destroy");
    return good ? hash : 0;
}

Child run_child(const std::function<int()>& body) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        alarm(120);
        wrong = 0;
        const int code = body();
        std::fflush(nullptr);
        _exit(code);
    }
    int status = 0;
    rusage used{};
    wait4(child, &status, 0, &used);
    const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), seconds(used.ru_utime) + seconds(used.ru_stime),
            static_cast<double>(used.ru_maxrss) / 1024};
}

std::uint64_t pages(int column) {
    std::ifstream statm("/proc/self/statm");
    std::uint64_t value = 0;
    for (int n = 0; n <= column; ++n) statm >> value;
    return value;
}

} // namespace attack
