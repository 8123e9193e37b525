// wadi-test-cost: what a load allocates and how long it works, counted, against what its account says before: never more, and not
// far less. Each level leans on a term of the sum, so that an account without it says too little.
#include "tests/faults/own_new.hpp"
#include "tests/unit/map_files.hpp"
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <malloc.h>
#include <string>
#include <sys/resource.h>
#include <vector>
#include <wadi/wadi.h>

namespace {

std::atomic<long long> live{0}, most{0};

} // namespace

void* allocate(std::size_t size) noexcept {
    void* memory = std::malloc(size == 0 ? 1 : size);
    if (memory == nullptr) return nullptr;
    const long long now = live += static_cast<long long>(malloc_usable_size(memory));
    for (long long seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
    }
    return memory;
}
void release(void* memory) noexcept {
    if (memory != nullptr) live -= static_cast<long long>(malloc_usable_size(memory));
    std::free(memory);
}

namespace {

int wrong = 0;

void expect(bool good, const std::string& what) {
    if (good) return;
    ++wrong;
    std::fprintf(stderr, "WRONG: %s (%s)\n", what.c_str(), wadi_get_last_error());
}

double cpu_seconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// Of one load: what its account says, and what it took. Of the host's memory and the device's, of work and time.
struct Load {
    wadi_cost said = wadi_default_cost();
    double host = 0, device = 0, seconds = 0;
};

struct DeviceMemory {
    double live = 0, most = 0;
};
void* give(void* user, std::size_t bytes, std::size_t alignment) {
    auto& memory = *static_cast<DeviceMemory*>(user);
    memory.live += static_cast<double>(bytes);
    memory.most = std::max(memory.most, memory.live);
    return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}
void take_back(void* user, void* memory, std::size_t bytes) {
    static_cast<DeviceMemory*>(user)->live -= static_cast<double>(bytes);
    std::free(memory);
}

Load load(const std::string& name, const std::string& path) {
    Load one;
    expect(wadi_get_level_cost(path.c_str(), nullptr, &one.said) == WADI_OK, name + ": its account");
    DeviceMemory memory;
    auto options = wadi_default_device_options();
    options.backend = "cpu";
    options.threads = 1;
    options.allocate_memory = give;
    options.free_memory = take_back;
    options.memory_user = &memory;
    wadi_world_id world{};
    const long long before = live;
    most = before;
    const double begin = cpu_seconds();
    expect(wadi_create_world_from_level(path.c_str(), nullptr, &options, &world) == WADI_OK, name + ": loads");
    one.seconds = cpu_seconds() - begin;
    one.host = static_cast<double>(most - before);
    one.device = memory.most;
    expect(wadi_destroy_world(world) == WADI_OK, name + ": ends");
    return one;
}

std::string head(int n) {
    const std::string size = std::to_string(n);
    return R"({ "format_version": 1, "name": "cost", "dt": 0.01, "grid": { "nx": )" + size + R"(, "ny": )" + size +
           R"(, "dx": 0.5 })";
}

std::string repeated(int count, const std::string& what) {
    std::string text;
    for (int n = 0; n < count; ++n) text += (n == 0 ? "" : ", ") + what;
    return text;
}

} // namespace

int main() {
    const map_files::Folder folder;
    const auto grid_of = [&](const char* name, int nx, int ny) {
        const std::string shape = "(" + std::to_string(ny) + ", " + std::to_string(nx) + ")";
        folder.write(name,
                     map_files::npy(map_files::dictionary("<f4", shape.c_str()),
                                    std::vector<float>(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny), 0.25F)));
    };
    grid_of("equal.npy", 1000, 1000);
    grid_of("large.npy", 1900, 1700);
    folder.write("colours.png", map_files::png_of_zeros(1500, 1400, 16, 6));
    folder.write("grey.png", map_files::png_of_zeros(3000, 2800, 8, 0));
    std::string points, rows;
    for (int n = 0; n < 100000; ++n) points += (n == 0 ? "[" : ",[") + std::to_string(n) + ",1]";
    for (int n = 0; n < 300000; ++n) rows += std::to_string(n) + ",1\n";
    folder.write("rain.csv", rows);
    const std::string ridge = [] {
        std::string text = R"({ "shape": "ridge", "width": 3, "height": 1, "points": [)";
        for (int n = 0; n < 256; ++n)
            text += (n == 0 ? "[" : ",[") + std::to_string(n % 16 * 15) + "," + std::to_string(n / 16 * 15) + "]";
        return text + "] }";
    }();
    const std::string wall = [&] {
        std::string text = ridge;
        return text.replace(text.find("\"width\": 3"), 10, "\"width\": 0.2");
    }();
    const std::string noise = R"({ "shape": "noise", "amplitude": 0.1, "wavelength": 3, "octaves": 12, "seed": 1 })",
                      disc = R"({ "shape": "cylinder", "center": [60, 60], "radius": 55, "height": 0.1 })",
                      flow = R"({ "shape": "plane", "of": "water", "velocity": [1, 0] })",
                      rough = R"({ "shape": "plane", "manning": 0.001 })",
                      water = R"(, "water": [ { "shape": "plane", "height": 1 } ])";
    struct Level {
        const char* name;
        std::string text;
        enum { memory, work } of;
    };
    const Level levels[] = {
        {"text", head(16) + R"(, "rain": [ )" + points + " ] }", Level::memory},
        {"series", head(16) + R"(, "rain": { "file": "rain.csv" } })", Level::memory},
        {"map, larger than the grid", head(64) + R"(, "terrain": [ { "file": "large.npy" } ] })", Level::memory},
        {"PNG of grey", head(64) + R"(, "terrain": [ { "file": "grey.png", "max": 1 } ] })", Level::memory},
        {"PNG of colours", head(64) + R"(, "terrain": [ { "file": "colours.png", "max": 1 } ] })", Level::memory},
        {"map of the grid's size", head(1000) + R"(, "terrain": [ { "file": "equal.npy" } ] })", Level::memory},
        {"a lake's map on another grid", head(64) + R"(, "terrain": [ { "shape": "plane", "height": 0, "slope_x": 0.1 } ],
            "water": [ { "file": "large.npy", "absolute": true } ] })",
         Level::memory},
        {"fields",
         head(1000) + R"(, "terrain": [ { "shape": "plane", "height": 1 } ])" + water + R"(, "velocities": [ )" + flow +
             R"( ], "roughness": [ )" + rough + " ] }",
         Level::memory},
        {"sand in balance",
         head(700) +
             R"(, "sand": [ { "shape": "cone", "center": [170, 170], "radius": 160, "height": 10 } ], "water": [ { "shape": "plane", "height": 0.01 } ], "material": { "cohesion_dry": 300 } })",
         Level::memory},
        {"noise", head(300) + R"(, "terrain": [ )" + repeated(8, noise) + " ] }", Level::work},
        {"ridges", head(480) + R"(, "terrain": [ )" + repeated(3, ridge) + " ] }", Level::work},
        {"edges through cells", head(260) + R"(, "sand": [ )" + repeated(20, disc) + " ] }", Level::work},
        {"walls thinner than a cell", head(480) + R"(, "terrain": [ )" + repeated(12, wall) + " ] }", Level::work},
        {"velocities", head(700) + water + R"(, "velocities": [ )" + repeated(60, flow) + " ] }", Level::work},
        {"roughness", head(700) + water + R"(, "roughness": [ )" + repeated(60, rough) + " ] }", Level::work},
    };
    // Every load is compared with one of next to nothing.
    const Load small = load("a small one", folder.write("level.json", head(16) + " }"));
    std::printf("| level | MiB said | MiB taken | MiB of the device said | taken | million looks said | CPU ms | ns a look |\n"
                "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    constexpr double mebi = 1 << 20, most_said = 5, most_nanoseconds = 200;
    for (const Level& level : levels) {
        const std::string name = level.name;
        const std::string path = folder.write("level.json", level.text);
        const Load one = load(name, path);
        const double said = static_cast<double>(one.said.host_bytes) - static_cast<double>(small.said.host_bytes),
                     taken = one.host - small.host, looks = static_cast<double>(one.said.work), seconds = one.seconds,
                     device = static_cast<double>(one.said.device_bytes);
        std::printf("| %s | %.1f | %.1f | %.1f | %.1f | %.2f | %.0f | %.1f |\n", level.name, said / mebi, taken / mebi,
                    device / mebi, one.device / mebi, looks / 1e6, 1e3 * seconds, 1e9 * seconds / looks);
        expect(one.device <= device, name + ": takes more of the device than was said");
        expect(taken <= said, name + ": takes more than was said");
        if (level.of == Level::memory) expect(said < most_said * taken + 16 * mebi, name + ": far less than was said");
        if (level.of == Level::work) expect(1e9 * seconds < most_nanoseconds * looks, name + ": works longer than was said");
    }
    std::puts(wrong == 0 ? "passed" : "FAILED");
    return wrong == 0 ? 0 : 1;
}
