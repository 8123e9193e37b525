// Files that do harm, with budgets of time and memory.
#include "tests/faults/attack/attack.hpp"
#include "tests/unit/map_files.hpp"
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>

namespace attack {
namespace {

using map_files::Folder;

/// As large as it may be, without its bytes.
std::string sparse(const Folder& folder, const std::string& name, const std::string& begin, std::uintmax_t bytes) {
    const std::string path = folder.write(name, begin);
    std::filesystem::resize_file(path, bytes);
    return path;
}

/// Seconds and MiB that reading may cost beyond those of a small file.
constexpr double most_seconds = 2, most_mebibytes = 160;
constexpr std::size_t most_text = 1100;

} // namespace

int files() {
    const Folder folder;
    const std::string head =
        R"({ "format_version": 1, "name": "attack", "dt": 0.02, "grid": { "nx": 16, "ny": 16, "dx": 0.5 }, )";
    const auto from_file = [&](const std::string& path) {
        wadi_world_id world{};
        auto options = wadi_default_device_options();
        options.backend = backend.c_str();
        options.threads = 1;
        return wadi_create_world_from_level(path.c_str(), nullptr, &options, &world);
    };
    const auto with_map = [&](const std::string& name) {
        const bool integers = name.ends_with("png") || name.ends_with("r16");
        return from_file(folder.write(name + ".json", head + R"("terrain": [ { "file": ")" + name + "\"" +
                                                          (integers ? ", \"max\": 1" : "") + " } ] }"));
    };
    const auto world = [&] {
        wadi_world_id id{};
        expect(make(32, id) == WADI_OK, "create");
        return id;
    };
    const auto play = [&](std::vector<unsigned char> log, const std::function<void(std::vector<unsigned char>&)>& harm) {
        harm(log);
        const auto id = world();
        return wadi_world_play_commands(id, log.data(), log.size());
    };
    std::vector<unsigned char> log;
    {
        const auto id = world();
        const auto edit = brush(WADI_LAYER_SAND);
        size_t bytes = 0;
        expect(wadi_world_set_command_log(id, 1) == WADI_OK && wadi_world_edit(id, &edit, 1) == WADI_OK &&
                   wadi_world_get_commands(id, nullptr, &bytes) == WADI_OK,
               "a command log");
        log.resize(bytes);
        expect(wadi_world_get_commands(id, log.data(), &bytes) == WADI_OK && wadi_destroy_world(id) == WADI_OK, "its bytes");
    }
    folder.write("small.npy", map_files::npy(map_files::dictionary("<f4", "(4, 4)"), std::vector<float>(16, 0.5F)));
    folder.write("bomb.png", map_files::png_of_zeros(16384, 16384, 16, 6));
    folder.write("honest.png", map_files::png_of_zeros(8, 8, 16, 0, std::uint64_t{300} << 20));
    folder.write("flat.png", map_files::png_of_zeros(16000, 1, 8, 0));
    folder.write("wide.npy", map_files::npy(map_files::dictionary("<f8", "(1000000, 1000000)"), std::vector<double>(4)));
    folder.write("turned.npy", map_files::npy(map_files::dictionary("<f4", "(-4, -4)"), std::vector<float>(16)));
    folder.write("past.npy", map_files::npy(map_files::dictionary("<f4", "(18446744073709551615, 2)"), std::vector<float>(16)));
    folder.write("wide.asc", "ncols 2000000000\nnrows 2000000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n");
    folder.write("long.asc", "ncols 4\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n" + std::string(5'000'000, '1') + "\n");
    folder.write("many.asc", [] {
        std::string text = "ncols 4\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
        while (text.size() < 5'000'000) text += "1 ";
        return text;
    }());
    sparse(folder, "holes.r16", "", std::uintmax_t{1} << 38);
    sparse(folder, "holes.png", "\x89PNG\r\n\x1a\n", std::uintmax_t{1} << 38);
    const std::string huge = sparse(folder, "huge.snapshot", "WADISNAP", std::uintmax_t{1} << 40);
    const auto repeated = [](const std::string& what, std::size_t count) {
        std::string text;
        while (count-- > 0) text += what;
        return text;
    };
    struct Attack {
        std::string reader, name;
        std::string why; // a part of the message; empty where it is taken
        std::function<wadi_result()> read;
    };
    const std::vector<Attack> attacks = {
        {"npy", "small", "", [&] { return with_map("small.npy"); }},
        {"level", "100 000 brackets", "nested",
         [&] { return from_file(folder.write("deep.json", head + R"("terrain": )" + repeated("[", 100000))); }},
        {"level", "a million layers", "more than 256",
         [&] { return from_file(folder.write("layers.json", head + R"("terrain": [)" + repeated("{},", 1000000) + "{}]}")); }},
        {"level", "5 MB of digits", "number overflow",
         [&] { return from_file(folder.write("digits.json", head + R"("duration": )" + repeated("9", 5'000'000) + "}")); }},
        {"level", "a name of 5 MB", "unknown key",
         [&] { return from_file(folder.write("name.json", head + R"("extra)" + repeated("x", 5'000'000) + R"(": 1})")); }},
        {"level", "zeros", "line 1, column 1", [&] { return from_file(sparse(folder, "zeros.json", "", 5'000'000)); }},
        {"level", "holes of 1 TiB", "largest accepted",
         [&] { return from_file(sparse(folder, "holes.json", "{", std::uintmax_t{1} << 40)); }},
        {"level", "a grid of 2e9 by 2e9", "outside 1 ... 16384",
         [&] {
             return from_file(folder.write("grid.json", std::string(R"({ "format_version": 1, "name": "attack", "dt": 0.02,
                 "grid": { "nx": 2000000000, "ny": 2000000000, "dx": 0.5 } })")));
         }},
        {"png", "16384 x 16384 of 8 bytes in 13 MB", "largest PNG", [&] { return with_map("bomb.png"); }},
        {"png", "8 x 8, and 300 MiB of data", "more than the pixels", [&] { return with_map("honest.png"); }},
        {"png", "16000 x 1", "", [&] { return with_map("flat.png"); }},
        {"png", "holes of 256 GiB", "largest accepted", [&] { return with_map("holes.png"); }},
        {"npy", "a million by a million", "outside 1", [&] { return with_map("wide.npy"); }},
        {"npy", "-4 by -4", "outside 1", [&] { return with_map("turned.npy"); }},
        {"npy", "2^64 - 1 by 2", "(rows, columns)", [&] { return with_map("past.npy"); }},
        {"asc", "2e9 by 2e9", "whole number", [&] { return with_map("wide.asc"); }},
        {"asc", "a number of 5 MB", "line 6", [&] { return with_map("long.asc"); }},
        {"asc", "2.5 million numbers for 16 cells", "more values", [&] { return with_map("many.asc"); }},
        {"r16", "holes of 256 GiB", "largest accepted", [&] { return with_map("holes.r16"); }},
        {"snapshot", "holes of 1 TiB", "largest snapshot", [&] { return wadi_world_load_file(world(), huge.c_str()); }},
        {"commands", "as written", "", [&] { return play(log, [](auto&) {}); }},
        {"commands", "cut", "there are 159", [&] { return play(log, [](auto& bytes) { bytes.pop_back(); }); }},
        {"commands", "a count of 2^32 - 1", "checksum",
         [&] { return play(log, [](auto& bytes) { std::fill_n(bytes.begin() + 32, 8, static_cast<unsigned char>(255)); }); }},
    };
    double usual = 0, most = 0;
    std::printf("| reader | file | CPU s | MiB |\n| --- | --- | --- | --- |\n");
    for (const auto& attack : attacks) {
        const std::string name = attack.reader + ", " + attack.name;
        const auto ran = run_child([&] {
            wrong = 0;
            const auto answer = attack.read();
            const std::string message = wadi_get_last_error();
            expect(message.size() <= most_text, "a message that can be shown");
            if (wrong > 0) return 99;
            if (answer == WADI_OK ? attack.why.empty() : message.find(attack.why) != std::string::npos) return 0;
            std::fprintf(stderr, "answered %d: %s\n", answer, message.substr(0, 300).c_str());
            return 1;
        });
        if (usual == 0) usual = ran.mebibytes;
        std::printf("| %s | %s | %.2f | %.0f |\n", attack.reader.c_str(), attack.name.c_str(), ran.seconds,
                    ran.mebibytes - usual);
        most = std::max(most, ran.mebibytes - usual);
        expect(ran.code == 0, name + ": ended with " + std::to_string(ran.code));
        expect(ran.seconds < most_seconds, name + ": took " + std::to_string(ran.seconds) + " s");
        expect(ran.mebibytes - usual < most_mebibytes, name + ": took " + std::to_string(ran.mebibytes - usual) + " MiB");
    }
    expect(most > 20, "what a file takes is seen"); // control: a million layers are read before they are counted
    return wrong;
}

} // namespace attack
