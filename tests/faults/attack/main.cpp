// Usage: wadi-test-attack has BACKEND | environment [BACKEND] | memory | hosts SECONDS | files | cost | numbers | edited COUNT |
// jobs | failing_vulkan COUNT | soak BACKEND STEPS | cycles BACKEND COUNT.
#include "tests/faults/attack/attack.hpp"
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    using namespace attack;
    const std::string what = argc > 1 ? argv[1] : "", given = argc > 2 ? argv[2] : "";
    const auto ends = [](int failures) {
        std::puts(failures == 0 ? "passed" : "FAILED");
        return failures == 0 ? 0 : 1;
    };
    if (what == "hosts" && argc > 2) return ends(hosts(std::atof(argv[2])));
    if (what == "files") return ends(files());
    if (what == "numbers") return ends(numbers());
    if (what == "edited" && argc > 2) return ends(edited(std::atoi(argv[2])));
    if (what == "failing_vulkan" && argc > 2) return ends(failing_vulkan(std::atoi(argv[2])));
    if (what == "jobs") return ends(jobs());
    if (what == "cost") return ends(cost());
    if (what == "memory") return ends(memory());
    if (!given.empty()) backend = given;
    if (what == "has") {
        wadi_world_id world{};
        return make(8, world) == WADI_OK ? 0 : 1;
    }
    if (what == "environment") return ends(environment());
    if (what == "soak" && argc > 3) return ends(soak(std::atol(argv[3])));
    if (what == "cycles" && argc > 3) return ends(cycles(std::atol(argv[3])));
    std::fprintf(stderr, "wadi-test-attack has BACKEND | environment [BACKEND] | memory | hosts SECONDS | files | cost | numbers "
                         "| edited COUNT | jobs | failing_vulkan COUNT | soak BACKEND STEPS | cycles BACKEND COUNT\n");
    return 2;
}
