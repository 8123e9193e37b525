// wadi-load-times: how long the shipped levels take to load, on one thread and on several, and whether they load to the same
// bits. Usage: wadi-load-times SIZE THREADS [LEVEL ...]; the levels are drawn on SIZE x SIZE cells.
#include "engine/level/level.hpp"
#include "engine/settings/rules/checksum.hpp"
#include "engine/threads/bands.hpp"
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <set>

namespace {

struct Load {
    double seconds = 0, processor_seconds = 0; // elapsed; of all threads together
    std::uint64_t checksum = 0;                // of fields and warnings
    std::string refusal;
};

Load load(const std::string& level, int size, int threads) {
    const wadi::ThreadLimit limit(threads);
    wadi::LevelOverrides overrides;
    overrides.size = {size, size};
    const std::clock_t processor = std::clock();
    const auto start = std::chrono::steady_clock::now();
    const auto loaded = wadi::load_level(std::string(WADI_SOURCE_DIR "/samples/levels/") + level + "/level.json", overrides);
    Load result;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.processor_seconds = static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC;
    if (!loaded) {
        result.refusal = loaded.status().message;
        return result;
    }
    const wadi::InitialFields& fields = loaded->fields;
    wadi::Checksum sum;
    for (const auto* field : {&fields.terrain, &fields.sand, &fields.water, &fields.velocity_x, &fields.velocity_y,
                              &fields.sand_velocity_x, &fields.sand_velocity_y, &loaded->settings.roughness})
        sum.add(std::as_bytes(std::span(*field)));
    for (const std::string& warning : loaded->warnings) sum.add(std::as_bytes(std::span(warning)));
    result.checksum = sum.value();
    return result;
}

} // namespace

int main(int argc, char** argv) {
    const int size = argc > 2 ? std::atoi(argv[1]) : 0, threads = argc > 2 ? std::atoi(argv[2]) : 0;
    if (size < 1 || threads < 1) {
        std::fprintf(stderr, "wadi-load-times SIZE THREADS [LEVEL ...]\n");
        return 2;
    }
    std::set<std::string> levels(argv + 3, argv + argc);
    if (levels.empty())
        for (const auto& entry : std::filesystem::directory_iterator(WADI_SOURCE_DIR "/samples/levels"))
            if (entry.is_directory()) levels.insert(entry.path().filename().string());
    std::printf("| level, %d x %d cells | one thread [s] | %d threads [s] | their processor time [s] | checksum |\n", size, size,
                threads);
    std::printf("| --- | ---: | ---: | ---: | --- |\n");
    int different = 0;
    for (const std::string& level : levels) {
        const Load one = load(level, size, 1), several = load(level, size, threads);
        if (!one.refusal.empty()) {
            std::fprintf(stderr, "%s\n", one.refusal.c_str());
            return 1;
        }
        const bool same = one.checksum == several.checksum;
        different += same ? 0 : 1;
        std::printf("| %s | %.3f | %.3f | %.3f | %016llx%s |\n", level.c_str(), one.seconds, several.seconds,
                    several.processor_seconds, static_cast<unsigned long long>(one.checksum), same ? "" : " DIFFERENT");
        std::fflush(stdout);
    }
    return different == 0 ? 0 : 1;
}
