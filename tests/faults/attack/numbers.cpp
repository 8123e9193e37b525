// A level that has everything, each of its numbers in turn replaced by odd ones: refused in words, or a world that steps to
// finite values.
#include "tests/faults/attack/attack.hpp"
#include <cctype>
#include <cstdio>
#include <string>
#include <vector>

namespace attack {
namespace {

const std::string level =
    R"({ "format_version": 1, "name": "numbers", "grid": { "nx": 10, "ny": 8, "dx": 0.5 }, "dt": 0.01, "duration": 2,
    "terrain": [ { "shape": "plane", "height": 0.4, "slope_x": -0.02 }, { "shape": "noise", "amplitude": 0.1, "wavelength": 3, "octaves": 2, "seed": 4 } ],
    "sand": [ { "shape": "cone", "center": [2, 2], "radius": 2, "height": 1 }, { "shape": "ridge", "points": [[3, 1], [4, 3]], "width": 0.5, "height": 0.3 } ],
    "water": [ { "shape": "box", "from": [3, 0], "to": [5, 4], "height": 0.5 } ],
    "roughness": [ { "shape": "box", "from": [0, 0], "to": [2, 2], "manning": 0.01 } ],
    "material": { "friction": 0.6, "cohesion_dry": 300, "manning": 0.02, "bed_shear": 0.02, "saturation": [0.2, 0.25, 0.33], "exchange_rate": 1e5 },
    "method": { "substeps": 3, "largest_height": 16, "velocity_clamp": 0.35, "dry_threshold": 1e-5 },
    "sides": { "east": { "kind": "level", "value": 0.8, "absorb": 2 }, "west": { "kind": "discharge", "value": [[0, 0.1], [1, 0.2]], "depth": 0.2 } },
    "sources": [ { "shape": "disc", "center": [2, 3], "radius": 0.6, "rate": [[0, 0.05], [1, 0.1]] } ], "rain": 0.0001,
    "edits": [ { "time": 0.02, "every": 0.01, "until": 1, "layer": "sand", "shape": "disc", "center": [2, 2], "radius": 0.8, "amount": 0.05 } ] })";

const char* const odd[] = {
    "0",     "-0",    "-1",  "1e-300", "5e-324", "1e38",     "-1e38", "1e300", "1e400", "2147483648", "18446744073709551616",
    "0.333", "1e-40", "1e9", "-1e9",   "NaN",    "Infinity", "null",  "\"1\"", "[1]",   "{}",         "true"};

/// Where numbers begin and how long they are: what stands behind a colon, a comma or a bracket.
std::vector<std::pair<std::size_t, std::size_t>> numbers_of(const std::string& text) {
    std::vector<std::pair<std::size_t, std::size_t>> places;
    bool in_word = false;
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] == '"') in_word = !in_word;
        if (in_word || (std::isdigit(static_cast<unsigned char>(text[at])) == 0 && text[at] != '-')) continue;
        const std::size_t end = text.find_first_not_of("0123456789.e-+", at);
        places.emplace_back(at, end - at);
        at = end - 1;
    }
    return places;
}

} // namespace

int numbers() {
    int taken = 0, refused = 0;
    for (const auto& [at, length] : numbers_of(level)) {
        for (const char* number : odd) {
            std::string text = level;
            text.replace(at, length, number);
            const std::string name = "a number at " + std::to_string(at) + " as " + number;
            auto options = wadi_default_device_options();
            options.backend = backend.c_str();
            options.threads = 1;
            wadi_cost most = wadi_default_cost(); // or a grid of 0.3e9 cells is one that is taken
            most.cells = 1000;
            options.most = &most;
            wadi_world_id world{};
            const auto made = wadi_create_world_from_level_text(text.c_str(), nullptr, nullptr, nullptr, &options, &world);
            if (made != WADI_OK) {
                ++refused;
                expect(made == WADI_ERROR_BAD_FILE || made == WADI_ERROR_BAD_ARGUMENT,
                       name + ": answered " + std::to_string(made));
                expect(wadi_get_last_error()[0] != '\0', name + ": no word is said");
                continue;
            }
            ++taken;
            auto stats = wadi_default_world_stats();
            expect(wadi_world_step(world, 3) == WADI_OK && wadi_world_get_stats(world, &stats) == WADI_OK, name + ": steps");
            expect(stats.not_finite == 0, name + ": values that are not finite");
            expect(stats.smallest_depth >= 0, name + ": a negative depth");
            wadi_destroy_world(world);
        }
    }
    std::printf("odd numbers in a level: %d taken, %d refused\n", taken, refused);
    expect(taken > 200 && refused > 500, "neither answer is the only one");
    return wrong;
}

} // namespace attack
