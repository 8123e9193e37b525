// engine/level: every class of wrong level file, and random damage.
#include "engine/settings/rules/messages.hpp"
#include "tests/unit/level_text.hpp"
#include "tests/unit/map_files.hpp"
#include <chrono>
#include <cmath>
#include <doctest/doctest.h>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

using namespace wadi;
using namespace level_text;
using map_files::Folder;

namespace {

/// `rest` gives bad_file with `part` in its message.
void refuses(const std::string& rest, const std::string& part, const std::string& folder = "") {
    const auto level = parse(rest, folder);
    CHECK_MESSAGE(says(message(level), part), rest << "\n  says: " << message(level));
    if (!level) CHECK((level.status().code == Code::bad_file || level.status().code == Code::not_found));
}

void refuses_text(const std::string& text, const std::string& part) {
    const auto level = parse_level(text, "", {});
    CHECK_MESSAGE(says(message(level), part), text << "\n  says: " << message(level));
}

} // namespace

TEST_CASE("level errors: malformed JSON with line and column") {
    refuses_text("{\n  \"name\": \"x\"\n  \"dt\": 1\n}", "line 3, column ");
    refuses_text("", "line 1, column 1");
    refuses_text("{", "line 1, column 2");
    refuses_text("{} x", "line 1, column 4");
    refuses_text("{\"name\": \"\xff\"}", "line 1");
    refuses_text("{\"dt\": 1e999}", "number overflow parsing '1e999'");
    refuses_text("[]", "the level: expected an object {...}, found []");
    refuses_text(R"({"name": "a", "name": "b"})", "the key \"name\" is given twice");
}

// A message that quoted such a value, or a copy of it, went as deep on the stack as the file said.
TEST_CASE("level errors: nesting") {
    const auto nested = [](std::size_t depth, const std::string& begin, const std::string& end) {
        std::string text;
        for (std::size_t n = 0; n < depth; ++n) text += begin;
        for (std::size_t n = 0; n < depth; ++n) text += end;
        return text;
    };
    const std::string too_deep = "is nested more than 32 deep";
    refuses_text(std::string(100000, '['), too_deep);
    for (const char* key : {"description", "variants", "sources", "sand", "unknown"}) {
        refuses("\"" + std::string(key) + "\": " + nested(100000, "[", "]"), std::string(key) + " " + too_deep);
        refuses("\"" + std::string(key) + "\": " + nested(100000, "{\"a\":[", "]}"), std::string(key) + " " + too_deep);
    }
    refuses(R"("rain": )" + nested(31, "[", "]"), "rain[0]: expected two numbers"); // negative control: as deep as may be
    refuses(R"("rain": )" + nested(32, "[", "]"), "rain " + too_deep);
}

// The parser that was here looked through a list at the end of each of its objects: minutes for this one.
TEST_CASE("level errors: a million layers are counted in seconds") {
    std::string list = "{}";
    for (int n = 1; n < 1'000'000; ++n) list += ",{}";
    const auto start = std::chrono::steady_clock::now();
    refuses("\"terrain\": [" + list + "]", "terrain: 1000000 elements are more than 256");
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
}

TEST_CASE("level errors: root") {
    refuses_text(R"({"name": "x", "grid": {"nx": 1, "ny": 1, "dx": 1}, "dt": 1})", "format_version: missing");
    refuses_text(R"({"format_version": 2, "name": "x", "grid": {"nx": 1, "ny": 1, "dx": 1}, "dt": 1})",
                 "2 is newer than this build reads, 1");
    refuses_text(R"({"format_version": 1, "name": "x", "grid": {"nx": 1, "ny": 1, "dx": 1}})", "dt: missing");
    refuses_text(level("", R"({"nx": 0, "ny": 1, "dx": 1})"), "grid.nx: 0 is outside 1 ... 16384");
    refuses_text(level("", R"({"nx": 1, "ny": 16385, "dx": 1})"), "grid.ny: 16385 is outside 1 ... 16384");
    refuses_text(level("", R"({"nx": 1e300, "ny": 1, "dx": 1})"), "grid.nx: 1e+300 is outside");
    refuses_text(level("", R"({"nx": 1.5, "ny": 1, "dx": 1})"), "grid.nx: 1.5 is not a whole number");
    refuses_text(level("", R"({"nx": "4", "ny": 1, "dx": 1})"), "grid.nx: expected a number, found \"4\"");
    refuses_text(level("", R"({"nx": 1, "ny": 1})"), "grid.dx: missing");
    refuses_text(level("", "[]"), "grid: expected an object");
    refuses("\"terrian\": []", "terrian: unknown key, did you mean \"terrain\"?");
    refuses("\"duration\": -1", "duration: -1 is outside 0 ... 1e+09");
}

TEST_CASE("level errors: material, method, effects") {
    refuses(R"("material": {"friction": 12})", "material.friction: 12 is outside 0 ... 10");
    refuses(R"("surface": {"foam_half_life": -1})", "surface.foam_half_life: -1 is outside 0 ... 100000");
    refuses(R"("surface": {"foam_energy": 0})", "surface.foam_energy: 0 is outside 0.001 ... 1e+09");
    refuses(R"("surface": {"silt_speed": 0})", "surface.silt_speed: 0 is outside 0.001 ... 100");
    refuses(R"("surface": {"foam_hal_life": 1})", "surface.foam_hal_life: unknown key, did you mean \"foam_half_life\"?");
    refuses(R"("material": {"frction": 1})", "material.frction: unknown key, did you mean \"friction\"?");
    refuses(R"("material": {"young_modulsu": 1})", "did you mean \"young_modulus\"?");
    refuses(R"("material": {"zzz": 1})", "material.zzz: unknown key; known: water_density, sand_density");
    refuses(R"("material": {"friction": "high"})", "material.friction: expected a number, found \"high\"");
    refuses(R"("material": {"friction": null})", "material.friction: expected a number, found null");
    refuses(R"("material": {"saturation": [0.1, 0.2]})", "material.saturation: expected three numbers");
    refuses(R"("material": {"saturation": [0.3, 0.2, 0.4]})", "material.saturation[1]: 0.2 must be at least");
    refuses(R"("method": {"name": "robustt"})", "did you mean \"robust\"?");
    refuses(R"("method": {"substeps": 0})", "method.substeps: 0 is outside 1 ... 64");
    refuses(R"("method": {"water_substeps": 9})", "method.water_substeps: 9 is outside 1 ... 8");
    refuses(R"("method": {"name": "published", "water_substeps": 2})",
            "method.water_substeps: 2 goes only with method \"robust\"");
    refuses(R"("method": {"substeps": 2.5})", "2.5 is not a whole number");
    refuses(R"("method": {"outflow_limiter": 1})", "expected true or false, found 1");
    refuses(R"("effects": {"cohesoin": "off"})", "effects.cohesoin: unknown key, did you mean \"cohesion\"?");
    refuses(R"("effects": {"cohesion": "offf"})", "\"offf\" is not known, did you mean \"off\"?");
    refuses(R"("effects": {"cohesion": false})", "expected a text, found false");
}

TEST_CASE("level errors: layers") {
    refuses(R"("sand": {})", "sand: expected a list [...], found {}");
    refuses(R"("sand": [1])", "sand[0]: expected an object {...}, found 1");
    refuses(R"("sand": [{}])", "sand[0]: needs either a \"shape\" or the \"file\" of a map");
    refuses(R"("sand": [{"shape": "plane", "file": "a.png"}])", "needs either");
    refuses(R"("sand": [{"shape": "cylindr"}])", "sand[0].shape: \"cylindr\" is not known, did you mean \"cylinder\"?");
    refuses(R"("sand": [{"shape": "cylinder", "raduis": 1, "center": [1, 1], "height": 1}])",
            "sand[0].raduis: unknown key, did you mean \"radius\"?");
    refuses(R"("sand": [{"shape": "cylinder", "center": [1, 1], "height": 1}])", "sand[0].radius: missing");
    refuses(R"("sand": [{"shape": "cylinder", "center": [1], "radius": 1, "height": 1}])",
            "sand[0].center: expected two numbers [x, y], found [1]");
    refuses(R"("sand": [{"shape": "cylinder", "center": [1, "a"], "radius": 1, "height": 1}])",
            "sand[0].center[1]: expected a number");
    refuses(R"("sand": [{"shape": "cylinder", "center": [1, 1], "radius": 0, "height": 1}])", "sand[0].radius: 0 is outside");
    refuses(R"("sand": [{"shape": "box", "from": [1, 3], "to": [2, 3], "height": 1}])",
            "sand[0].to[1]: must be greater than from[1]");
    refuses(R"("sand": [{"shape": "plane"}])", "sand[0].height: missing");
    refuses(R"("sand": [{"shape": "plane", "height": 1, "surface": 2}])", "sand[0]: give only one of \"height\" or \"surface\"");
    refuses(R"("terrain": [{"shape": "plane", "surface": 2}])", "terrain[0].surface: unknown key");
    refuses(R"("sand": [{"shape": "plane", "wet": 0.2}])", "sand[0].wet: unknown key");
    refuses(R"("water": [{"shape": "plane", "wet": 1.2}])", "water[0].wet: 1.2 is outside 0 ... 1");
    refuses(R"("water": [{"shape": "plane", "wet": 0.2, "slope_x": 1}])", "water[0].slope_x: unknown key");
    refuses(R"("water": [{"shape": "plane", "surface": 1, "combine": "add"}])",
            "water[0].combine: \"add\" is not known; known: set, max, min");
    refuses(R"("sand": [{"shape": "plane", "height": 1, "combine": "ad"}])", "did you mean \"add\"?");
    refuses(R"("sand": [{"shape": "plane", "height": 1, "where": "here"}])", "sand[0].where: \"here\" is not known");
    refuses(R"("sand": [{"shape": "cone", "center": [1, 1], "height": 1}])", "sand[0].radius: missing");
    refuses(R"("sand": [{"shape": "cone", "center": [1, 1], "surface": 1, "radius": 2, "side_slope": 1}])",
            "sand[0].radius: unknown key");
    refuses(R"("sand": [{"shape": "cone", "center": [1, 1], "height": 1, "radius": 1, "side_slope": 1}])",
            "give only one of \"radius\" or \"side_slope\"");
    refuses(R"("terrain": [{"shape": "cone", "center": [1, 1], "height": -1, "radius": 1}])",
            "to dig, combine with \"subtract\"");
    refuses(R"("sand": [{"shape": "ridge", "points": [[1, 1]], "width": 1, "height": 1}])", "at least two points");
    refuses(R"("sand": [{"shape": "ridge", "points": [[1, 1], 2], "width": 1, "height": 1}])",
            "sand[0].points[1]: expected two numbers");
    refuses(R"("sand": [{"shape": "noise", "amplitude": 1, "wavelength": 0}])", "sand[0].wavelength: 0 is outside");
    refuses(R"("sand": [{"shape": "noise", "amplitude": 1, "wavelength": 1, "octaves": 13}])",
            "sand[0].octaves: 13 is outside 1 ... 12");
    refuses(R"("velocities": [{"of": "watr", "shape": "plane", "velocity": [1, 1]}])", "did you mean \"water\"?");
    refuses(R"("velocities": [{"of": "water", "shape": "plane"}])", "velocities[0].velocity: missing");
    refuses(R"("velocities": [{"of": "water", "shape": "plane", "velocity": [1, 1e5]}])",
            "velocities[0].velocity[1]: 100000 is outside");
    refuses(R"("rain_map": [{"shape": "plane"}])", "rain_map[0].times: missing");
    refuses(R"("rain_map": [{"shape": "plane", "times": 101}])", "rain_map[0].times: 101 is outside 0 ... 100");
    refuses(R"("rain_map": [{"shape": "plane", "manning": 0.1}])", "rain_map[0].manning: unknown key");
    refuses(R"("roughness": [{"shape": "plane"}])", "roughness[0].manning: missing");
    refuses(R"("roughness": [{"shape": "plane", "manning": 2}])", "roughness[0].manning: 2 is outside 0 ... 1");
    refuses(R"("roughness": [{"shape": "plane", "height": 0.1, "manning": 0.1}])", "roughness[0].height: unknown key");
    refuses(R"("roughness": [{"shape": "cone", "manning": 0.1}])", "roughness[0].shape: \"cone\" is not known");
    refuses(R"("roughness": [{"shape": "plane", "manning": 0.1, "where": "present"}])", "roughness[0].where: unknown key");
    refuses(R"("roughness": [{"shape": "plane", "manning": 0.1, "combine": "subtract"}])",
            "roughness: -0.1 is outside 0 ... 1 in cell (0, 0)");
    refuses(R"("terrain": [{"shape": "plane", "height": 17}])",
            "terrain: 17 is outside -16 ... 16 (method.largest_height) in cell (0, 0)");
    refuses(R"("terrain": [{"shape": "plane", "height": 15}], "sand": [{"shape": "plane", "height": 2}])",
            "cell (0, 0) is 17 m high, above method.largest_height, 16 m");
}

TEST_CASE("level errors: files outside the level's folder, unless the host allows them") {
    const Folder folder;
    const std::string level = folder.file("level");
    std::filesystem::create_directories(level + "/maps");
    const auto height = map_files::npy(map_files::dictionary("<f4", "(1, 1)"), std::vector<float>{2});
    for (const char* name : {"secret.npy", "level/a.npy", "level/maps/b.npy"}) folder.write(name, height);
    std::filesystem::create_symlink(folder.file("secret.npy"), level + "/out.npy");
    std::filesystem::create_symlink(folder.path(), level + "/up");
    std::filesystem::create_symlink("maps/b.npy", level + "/in.npy");
    LevelOverrides anywhere;
    anywhere.files = FilesFrom::anywhere;
    const auto terrain = [](const std::string& file) { return "\"terrain\": [{\"file\": \"" + file + "\"}]"; };
    for (const std::string file : {"../secret.npy", "maps/../../secret.npy", "maps/../a.npy", "out.npy", "up/secret.npy"}) {
        refuses(terrain(file), "terrain[0].file: " + file + ": lies outside the level's folder", level);
        CHECK(at(must(parse(terrain(file), level, anywhere)), must(parse(terrain(file), level, anywhere)).fields.terrain, 3, 3) ==
              2);
    }
    for (const std::string& file : {folder.file("secret.npy"), level + "/a.npy"}) {
        refuses(terrain(file), "lies outside the level's folder", level);
        CHECK(parse(terrain(file), level, anywhere));
    }
    for (const char* file : {"a.npy", "./a.npy", "maps/b.npy", "in.npy"}) CHECK(parse(terrain(file), level)); // negative control
    refuses(terrain("../none.npy"), "lies outside", level); // whether there is such a file is not told
    refuses(R"("rain": {"file": "/etc/passwd"})", "rain.file: /etc/passwd: lies outside", level);
    refuses(R"("rain": {"file": "..\\..\\rain.csv"})", "lies outside", level);
    refuses(R"("rain": {"file": "c:rain.csv"})", "lies outside", level);
    // A host's own reader is not asked for them either.
    int asked = 0;
    const FileReader reader = [&](const std::string&, std::uint64_t) -> Result<map_files::Bytes> { return ++asked, height; };
    CHECK_FALSE(parse_level(level_text::level(terrain("../secret.npy")), reader, {}));
    CHECK(asked == 0);
    CHECK(parse_level(level_text::level(terrain("../secret.npy")), reader, anywhere));
    CHECK(asked == 1);
}

TEST_CASE("level errors: the files of a level hold so much together, told before they are decoded") {
    const Folder folder;
    folder.write("map.png", map_files::png_of_zeros(4096, 4096, 8, 2)); // 3/4 of what a level of few cells may name
    folder.write("wide.png", map_files::png_of_zeros(8192, 8192, 16, 6));
    folder.write("small.npy", map_files::npy(map_files::dictionary("<f4", "(1, 1)"), std::vector<float>{1}));
    const std::string layer = R"({"file": "map.png", "max": 1})", water = R"("water": [{"file": "map.png", "max": 1}])";
    const auto start = std::chrono::steady_clock::now();
    refuses("\"terrain\": [" + layer + "," + layer + "]",
            "terrain[1].file: map.png: its 50331648 values are more than the 16778496", folder.path());
    refuses(R"("terrain": [{"file": "wide.png", "max": 1}])", "its 268435456 values are more than the 67110144", folder.path());
    // A map of depths has what lies below it drawn on its own cells.
    refuses(R"("terrain": [{"shape": "plane", "height": 0}, {"shape": "plane", "height": 0}], )" + water,
            "water[0].file: map.png: its 33554432 values", folder.path());
    std::string series = "time,value\n";
    for (int n = 0; n <= 1'000'000; ++n) series += std::to_string(n) + ",0\n";
    folder.write("long.csv", series);
    refuses(R"("rain": {"file": "long.csv"})", "rain.file: long.csv: more than 1000000 samples", folder.path());
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(60));
    CHECK(parse("\"terrain\": [" + layer + "]", folder.path())); // negative controls
    const auto larger =
        parse_level(level_text::level("\"terrain\": [" + layer + "," + layer + "]", R"({"nx": 2048, "ny": 1024, "dx": 1})"),
                    folder.path(), {});
    CHECK_MESSAGE(larger, message(larger));
}

TEST_CASE("level errors: maps") {
    const Folder folder;
    folder.write("good.png", map_files::png16(2, 2, {0, 1, 2, 3}));
    map_files::Bytes cut = map_files::png16(2, 2, {0, 1, 2, 3});
    cut.resize(cut.size() - 20);
    folder.write("cut.png", cut);
    folder.write("three.r16", map_files::words({1, 2, 3}, false));
    std::vector<float> heights = {1, 2, 3, std::numeric_limits<float>::quiet_NaN()};
    folder.write("nan.npy", map_files::npy(map_files::dictionary("<f4", "(2, 2)"), heights));
    folder.write("big.npy", map_files::npy(map_files::dictionary("<f4", "(1, 2)"), std::vector<float>{1, 1e30f}));
    folder.write("one.npy", map_files::npy(map_files::dictionary("<f4", "(1, 1)"), std::vector<float>{1}));
    const auto map = [&](const std::string& rest, const std::string& part) {
        refuses("\"terrain\": [{" + rest + "}]", part, folder.path());
    };
    map(R"("file": "none.png", "max": 1)", "none.png: no such file");
    map(R"("file": "none.png", "max": 1)", "terrain[0].file: ");
    map(R"("file": "")", "terrain[0].file: must name a map");
    map(R"("file": "good.jpg")", "maps end in .png");
    map(R"("file": "good.png")", "good.png holds grey values; give min and max");
    map(R"("file": "good.png", "min": 1)", "terrain[0].max: missing");
    map(R"("file": "good.png", "max": 1, "scale": 2)", "give either min and max, or scale and offset");
    map(R"("file": "good.png", "max": 1, "size": [2, 2])", "only .r16, .r32 and .raw maps are given a size");
    map(R"("file": "good.png", "max": 1, "absolute": true)", "terrain[0].absolute: unknown key");
    map(R"("file": "good.png", "maxx": 1)", "terrain[0].maxx: unknown key, did you mean \"max\"?");
    map(R"("file": "cut.png", "max": 1)", "cut.png: truncated");
    map(R"("file": "three.r16", "max": 1)", "6 bytes is not a square map");
    map(R"("file": "three.r16", "max": 1, "size": [2, 2])", "truncated, 6 bytes where 2 x 2");
    map(R"("file": "three.r16", "max": 1, "size": [1.5, 2])", "terrain[0].size: must be whole numbers");
    map(R"("file": "nan.npy")", "nan.npy: the value in column 1, row 1 is NaN");
    map(R"("file": "one.npy", "max": 1)", "min and max are for integer maps");
    map(R"("file": "big.npy")", "terrain[0]: height: 2e+29 is outside -1e+06 ... 1e+06 in cell (3, 0)");
}

TEST_CASE("level errors: sides, sources, series") {
    refuses(R"("sides": {"west": {"kind": "levl", "value": 1}})",
            "sides.west.kind: \"levl\" is not known, did you mean \"level\"?");
    refuses(R"("sides": {"west": {}})", "sides.west.kind: missing");
    refuses(R"("sides": {"wets": {"kind": "wall"}})", "sides.wets: unknown key, did you mean \"west\"?");
    refuses(R"("sides": {"west": {"kind": "level"}})", "sides.west.value: missing");
    refuses(R"("sides": {"west": {"kind": "outflow", "value": 1}})", "only discharge, level and waves have one");
    refuses(R"("sides": {"west": {"kind": "waves"}})", "sides.west.value: missing");
    refuses(R"("sides": {"west": {"kind": "level", "value": 1, "wave": 1}})", "sides.west.wave: only waves have one");
    refuses(R"("sides": {"west": {"kind": "waves", "value": 1, "wave": 1e9}})", "sides.west.wave: 1e+09 is outside");
    refuses(R"("sides": {"west": {"kind": "brink", "absorb": 1}})", "only level and waves have one");
    refuses(R"("sides": {"west": {"kind": "level", "value": 1, "absorb": 1e7}})", "sides.west.absorb: 1e+07 is outside");
    refuses(R"("sides": {"west": {"kind": "outflow", "from": 8}})", "sides.west.from: 8 is outside 0 ... 8");
    refuses(R"("sides": {"west": {"kind": "outflow", "depth": 1}})", "only a discharge has one");
    refuses(R"("sides": {"west": {"kind": "discharge", "value": 1, "depth": 17}})", "sides.west.depth: 17 is outside 0 ... 16");
    refuses(R"("sides": {"west": {"kind": "level", "value": []}})", "sides.west.value: an empty list");
    refuses(R"("sides": {"west": {"kind": "level", "value": [[0, 1], [0, 2]]}})",
            "sides.west.value[1]: the time 0 s does not come after 0 s");
    refuses(R"("sides": {"west": {"kind": "level", "value": [[0, 1], [1]]}})", "sides.west.value[1]: expected two numbers");
    refuses(R"("sides": {"west": {"kind": "level", "value": "high"}})", "sides.west.value: expected a number, a list");
    refuses(R"("sides": {"west": {"kind": "level", "value": [[0, 1], [5, 969]]}})",
            "sides.west.value[1]: 969 is outside -16 ... 16 (method.largest_height)");
    refuses(R"("sides": {"west": {"kind": "discharge", "value": 2000}})", "sides.west.value: 2000 is outside 0 ... 1603.63");
    CHECK(parse(R"("sides": {"west": {"kind": "discharge", "value": 1600}})"));
    refuses(R"("sides": {"west": {"kind": "discharge", "value": 600, "from": 1, "to": 3}})", "outside 0 ... 400.9");
    refuses(R"("sources": [{"shape": "disc", "center": [1, 1], "rate": 1}])", "sources[0].radius: missing");
    refuses(R"("sources": [{"shape": "disc", "center": [99, 1], "radius": 1, "rate": 1}])",
            "sources[0]: lies outside the grid, which spans 0 ... 10 m in x");
    refuses(R"("sources": [{"shape": "point", "center": [1, 1]}])", "sources[0].rate: missing");
    refuses(R"("sources": [{"shape": "point", "center": [1, 1], "rate": 1, "material": "sand", "velocity": [1, 1]}])",
            "only a source of water sets one");
    refuses(R"("rain": -1)", "rain: -1 is outside 0 ... 1");
    std::string many;
    for (int n = 0; n < 33; ++n) many += std::string(n == 0 ? "" : ",") + R"({"shape": "point", "center": [1, 1], "rate": 1})";
    refuses("\"sources\": [" + many + "]", "sources: 33 are more than 32");

    const Folder folder;
    folder.write("bad.csv", std::string("t,v\n0,1\n1;2\n"));
    folder.write("empty.csv", std::string("t,v\n"));
    refuses(R"("rain": {"file": "none.csv"})", "none.csv: no such file", folder.path());
    refuses(R"("rain": {"file": "bad.csv"})", "bad.csv: line 3 is not \"time,value\"", folder.path());
    refuses(R"("rain": {"file": "empty.csv"})", "empty.csv: holds no", folder.path());
    refuses(R"("rain": {"fil": "bad.csv"})", "rain.fil: unknown key, did you mean \"file\"?", folder.path());
}

TEST_CASE("level errors: files") {
    const Folder folder;
    CHECK(load_level(folder.file("none.json"), {}).status().code == Code::not_found);
    const auto path = folder.write("bad.json", std::string("{\n\n!"));
    CHECK(says(message(load_level(path, {})), path + ": line 3, column 1"));
    CHECK(load_level(folder.path(), {}).status().code == Code::bad_file);
}

TEST_CASE("level errors: edit distance") {
    CHECK(edit_distance("", "abc") == 3);
    CHECK(edit_distance("abc", "abc") == 0);
    CHECK(edit_distance("kitten", "sitting") == 3);
    CHECK(edit_distance("raduis", "radius") == 1); // a swap
    CHECK(suggestion("xx", {"a", "b"}) == "; known: a, b");
    CHECK(suggestion(std::string(1 << 20, 'a'), {"a"}) == "; known: a");
}

TEST_CASE("level errors: damaged shipped levels never crash the loader") {
    std::mt19937 random(2);
    int loaded = 0;
    int refused = 0;
    LevelOverrides small; // the damage is in the text; drawing stays cheap
    small.size = {16, 16};
    for (const char* name : {"dam_break", "piles", "canyon", "beach"}) {
        const auto folder = samples() / name;
        std::ifstream file(folder / "level.json", std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
        REQUIRE(text.size() > 100);
        for (int round = 0; round < 1500; ++round) {
            std::string damaged = text;
            for (int flips = 1 + static_cast<int>(random() % 6); flips > 0; --flips) {
                const std::size_t at = random() % damaged.size();
                if (random() % 2 == 0)
                    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
                else
                    damaged[at] = "0123456789-+.eE{}[],:\" "[random() % 23];
            }
            if (random() % 5 == 0) damaged.resize(random() % damaged.size());
            const auto level = parse_level(damaged, folder.string(), small);
            ++(level ? loaded : refused);
            if (!level) CHECK(!level.status().message.empty());
        }
    }
    CHECK(loaded > 20);
    CHECK(refused > 2000);
}

namespace {
/// "key": layers, `count` times the same.
std::string layers_of(const char* key, const std::string& layer, int count) {
    std::string list;
    for (int n = 0; n < count; ++n) list += (n > 0 ? "," : "") + layer;
    return std::string("\"") + key + "\": [" + list + "]";
}
std::string ridge(int points) {
    std::string list;
    for (int n = 0; n < points; ++n)
        list += (n > 0 ? ",[" : "[") + std::to_string(1e9 * std::cos(n * 0.01)) + "," + std::to_string(1e9 * std::sin(n * 0.01)) +
                "]";
    return R"({"shape": "ridge", "height": 1, "width": 1e9, "side_slope": 0.001, "points": [)" + list + "]}";
}
} // namespace

TEST_CASE("level errors: what layers ask for has a budget, which grows with the grid") {
    const auto of = [](const std::string& rest, int nx) {
        const auto start = std::chrono::steady_clock::now();
        const std::string size = std::to_string(nx);
        const auto made = parse_level(level(rest, R"({"nx": )" + size + R"(, "ny": )" + size + R"(, "dx": 1})"), "", {});
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        CHECK_MESSAGE(seconds < 20, seconds << " s"); // seconds on a machine of its own
        return message(made);
    };
    const std::string noise = R"({"shape": "noise", "amplitude": 0.01, "wavelength": 9, "octaves": 12})";
    CHECK(says(of(layers_of("terrain", noise, 256), 1024), "looks at shapes, or more"));
    CHECK(says(of(layers_of("terrain", noise, 256), 1024), "allowed are 4.68435e+08"));
    CHECK(of(layers_of("terrain", noise, 40), 256) == "no error");
    CHECK(says(of(layers_of("sand", ridge(256), 64), 256), "looks at shapes"));
    // Rims of 255 cylinders through the same cells: samples of samples.
    const std::string rims =
        layers_of("sand", R"({"shape": "cylinder", "center": [-1e6, 0], "radius": 1000100, "height": 0.01})", 256);
    CHECK(says(of(rims + "," +
                      layers_of("water", R"({"shape": "cylinder", "center": [0, -1e6], "radius": 1000100, "height": 0.01})", 256),
                  4096),
               "looks at shapes"));
    // A river of 256 points that winds over the grid is none too many.
    std::string river;
    for (int n = 0; n < 256; ++n)
        river += (n > 0 ? ",[" : "[") + std::to_string(4 * n) + "," + std::to_string(500 + 300 * std::sin(n * 0.1)) + "]";
    CHECK(of(layers_of("sand", R"({"shape": "ridge", "height": 0.001, "width": 9, "points": [)" + river + "]}", 4), 1024) ==
          "no error");
}
