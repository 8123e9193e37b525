// The conformance tests. Quick start for a new backend: register it, run `conformance --backend NAME`, read README.md here.
#include "engine/level/level.hpp"
#include "tests/conformance/coverage.hpp"
#include "tests/conformance/locate.hpp"
#include "tests/conformance/perf.hpp"
#include "tests/conformance/perf_tiles.hpp"
#include "tests/conformance/report.hpp"
#include "tests/conformance/self_check.hpp"
#include "tests/conformance/target.hpp"
#include "tests/conformance/worlds.hpp"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

namespace wadi::conformance {
namespace {

constexpr int exit_failed = 1, exit_usage = 2, exit_skipped = 77;

struct Options {
    std::vector<std::string> backends, required, suites;
    std::string stage, chosen_case, level, output = "console";
    bool from_reference = false; // locate
    bool validate = false;
    int max_cells = 0; // of a case's grid; 0 = no limit
    int max_steps = 0; // of a case; 0 = no limit
    int max_masks = 0; // of a name's cases; 0 = no limit
    PerfOptions perf;
    PerfTilesOptions perf_tiles;
};

const Suite* const suites[] = {&contract_suite(), &stage_suite(), &step_suite(), &invariant_suite(), &fused_suite()};

struct Job {
    const Suite* suite;
    CaseSpec spec;
};

// Cells of the grid that a case names; 0 where it names none.
int cells_of(const CaseSpec& spec) {
    int nx = 0, ny = 0;
    return std::sscanf(spec.get("grid", "").c_str(), "%dx%d", &nx, &ny) == 2 ? nx * ny : 0;
}

void limit_steps(CaseSpec& spec, int most) {
    for (auto& [name, value] : spec.parameters)
        if (name == "steps" && most > 0 && std::atoi(value.c_str()) > most) value = std::to_string(most);
}

// Leaves of each name's cases those of at most `most` masks of effects: evenly spread over the order in which they are listed,
// the last one among them.
void limit_masks(std::vector<Job>& jobs, int most) {
    std::map<std::pair<const Suite*, std::string>, std::vector<std::string>> masks;
    const auto mask_of = [](const Job& job) { return job.spec.get("effects", ""); };
    for (const Job& job : jobs) {
        auto& known = masks[{job.suite, job.spec.name}];
        if (std::find(known.begin(), known.end(), mask_of(job)) == known.end()) known.push_back(mask_of(job));
    }
    std::erase_if(jobs, [&](const Job& job) {
        const auto& known = masks[{job.suite, job.spec.name}];
        const auto count = static_cast<std::ptrdiff_t>(known.size());
        const auto n = std::find(known.begin(), known.end(), mask_of(job)) - known.begin() + 1;
        return n * most / count == (n - 1) * most / count; // n is the last of its share or is left out
    });
}

// The cases that the options choose. A case with parameters need not be a listed one: any that its suite can make is run.
Result<std::vector<Job>> choose(const Options& options) {
    CaseSpec wanted;
    if (!options.chosen_case.empty()) {
        auto parsed = parse_case(options.chosen_case);
        if (!parsed) return parsed.status();
        wanted = *parsed;
    }
    if (!options.stage.empty() && compute::find_stage(options.stage) < 0)
        return error(Code::bad_argument, "--stage " + options.stage + ": no such stage; `conformance coverage` lists them");
    std::vector<Job> jobs;
    bool known = wanted.name.empty();
    for (const Suite* suite : suites) {
        if (!options.suites.empty() &&
            std::find(options.suites.begin(), options.suites.end(), suite->name) == options.suites.end())
            continue;
        for (CaseSpec& spec : suite->list()) {
            if (!options.stage.empty() && spec.name != options.stage) continue;
            if (!wanted.name.empty() && spec.name != wanted.name) continue;
            if (options.max_cells > 0 && cells_of(spec) > options.max_cells) continue;
            if (known && !wanted.parameters.empty()) continue;
            known = true;
            jobs.push_back({suite, wanted.parameters.empty() ? std::move(spec) : wanted});
            limit_steps(jobs.back().spec, options.max_steps);
        }
    }
    if (!known) return error(Code::bad_argument, "--case " + wanted.name + ": no such case; `conformance list` prints all");
    if (options.max_masks > 0) limit_masks(jobs, options.max_masks);
    if (jobs.empty()) return error(Code::bad_argument, "no case is left by --suite, --stage, --case and --max-cells");
    return jobs;
}

// The devices that --backend names. A backend of this build without a device here adds its reason to `absent`.
Result<std::vector<Target>> choose_targets(const Options& options, std::vector<std::pair<std::string, std::string>>& absent) {
    const auto targets = all_targets();
    if (options.backends.empty()) return targets;
    std::vector<Target> chosen;
    for (const std::string& name : options.backends) {
        const std::size_t before = chosen.size();
        for (const Target& target : targets)
            if (name == target.label() || name == target.info.backend) chosen.push_back(target);
        if (chosen.size() > before) continue;
        const auto backends = backends::all();
        const auto built =
            std::find_if(backends.begin(), backends.end(), [&](const backends::Backend& b) { return name == b.name; });
        if (built != backends.end()) {
            std::string why;
            backends::list_devices(*built, why);
            absent.emplace_back(name, why);
            continue;
        }
        std::string known;
        for (const Target& target : targets)
            known += (known.empty() ? "" : ", ") + target.label() + " (" + target.info.name + ")";
        return error(Code::not_found, "--backend " + name + ": no such device; there are: " + known);
    }
    return chosen;
}

int usage(const Status& status) {
    std::fprintf(stderr, "conformance: %s\n", status.message.c_str());
    return exit_usage;
}

void run_job(Session& session, const Job& job, bool validate, Report& report) {
    const auto start = std::chrono::steady_clock::now();
    Verdict verdict = job.suite->run(job.spec, session);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const auto messages = session.take_messages();
    if (validate && !messages.empty() && verdict.outcome != Outcome::fail)
        verdict = failed(std::to_string(messages.size()) + " validation messages, the first: " + messages.front());
    report.add(session.target().label(), job.suite->name, job.spec.text(), verdict, seconds);
}

// A missing required backend is a failure of its own.
void check_required(const Options& options, Report& report) {
    const auto targets = all_targets();
    for (const std::string& name : options.required) {
        const bool found = std::any_of(targets.begin(), targets.end(),
                                       [&](const Target& t) { return name == t.info.backend || name == t.label(); });
        if (!found) report.add(name, "contract", "required", failed("this build or machine has no such device"), 0);
    }
}

int run_tests(const Options& options) {
    auto jobs = choose(options);
    std::vector<std::pair<std::string, std::string>> absent;
    auto targets = choose_targets(options, absent);
    if (!jobs) return usage(jobs.status());
    if (!targets) return usage(targets.status());
    const auto start = std::chrono::steady_clock::now();
    Report report(options.output == "csv");
    report.start();
    check_required(options, report);
    for (const auto& [name, why] : absent) report.add(name, "contract", "open", {Outcome::skipped, "no device: " + why}, 0);
    for (const Target& target : *targets) {
        compute::DeviceOptions device_options;
        device_options.validate = options.validate;
        Session session(target, device_options);
        auto device = session.device();
        if (!device) {
            report.add(target.label(), "contract", "open", failed(device.status().message), 0);
            continue;
        }
        for (const Job& job : *jobs) run_job(session, job, session.options().validate, report);
        session.close(); // what is left over shows in the validation layers' messages
        const auto messages = session.take_messages();
        if (session.options().validate && !messages.empty())
            report.add(target.label(), "contract", "close", failed(messages.front()), 0);
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (options.output != "csv") std::printf("\n%d cases in %.1f s\n", report.total(), seconds);
    report.finish();
    if (report.failures() > 0) return exit_failed;
    return report.passes() > 0 ? 0 : exit_skipped;
}

int run_list(const Options& options) {
    auto jobs = choose(options);
    if (!jobs) return usage(jobs.status());
    for (const Job& job : *jobs) std::printf("%-9s %s\n", job.suite->name, job.spec.text().c_str());
    for (const Target& target : all_targets()) std::printf("# %s: %s\n", target.label().c_str(), target.info.name.c_str());
    return 0;
}

int run_perf_mode(const Options& options, bool of_tiles) {
    std::vector<std::pair<std::string, std::string>> absent;
    auto targets = choose_targets(options, absent);
    if (!targets) return usage(targets.status());
    for (const auto& [name, why] : absent) std::fprintf(stderr, "%s: no device: %s\n", name.c_str(), why.c_str());
    if (!options.stage.empty() && compute::find_stage(options.stage) < 0)
        return usage(error(Code::bad_argument, "--stage " + options.stage + ": no such stage"));
    PerfOptions perf = options.perf;
    perf.stage = options.stage;
    perf.csv = options.output == "csv";
    bool first = true;
    for (const Target& target : *targets) {
        Session session(target, {});
        if (auto status = of_tiles ? run_perf_tiles(session, options.perf_tiles) : run_perf(session, perf, first); !status) {
            std::fprintf(stderr, "%s: %s\n", target.label().c_str(), status.message.c_str());
            return exit_failed;
        }
        first = false;
    }
    return targets->empty() ? exit_skipped : 0;
}

// Where a level first runs otherwise on a device than on the plain CPU, or than the reference solver: what to do with the level
// that a fuzzer's failure left.
Result<std::string> locate_in_level(Session& session, const Level& level, int max_steps, bool from_reference) {
    auto device = session.device();
    if (!device) return device.status();
    auto plain = open_plain_cpu(), other = open_plain_cpu();
    if (!plain) return plain.status();
    if (!other) return other.status();
    auto world = World::create(level.settings, level.fields, std::move(*plain)); // which effects it has
    if (!world) return world.status();
    const Scene scene{level.name, level.settings, level.fields, (*world)->plan().effects};
    int steps = std::max(1, static_cast<int>(std::lround(level.duration / level.settings.dt)));
    if (max_steps > 0) steps = std::min(steps, max_steps);
    if (from_reference) return locate_against_reference(**device, scene, steps);
    return locate_against_device(**device, **other, scene, steps);
}

int run_locate(const Options& options) {
    auto level = load_level(options.level, {});
    if (!level) return usage(level.status());
    if (!level->settings.edits.empty())
        std::fprintf(stderr, "conformance: %zu edits of the level are left out\n", level->settings.edits.size());
    std::vector<std::pair<std::string, std::string>> absent;
    auto targets = choose_targets(options, absent);
    if (!targets) return usage(targets.status());
    for (const auto& [name, why] : absent) std::fprintf(stderr, "%s: no device: %s\n", name.c_str(), why.c_str());
    for (const Target& target : *targets) {
        Session session(target, {});
        auto found = locate_in_level(session, *level, options.max_steps, options.from_reference);
        if (!found) return usage(found.status());
        std::printf("%s  %s\n", target.label().c_str(), found->c_str());
    }
    return targets->empty() ? exit_skipped : 0;
}

int run(int argc, char** argv) {
    Options options;
    CLI::App app{"Tests every backend of this build against the compute interface's contract, the reference solver and the CPU.",
                 "conformance"};
    app.require_subcommand(0, 1);
    app.fallthrough();
    app.add_option("--backend", options.backends, "devices to test: cpu, vulkan, vulkan1, ...; without it all there are")
        ->delimiter(',');
    app.add_option("--require", options.required, "backends whose absence is a failure")->delimiter(',');
    app.add_option("--suite,--layer", options.suites, "contract, stage, step, invariant or fused")
        ->delimiter(',')
        ->check(CLI::IsMember({"contract", "stage", "step", "invariant", "fused"}));
    app.add_option("--stage", options.stage, "only the cases of this stage");
    app.add_option("--case", options.chosen_case, "NAME, or NAME(key=value,...) as a failure prints it");
    app.add_option("--max-cells", options.max_cells, "only cases whose grid has at most so many cells")
        ->check(CLI::Range(1, 1 << 20));
    app.add_option("--max-steps", options.max_steps, "no case runs longer than so many steps")->check(CLI::Range(1, 1 << 20));
    app.add_option("--max-masks", options.max_masks, "of each name only cases of so many masks of effects, evenly spread")
        ->check(CLI::Range(1, 1 << 20));
    app.add_option("--output", options.output, "console or csv")->check(CLI::IsMember({"console", "csv"}));
    app.add_flag("--validate", options.validate, "validation layers on; any message fails its case");
    app.add_subcommand("test", "run the cases (the default)");
    CLI::App* perf = app.add_subcommand("perf", "time every stage and whole steps");
    perf->add_option("--min-size", options.perf.min_size, "smallest grid side")->check(CLI::Range(128, 16384));
    perf->add_option("--max-size", options.perf.max_size, "largest grid side, by doubling from the smallest")
        ->check(CLI::Range(128, 16384));
    perf->add_option("--scene", options.perf.scene, "what the grid holds, laid side by side")
        ->check(CLI::IsMember(std::vector<std::string>(scene_names().begin(), scene_names().end())));
    perf->add_option("--repeats", options.perf.repeats, "runs per row")->check(CLI::Range(1, 10000));
    CLI::App* tiles =
        app.add_subcommand("perf-tiles", "time steps of worlds of which a part moves, with and without active tiles");
    tiles->add_option("--size", options.perf_tiles.size, "grid side")->check(CLI::Range(128, 16384));
    tiles->add_option("--shares", options.perf_tiles.shares, "of the area that moves")
        ->delimiter(',')
        ->check(CLI::Range(0.0, 1.0));
    tiles->add_option("--tiles", options.perf_tiles.tiles, "sides of active tiles, 0 = without, 1 = while they gain")
        ->delimiter(',')
        ->check(CLI::IsMember({0, tiles_where_they_gain, 8, 16, 32, 64}));
    tiles->add_flag("--fused-only", options.perf_tiles.fused_only, "no rows of stages one by one");
    tiles->add_option("--steps", options.perf_tiles.steps, "steps per time")->check(CLI::Range(1, 100000));
    tiles->add_option("--repeats", options.perf_tiles.repeats, "times per row")->check(CLI::Range(1, 1000));
    const CLI::App* list = app.add_subcommand("list", "print the cases and devices");
    const CLI::App* coverage = app.add_subcommand("coverage", "print which masks, grids, scenes and methods each stage meets");
    CLI::App* locate =
        app.add_subcommand("locate", "say in which pass and cell a level first runs otherwise than on the plain CPU");
    locate->add_option("level", options.level, "its level.json, as wadi-fuzz leaves it")->required();
    locate->add_flag("--reference", options.from_reference, "than the reference solver, within what rounding explains");
    const CLI::App* self_check = app.add_subcommand("self-check", "tamper with results; the tests must notice");
    CLI11_PARSE(app, argc, argv);
    if (perf->parsed() || tiles->parsed()) return run_perf_mode(options, tiles->parsed());
    if (list->parsed()) return run_list(options);
    if (locate->parsed()) return run_locate(options);
    if (coverage->parsed()) return print_coverage();
    if (self_check->parsed()) {
        Report report(options.output == "csv");
        report.start();
        run_self_check(report);
        report.finish();
        return report.failures() > 0 ? exit_failed : 0;
    }
    return run_tests(options);
}

} // namespace
} // namespace wadi::conformance

int main(int argc, char** argv) { return wadi::conformance::run(argc, argv); }
