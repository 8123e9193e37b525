// wadi-tune: settings of a level for a budget of milliseconds per frame, by measuring this machine.
#include "../common/files.hpp"
#include "../common/levels.hpp"
#include "../common/platform.hpp"
#include "print.hpp"
#include "write_variant.hpp"
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <wadi/wadi.h>

namespace tune {
namespace {

constexpr int EXIT_BAD_INPUT = 2, EXIT_INTERRUPTED = 130;

struct Output {
    std::string name = "budget", out, json;
    bool write = false;
};

void save(const std::filesystem::path& file, const std::string& text) {
    if (const std::string error = common::write_file(file, text); !error.empty()) throw BadInput(error);
}

/// What cannot be written should be told before a minute is spent.
void check_output(const Level& level, const Output& output) {
    with_variant(level, output.name, Json::object());
    if (!output.out.empty() && std::filesystem::exists(output.out)) throw BadInput("--out " + output.out + ": exists already");
}

void check_number(const char* option, double value, double most, const char* unit) {
    if (std::isfinite(value) && value > 0 && value <= most) return;
    char text[160];
    std::snprintf(text, sizeof text, "%s %g: want %s above 0, at most %g", option, value, unit, most);
    throw BadInput(text);
}

void write_outputs(const std::string& name, const std::filesystem::path& file, const Level& level, const Request& request,
                   const Outcome& outcome, const Output& output) {
    const Json patch = variant_of(level, outcome.chosen.settings);
    std::printf("\nvariant   %s\n", patch.dump().c_str());
    if (output.write || !output.out.empty()) {
        const std::filesystem::path target = output.write ? file : std::filesystem::path(output.out);
        save(target, with_variant(level, output.name, patch));
        std::printf("          is \"%s\" in %s\n", output.name.c_str(), target.string().c_str());
        std::error_code error;
        if (!output.write && names_files(level.file_json()) &&
            !std::filesystem::equivalent(file.parent_path(), std::filesystem::absolute(target).parent_path(), error))
            std::printf("          the level's maps must be put beside it\n");
    } else {
        std::printf("          not written: --out FILE makes a level file that has it, --write puts it into the level's own\n");
    }
    if (!output.json.empty()) save(output.json, report_json(name, level, request, outcome).dump(2) + "\n");
}

int run(int argc, char** argv) {
    Request request;
    Output output;
    std::string name, variant;
    bool quiet = false;
    CLI::App app(
        "Finds the settings of a level that err least for a budget of milliseconds per frame, by measuring this machine.",
        "wadi-tune");
    app.add_option("level", name, "level name, level file (.json) or level folder")->required();
    app.add_option("--budget-ms", request.budget_ms, "milliseconds of each frame")->capture_default_str();
    app.add_option("--frames", request.frames, "frames per second")->capture_default_str();
    app.add_option("--minutes", request.minutes,
                   "of steps to measure with, about (making worlds comes on top); fewer give coarser errors")
        ->capture_default_str();
    app.add_option("--backend", request.device.backend, "auto, or a backend of wadi-recorder --list-backends")
        ->capture_default_str();
    app.add_option("--device", request.device.device, "device number within the backend; -1 = best")->capture_default_str();
    app.add_option("--threads", request.device.threads, "threads of the cpu backend; 0 = all but one")
        ->check(CLI::Range(0, 256))
        ->capture_default_str();
    app.add_flag("--processor-time", request.device.processor_time,
                 "count what all threads work (cpu backend), for a machine that is not idle; with --threads 1");
    app.add_option("--variant", variant, "a variant of the level to start from");
    app.add_option("--name", output.name, "name of the variant that is made")->capture_default_str();
    auto* const out = app.add_option("--out", output.out, "a new level file that has it");
    app.add_flag("--write", output.write, "puts it into the level's own file; the rest of its text stays")->excludes(out);
    app.add_option("--json", output.json, "writes all figures to this file");
    app.add_flag("--quiet", quiet, "does not tell on standard error what is being measured");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error); // --help
        throw BadInput(std::string(error.what()) + " (--help shows the options)");
    }
    if (wadi_get_abi_version() != WADI_ABI_VERSION) throw BadInput("the loaded wadi library has another ABI version");
    check_number("--budget-ms", request.budget_ms, 1000, "milliseconds");
    check_number("--frames", request.frames, 1000, "frames per second");
    check_number("--minutes", request.minutes, 60, "minutes");
    const common::FoundLevel found = common::find_level(name);
    if (!found.error.empty()) throw BadInput(found.error);
    const Level level(found.file, variant);
    check_output(level, output);

    if (!quiet) request.tell = [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); };
    request.stop = common::interrupted;
    common::catch_interrupt();
    const Outcome outcome = tune(level, request);
    const std::string title = variant.empty() ? found.name : found.name + " (" + variant + ")";
    std::printf("%s\n\n%s", conclusion(title, level, request, outcome).c_str(), report(level, request, outcome).c_str());
    write_outputs(title, found.file, level, request, outcome, output);
    return 0;
}

} // namespace
} // namespace tune

int main(int argc, char** argv) {
    try {
        return tune::run(argc, argv);
    } catch (const tune::Stopped&) {
        std::fprintf(stderr, "wadi-tune: interrupted\n");
        return tune::EXIT_INTERRUPTED;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "wadi-tune: %s\n", error.what());
        return tune::EXIT_BAD_INPUT;
    }
}
