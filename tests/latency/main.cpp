// wadi-latency: how long the calls of a frame keep a host's thread, while the device is busy: at first use, at a promotion, in
// steady state and at changes of the material. Usage: wadi-latency [BACKEND [THREADS]]. Writes a table in Markdown.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <sys/resource.h>
#include <thread>
#include <vector>
#include <wadi/wadi.h>

namespace {

using Clock = std::chrono::steady_clock;

constexpr int cells = 256, frames_per_phase = 300, query_points = 16;
constexpr auto frame_time = std::chrono::nanoseconds(16'666'667); // 60 Hz

void check(wadi_result result, const char* call) {
    if (result == WADI_OK || result == WADI_NOT_READY) return;
    std::fprintf(stderr, "%s: %s\n", call, wadi_get_last_error());
    std::exit(1);
}

/// Times of one kind of call in one phase [us]; those in which the system took the core away for somebody else apart.
struct Samples {
    std::vector<double> all, undisturbed;
};
std::map<std::string, Samples> samples;

long preemptions() {
    rusage usage{};
    getrusage(RUSAGE_THREAD, &usage);
    return usage.ru_nivcsw;
}

template <class Call> void timed(const char* name, const Call& call) {
    const long before = preemptions();
    const auto start = Clock::now();
    const wadi_result result = call();
    const double us = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
    check(result, name);
    samples[name].all.push_back(us);
    if (preemptions() == before) samples[name].undisturbed.push_back(us);
}

double percentile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

/// Dry sand on a slope; the water comes later.
wadi_world_id make_world(const char* backend, int threads) {
    std::vector<float> terrain, sand;
    for (int j = 0; j < cells; ++j) {
        for (int i = 0; i < cells; ++i) {
            terrain.push_back(0.02F * static_cast<float>(i) + 0.3F * std::sin(0.07F * static_cast<float>(j)));
            sand.push_back(std::max(0.0F, 3 - 0.05F * std::hypot(static_cast<float>(i - 128), static_cast<float>(j - 128))));
        }
    }
    auto arrays = wadi_default_world_arrays();
    arrays.settings_json =
        R"({"format_version": 1, "name": "latency", "grid": {"nx": 256, "ny": 256, "dx": 0.25}, "dt": 0.00833333})";
    arrays.nx = arrays.ny = cells;
    arrays.terrain = terrain.data();
    arrays.sand = sand.data();
    auto options = wadi_default_device_options();
    options.backend = backend;
    options.threads = threads;
    wadi_world_id world{};
    check(wadi_create_world_from_arrays(&arrays, &options, &world), "create");
    return world;
}

struct Host {
    wadi_world_id world;
    std::vector<unsigned char> snapshot;
    uint64_t save_ticket = 0, query_ticket = 0;
    bool saving = false;
    int busy = 0;
    double dropped = 0; // [s]

    void frame(const std::string& phase, int n) {
        auto edit = wadi_default_edit();
        edit.layer = phase == "promotion" && n > frames_per_phase / 2 ? WADI_LAYER_WATER : WADI_LAYER_SAND;
        if (phase == "steady" || phase == "material") edit.layer = n % 2 == 0 ? WADI_LAYER_WATER : WADI_LAYER_SAND;
        edit.x0 = 20 + 20 * std::sin(0.1 * n);
        edit.y0 = 32;
        edit.radius = 2;
        edit.amount = 0.02;
        timed("edit", [&] { return wadi_world_edit(world, &edit, 1); });
        if (phase == "material" && n % 30 == 15)
            timed("set_material", [&] { return wadi_world_set_material(world, "cohesion_dry", 100.0 + n); });
        auto state = wadi_default_frame();
        timed("update", [&] { return wadi_world_update(world, static_cast<uint64_t>(frame_time.count()), &state); });
        dropped += 1e-9 * static_cast<double>(state.dropped_nanoseconds);
        float xy[2 * query_points];
        for (int p = 0; p < query_points; ++p) {
            xy[2 * p] = 4.0F * static_cast<float>(p);
            xy[2 * p + 1] = 30;
        }
        timed("query", [&] { return wadi_world_query(world, xy, query_points, &query_ticket); });
        wadi_query_result answers[query_points];
        timed("get_query", [&] { return wadi_world_get_query(world, query_ticket, answers, query_points, nullptr, nullptr); });
        if (!saving && n % 60 == 20) {
            timed("begin_save", [&] { return wadi_world_begin_save(world, &save_ticket); });
            size_t bytes = 0;
            check(wadi_world_end_save(world, save_ticket, nullptr, &bytes), "end_save: size");
            snapshot.resize(bytes);
            saving = true;
        } else if (saving) {
            size_t bytes = snapshot.size();
            wadi_result fetched = WADI_OK;
            timed("end_save", [&] { return fetched = wadi_world_end_save(world, save_ticket, snapshot.data(), &bytes); });
            saving = fetched != WADI_OK;
        }
        auto view = wadi_default_output_view();
        if (wadi_world_get_view(world, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT, &view) == WADI_OK && view.finished == 0)
            ++busy;
    }
};

} // namespace

int main(int argc, char** argv) {
    Host host{make_world(argc > 1 ? argv[1] : "cpu", argc > 2 ? std::atoi(argv[2]) : 0), {}};
    check(wadi_world_set_outputs(host.world, WADI_OUTPUT_BIT(WADI_OUTPUT_FREE_SURFACE) |
                                                 WADI_OUTPUT_BIT(WADI_OUTPUT_SAND_SURFACE) | WADI_OUTPUT_BIT(WADI_OUTPUT_FLOW) |
                                                 WADI_OUTPUT_BIT(WADI_OUTPUT_NORMAL) | WADI_OUTPUT_TILES_BIT),
          "set_outputs");
    check(wadi_world_set_host_outputs(host.world, WADI_OUTPUT_BIT(WADI_OUTPUT_FREE_SURFACE)), "set_host_outputs");
    check(wadi_world_prepare_effects(host.world), "prepare_effects");
    auto info = wadi_default_world_info();
    check(wadi_world_get_info(host.world, &info), "get_info");
    std::printf(
        "%s, %d x %d cells, 60 Hz, %d frames each; us. In brackets without the calls in which the system took the core away.\n\n",
        info.device_name, cells, cells, frames_per_phase);
    std::printf(
        "| moment | device busy | dropped | call | n | p50 | p99 | max |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (const std::string phase : {"first use", "promotion", "steady", "material"}) {
        samples.clear();
        host.busy = 0;
        host.dropped = 0;
        auto next = Clock::now();
        for (int n = 0; n < frames_per_phase; ++n) {
            host.frame(phase, n);
            next = std::max(next + frame_time, Clock::now());
            std::this_thread::sleep_until(next);
        }
        for (const auto& [call, s] : samples) {
            const auto both = [&, &times = s](double share) {
                char text[64];
                std::snprintf(text, sizeof text, "%.0f (%.0f)", percentile(times.all, share),
                              percentile(times.undisturbed, share));
                return std::string(text);
            };
            std::printf("| %s | %d %% | %.2f s | %s | %zu (%zu) | %s | %s | %s |\n", phase.c_str(),
                        100 * host.busy / frames_per_phase, host.dropped, call.c_str(), s.all.size(), s.undisturbed.size(),
                        both(0.5).c_str(), both(0.99).c_str(), both(1).c_str());
        }
    }
    check(wadi_destroy_world(host.world), "destroy");
    return 0;
}
