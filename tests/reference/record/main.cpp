// Runs a level by the reference solver in double precision, without quantum, and writes its fields as NPY: what samples/report
// measures errors against where no exact solution is known.
#include "engine/level/level.hpp"
#include "engine/settings/rules/effects.hpp"
#include "samples/recorder/files.hpp"
#include "tests/reference/solver.hpp"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace {

using wadi::reference::Solver;

std::string write(const std::filesystem::path& path, const std::vector<double>& field, int nx, int ny) {
    std::vector<float> values(field.size());
    std::transform(field.begin(), field.end(), values.begin(), [](double v) { return static_cast<float>(v); });
    return recorder::write_file(path, recorder::encode_npy(values, nx, ny));
}

int fail(const std::string& what) {
    std::fprintf(stderr, "wadi-reference: %s\n", what.c_str());
    return 2;
}

} // namespace

int main(int argc, char** argv) {
    std::string level_file, out;
    double dt = 0, seconds = 0;
    CLI::App app("Runs a level file by the double-precision reference solver with T = 1 and writes hs_end.npy and W_end.npy.");
    app.add_option("level", level_file, "level file (.json)")->required();
    app.add_option("--dt", dt, "time step [s]")->required()->check(CLI::Range(1e-7, 100.0));
    app.add_option("--seconds", seconds, "simulated time [s]")->required()->check(CLI::Range(0.0, 1e6));
    app.add_option("--out", out, "existing folder")->required()->check(CLI::ExistingDirectory);
    CLI11_PARSE(app, argc, argv);

    wadi::LevelOverrides overrides;
    overrides.dt = dt;
    auto level = wadi::load_level(level_file, overrides);
    if (!level) return fail(level.status().message);
    wadi::Settings& settings = level->settings;
    settings.method.quantum = 0;
    settings.method.substeps = 1;
    const auto effects = wadi::effects_required(settings, wadi::content_of(level->fields));
    if (!effects) return fail(effects.status().message);

    Solver<double> solver(settings, effects->mask);
    solver.load(level->fields);
    const auto steps = static_cast<long>(std::llround(seconds / dt));
    for (long n = 0; n < steps; ++n) {
        solver.step();
        if ((n + 1) % std::max(1L, steps / 10) == 0) {
            std::printf("%3ld %%\n", 100 * (n + 1) / steps);
            std::fflush(stdout);
        }
    }
    for (const auto& [name, field] : {std::pair{"hs_end.npy", &solver.sand}, std::pair{"W_end.npy", &solver.water}}) {
        const std::string error = write(std::filesystem::path(out) / name, *field, settings.grid.nx, settings.grid.ny);
        if (!error.empty()) return fail(error);
    }
    return 0;
}
