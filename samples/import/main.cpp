// wadi-import: a map of heights as a level: level.json and the map in a folder.
#include "heights.hpp"
#include "level.hpp"
#ifdef WADI_IMPORT_TIFF
#include "tiff.hpp"
#endif
#ifdef WADI_IMPORT_EXR
#include "exr.hpp"
#endif
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace import_map {
namespace {

namespace fs = std::filesystem;

std::string ending_of(const std::string& map) {
    std::string ending = fs::path(map).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

Heights read_tiff_or_say([[maybe_unused]] const std::string& map) {
#ifdef WADI_IMPORT_TIFF
    return read_tiff(map);
#else
    fail(map + ": this build has no libtiff (libtiff-dev)");
#endif
}

Heights read_exr_or_say([[maybe_unused]] const std::string& map) {
#ifdef WADI_IMPORT_EXR
    return read_exr(map);
#else
    fail(map + ": this build has no tinyexr (libtinyexr-dev)");
#endif
}

/// The map in the folder, by its name there; a TIFF or an EXR becomes an Esri ASCII grid.
std::string put_into_folder(Request& request) {
    const std::string ending = ending_of(request.map);
    const bool tiff = ending == ".tif" || ending == ".tiff";
    if (tiff || ending == ".exr") {
        Heights heights = tiff ? read_tiff_or_say(request.map) : read_exr_or_say(request.map);
        if (!heights.has_cells && request.cell) heights.dx = heights.dy = *request.cell;
        write_grid(heights, (request.folder / "terrain.asc").string());
        for (const std::string& note : heights.notes) std::fprintf(stderr, "note: %s: %s\n", request.map.c_str(), note.c_str());
        if (tiff && request.samples.empty()) request.samples = "cells"; // as GeoTIFF says
        return "terrain.asc";
    }
    const fs::path name = fs::path(request.map).filename();
    std::error_code failure;
    if (!fs::equivalent(request.map, request.folder / name, failure)) {
        failure.clear();
        fs::copy_file(request.map, request.folder / name, fs::copy_options::overwrite_existing, failure);
        if (failure) fail(request.map + ": " + failure.message());
    }
    return name.string();
}

int run(Request request) {
    if (request.folder.empty()) request.folder = fs::path(request.map).stem();
    std::error_code failure;
    fs::create_directories(request.folder, failure);
    if (failure) fail(request.folder.string() + ": " + failure.message());
    const std::string file = put_into_folder(request);
    const Ground ground = ground_of(request, file, look_at(request, file), request.holes);
    write_level(request, file, ground);
    for (const std::string& warning : ground.warnings) std::fprintf(stderr, "note: %s\n", warning.c_str());
    const auto [low, high] = std::minmax_element(ground.heights.begin(), ground.heights.end());
    std::printf("%s: %d x %d cells of %g m, heights %g ... %g m, south-west corner at (%.12g, %.12g) -> %s\n",
                request.map.c_str(), ground.nx, ground.ny, ground.dx, static_cast<double>(*low), static_cast<double>(*high),
                ground.origin[0], ground.origin[1], (request.folder / "level.json").string().c_str());
    if (request.preview) {
        write_preview(request, file, ground);
        std::printf("%s: shaded relief, holes in red\n", (request.folder / "preview.png").string().c_str());
    }
    return 0;
}

} // namespace

void fail(const std::string& text) {
    std::fprintf(stderr, "error: %s\n", text.c_str());
    std::exit(2);
}

} // namespace import_map

int main(int argc, char** argv) {
    import_map::Request request;
    std::string size;
    CLI::App app("Makes a level of a map of heights: .png, .r16, .r32, .raw, .hgt, .npy, .asc, .tif, .tiff or .exr",
                 "wadi-import");
    app.add_option("map", request.map)->required()->check(CLI::ExistingFile);
    app.add_option("--out", request.folder, "folder of the level; by default the map's name without its ending");
    app.add_option("--cell", request.cell, "side of a cell [m], where the map does not say")->check(CLI::Range(1e-4, 1e4));
    app.add_option("--size", size, "COLUMNSxROWS of a .raw, .r16 or .r32 map that is not square");
    app.add_option("--min", request.black, "height of black [m] in maps of 8 and 16 bits")->check(CLI::Range(-1e6, 1e6));
    app.add_option("--max", request.white, "height of white [m]; by default an eighth of the longer side")
        ->check(CLI::Range(-1e6, 1e6));
    app.add_option("--packed", request.packed, "terrarium or mapbox: heights in the colours of a PNG")
        ->check(CLI::IsMember({"terrarium", "mapbox"}));
    app.add_option("--flip", request.flip, "x, y or xy: east for west, north for south")->check(CLI::IsMember({"x", "y", "xy"}));
    app.add_option("--samples", request.samples, "cells or corners: where samples lie")
        ->check(CLI::IsMember({"cells", "corners"}));
    app.add_option("--holes", request.holes,
                   "outside: those that reach the rim lead off the map, others are filled; or filled, wall, pit")
        ->check(CLI::IsMember({"outside", "filled", "wall", "pit"}))
        ->capture_default_str();
    app.add_flag("--preview", request.preview, "also write preview.png, shaded relief with holes in red");
    CLI11_PARSE(app, argc, argv);
    if (!size.empty()) {
        int columns = 0, rows = 0, used = 0;
        if (std::sscanf(size.c_str(), "%dx%d%n", &columns, &rows, &used) != 2 || used != static_cast<int>(size.size()) ||
            columns < 1 || rows < 1 || columns > 16384 || rows > 16384)
            import_map::fail("--size " + size + ": want COLUMNSxROWS, 1 ... 16384 each");
        request.size = {columns, rows};
    }
    return import_map::run(std::move(request));
}
