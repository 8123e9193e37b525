// What loading takes of the host's memory, against what its account says before: never more, and an account that a host can use.
#include "tests/faults/attack/attack.hpp"
#include "tests/unit/map_files.hpp"
#include <cstdio>
#include <vector>

namespace attack {

int cost() {
    const map_files::Folder folder;
    const auto head = [](int n) {
        return R"({ "format_version": 1, "name": "cost", "dt": 0.01, "grid": { "nx": )" + std::to_string(n) + R"(, "ny": )" +
               std::to_string(n) + R"(, "dx": 0.5 })";
    };
    const auto map_of = [&](const char* name, int nx, int ny) {
        folder.write(name, map_files::npy(
                               map_files::dictionary("<f4", ("(" + std::to_string(ny) + ", " + std::to_string(nx) + ")").c_str()),
                               std::vector<float>(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny), 0.25F)));
    };
    map_of("equal.npy", 1024, 1024);
    map_of("large.npy", 3000, 2800);
    folder.write("large.png", map_files::png_of_zeros(4000, 4000, 16, 6));
    std::string numbers;
    for (int n = 0; n < 1500000; ++n) numbers += "1 ";
    folder.write("grid.asc", "ncols 1500\nnrows 1000\nxllcorner 0\nyllcorner 0\ncellsize 1\n" + numbers);
    std::string points;
    for (int n = 0; n < 400000; ++n) points += (n == 0 ? "[" : ",[") + std::to_string(n) + ",1]";
    const std::string sand = R"(, "sand": [ { "shape": "cone", "center": [200, 200], "radius": 150, "height": 10 } ])";
    const std::pair<const char*, std::string> levels[] = {
        {"shapes",
         head(1024) + R"(, "terrain": [ { "shape": "plane", "height": 1 } ], "water": [ { "shape": "cylinder", "center": [90, 90],
            "radius": 60, "height": 2 } ])" +
             sand + " }"},
        {"map of its size", head(1024) + R"(, "terrain": [ { "file": "equal.npy" } ] })"},
        {"larger map", head(512) + R"(, "terrain": [ { "file": "large.npy" } ] })"},
        {"depths on another grid",
         head(512) + R"(, "terrain": [ { "file": "equal.npy" } ], "water": [ { "file": "large.npy" } ] })"},
        {"PNG of colours", head(512) + R"(, "terrain": [ { "file": "large.png", "max": 1 } ] })"},
        {"Esri ASCII grid", head(512) + R"(, "terrain": [ { "file": "grid.asc" } ] })"},
        {"velocities, roughness",
         head(800) +
             R"(, "water": [ { "shape": "plane", "height": 1 } ], "velocities": [ { "shape": "plane", "of": "water", "velocity": [1, 0] } ],
            "roughness": [ { "shape": "plane", "manning": 0.02 } ] })"},
        {"5 MB of text", head(64) + R"(, "rain": [ )" + points + " ] }"},
        {"a small one", head(16) + " }"},
    };
    std::printf("| level | MiB said | MiB taken | MiB the account took |\n| --- | --- | --- | --- |\n");
    for (const auto& [name, text] : levels) {
        const std::string path = folder.write("level.json", text);
        auto said = wadi_default_cost();
        if (!expect(wadi_get_level_cost(path.c_str(), nullptr, &said) == WADI_OK,
                    std::string(name) + ": " + wadi_get_last_error()))
            continue;
        const auto nothing = run_child([] { return 0; }); // what children begin with
        const auto asked = run_child([&] {
            auto cost = wadi_default_cost();
            return wadi_get_level_cost(path.c_str(), nullptr, &cost) == WADI_OK ? 0 : 1;
        });
        const auto ran = run_child([&] {
            auto options = wadi_default_device_options();
            options.backend = "cpu";
            options.threads = 2;
            wadi_world_id world{};
            return wadi_create_world_from_level(path.c_str(), nullptr, &options, &world) == WADI_OK ? 0 : 1;
        });
        const double most = static_cast<double>(said.host_bytes + said.device_bytes) / (1 << 20),
                     taken = ran.mebibytes - nothing.mebibytes;
        std::printf("| %s | %.0f | %.0f | %.0f |\n", name, most, taken, asked.mebibytes - nothing.mebibytes);
        expect(ran.code == 0 && asked.code == 0, std::string(name) + ": loads");
        expect(taken <= most, std::string(name) + ": takes more than was said");
        expect(most < 8 * taken + 64, std::string(name) + ": far less than was said");
        // The account itself takes the text and one file at a time.
        expect(asked.mebibytes - nothing.mebibytes < static_cast<double>(64 * text.size() + said.file_bytes) / (1 << 20) + 16,
               std::string(name) + ": its account takes much");
    }
    return wrong;
}

} // namespace attack
