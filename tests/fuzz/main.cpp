// wadi-fuzz: random worlds against invariants, backends, the reference solver and themselves. docs: tests/fuzz/README.md.
#include "tests/fuzz/checks.hpp"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <set>
#include <stop_token>
#include <thread>
#include <vector>

using namespace wadi;
using namespace wadi::fuzz;

namespace {

struct Options {
    double seconds = 20, shrink_seconds = 60, stuck_seconds = 300;
    std::uint64_t scenes = 0, seed = 1;
    int jobs = 0, most_failures = 5;
    std::vector<std::string> backends;
    std::string out = "fuzz-failures", csv, level, check, plain_set = "base", method;
    Weaken weaken = Weaken::nothing;
};

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Every backend that has a device.
std::vector<std::string> all_backends() {
    std::set<std::string> names;
    for (const auto& target : conformance::all_targets()) names.insert(target.info.backend);
    return {names.begin(), names.end()};
}

/// What a thread is at.
struct Place {
    std::atomic<std::uint64_t> seed{0};
    std::atomic<double> since{0}; // 0: at nothing that has to end
};

class Campaign {
  public:
    explicit Campaign(const Options& options)
        : options_(options), start_(now()), next_(options.seed), places_(static_cast<std::size_t>(options.jobs)) {
        if (options_.csv.empty()) return;
        csv_ = std::fopen(options_.csv.c_str(), "w");
        broken_ = csv_ == nullptr;
        if (broken_) {
            std::perror(options_.csv.c_str());
            return;
        }
        std::setvbuf(csv_, nullptr, _IOLBF, BUFSIZ); // a run that is broken off leaves what it has done
        std::fputs("seed,nx,ny,dx,dt,steps,commands,effects,milliseconds,refused,check,failure\n", csv_);
    }
    ~Campaign() {
        if (csv_ != nullptr) std::fclose(csv_);
    }
    Campaign(const Campaign&) = delete;
    Campaign& operator=(const Campaign&) = delete;

    /// Of thread `n`.
    void work(std::size_t n) {
        auto devices = open_devices(options_.backends, options_.plain_set);
        if (!devices) {
            std::fprintf(stderr, "%s\n", devices.status().message.c_str());
            broken_ = true;
            return;
        }
        while (!over()) {
            const std::uint64_t seed = next_++;
            if (options_.scenes > 0 && seed >= options_.seed + options_.scenes) break;
            const double began = now();
            const Case c = make_case(seed);
            if (!options_.method.empty() && options_.method != c.scene.settings.method.name) continue;
            places_[n].seed = seed;
            places_[n].since = began;
            const Outcome outcome = run_case(c, *devices, options_.weaken, options_.check);
            places_[n].since = 0;
            note(c, outcome, now() - began);
            if (outcome.failed() && failures_++ < options_.most_failures) report(c, outcome, *devices);
        }
    }

    /// Ends the program with 3 where a scene does not end; a device that stands still would otherwise hold it for good.
    void watch(const std::stop_token& stop) const {
        while (!stop.stop_requested()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            const auto stuck = [this](const Place& place) {
                return place.since > 0 && now() - place.since > options_.stuck_seconds;
            };
            if (std::none_of(places_.begin(), places_.end(), stuck)) continue;
            for (const Place& place : places_) {
                if (place.since > 0)
                    std::printf("FAILED seed %llu runs for %.1f s and has not ended\n",
                                static_cast<unsigned long long>(place.seed), now() - place.since);
            }
            std::fflush(nullptr);
            std::_Exit(3);
        }
    }

    /// 0, or 1 where something failed.
    int summary() {
        std::printf("%llu scenes in %.1f s on", static_cast<unsigned long long>(done_), now() - start_);
        for (const auto& name : options_.backends) std::printf(" %s", name.c_str());
        std::printf("; %llu refused; checks:", static_cast<unsigned long long>(refused_));
        for (const auto& [check, count] : count_) std::printf(" %s %d", check.c_str(), count);
        std::printf("; %d failures\n", failures_.load());
        return failures_ > 0 || broken_ || done_ == 0 ? 1 : 0;
    }

  private:
    bool over() const {
        return broken_ || failures_ >= options_.most_failures || (options_.scenes == 0 && now() - start_ > options_.seconds);
    }

    void note(const Case& c, const Outcome& outcome, double seconds) {
        const std::lock_guard lock(mutex_);
        ++done_;
        if (!outcome.refused.empty()) {
            ++refused_;
            if (refused_ == 1)
                std::fprintf(stderr, "seed %llu was refused: %s\n", static_cast<unsigned long long>(c.seed),
                             outcome.refused.c_str());
        }
        for (const auto& [check, count] : outcome.count) count_[check] += count;
        const auto& s = c.scene.settings;
        if (csv_ != nullptr)
            std::fprintf(csv_, "%llu,%d,%d,%.4g,%.4g,%d,%zu,%u,%.1f,%d,%s,\"%s\"\n", static_cast<unsigned long long>(c.seed),
                         s.grid.nx, s.grid.ny, s.grid.dx, s.dt, c.steps, c.commands.size(), outcome.effects, seconds * 1e3,
                         outcome.refused.empty() ? 0 : 1, outcome.check.c_str(), outcome.failure.c_str());
        if (now() - told_ < 10) return;
        told_ = now();
        std::fprintf(stderr, "%.0f s: %llu scenes, %d failures\n", told_ - start_, static_cast<unsigned long long>(done_),
                     failures_.load());
    }

    void report(const Case& c, const Outcome& outcome, Devices& devices) {
        Case small = shrink(c, outcome.check, devices, options_.weaken, options_.shrink_seconds);
        if (options_.weaken == Weaken::limiter) { // so that the file alone fails
            small.scene.settings.method.outflow_limiter = false;
            small.scene.settings.method.velocity_clamp = std::max(small.scene.settings.method.velocity_clamp, 0.9);
        }
        const Outcome last = run_case(small, devices, options_.weaken, outcome.check);
        const std::string folder = options_.out + "/" + std::to_string(c.seed) + "-" + outcome.check;
        const auto status = write_level(small, folder);
        const std::lock_guard lock(mutex_);
        std::printf("FAILED seed %llu, %s: %s\n", static_cast<unsigned long long>(c.seed), outcome.check.c_str(),
                    outcome.failure.c_str());
        std::printf("  shrunk from %d x %d cells, %d steps, %zu commands to %d x %d cells, %d steps, %zu commands: %s\n",
                    c.scene.settings.grid.nx, c.scene.settings.grid.ny, c.steps, c.commands.size(), small.scene.settings.grid.nx,
                    small.scene.settings.grid.ny, small.steps, small.commands.size(), last.failure.c_str());
        std::printf("  %s\n", status ? ("wadi-fuzz --level " + folder + "/level.json --check " + outcome.check).c_str()
                                     : status.message.c_str());
        std::fflush(stdout);
    }

    const Options& options_;
    const double start_;
    std::atomic<std::uint64_t> next_;
    std::vector<Place> places_; // one per thread
    std::atomic<int> failures_{0};
    std::atomic<bool> broken_{false};
    std::mutex mutex_;
    std::uint64_t done_ = 0, refused_ = 0;
    std::map<std::string, int> count_;
    double told_ = now();
    std::FILE* csv_ = nullptr;
};

int replay(const Options& options) {
    auto c = read_level(options.level);
    auto devices = open_devices(options.backends, options.plain_set);
    for (const auto& status : {c.status(), devices.status()}) {
        if (status) continue;
        std::fprintf(stderr, "%s\n", status.message.c_str());
        return 2;
    }
    for (const auto& check : check_names()) {
        if (!options.check.empty() && check != options.check) continue;
        const Outcome outcome = run_case(*c, *devices, options.weaken, check);
        if (!outcome.failed() && outcome.refused.empty()) continue;
        std::printf("FAILED %s: %s\n", check.c_str(), (outcome.refused + outcome.failure).c_str());
        return 1;
    }
    std::puts("passed");
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    Options options;
    std::string weaken = "nothing";
    CLI::App app("Random worlds, parameters and edits, against invariants and against other ways of running them");
    app.add_option("--seconds", options.seconds, "how long new scenes are begun (unless --scenes)")->check(CLI::Range(0.1, 1e6));
    app.add_option("--scenes", options.scenes, "how many scenes");
    app.add_option("--seed", options.seed, "seed of the first scene; the next has the next");
    app.add_option("--jobs", options.jobs, "threads, each with devices of its own; 0 = all cores")->check(CLI::Range(0, 256));
    app.add_option("--backend", options.backends, "backends to compare with the plain CPU; default: all that have a device")
        ->delimiter(',');
    app.add_option("--plain-set", options.plain_set,
                   "instruction set of the plain CPU: base, or a quicker one (base costs most of the time)");
    app.add_option("--check", options.check, "this check alone, in every scene")->check(CLI::IsMember(check_names()));
    app.add_option("--method", options.method, "only scenes of this method; --scenes counts the others as well")
        ->check(CLI::IsMember({"robust", "published"}));
    app.add_option("--level", options.level, "runs a level that a failure left, instead of random scenes");
    app.add_option("--out", options.out, "folder for the levels of failures");
    app.add_option("--csv", options.csv, "a line per scene");
    app.add_option("--failures", options.most_failures, "stops after so many")->check(CLI::Range(1, 1000));
    app.add_option("--shrink-seconds", options.shrink_seconds, "time for making a failure small")->check(CLI::Range(0.0, 1e4));
    app.add_option("--stuck-seconds", options.stuck_seconds, "a scene that takes longer ends the program, with exit status 3")
        ->check(CLI::Range(0.001, 1e6));
    app.add_option("--weaken", weaken, "breaks something on purpose, which must then be found")
        ->check(CLI::IsMember({"nothing", "limiter", "bits", "rings"}));
    CLI11_PARSE(app, argc, argv);
    options.weaken = weaken == "limiter" ? Weaken::limiter
                     : weaken == "bits"  ? Weaken::bits
                     : weaken == "rings" ? Weaken::rings
                                         : Weaken::nothing;
    if (options.backends.empty()) options.backends = all_backends();
    if (options.jobs == 0) options.jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    if (!options.level.empty()) return replay(options);
    Campaign campaign(options);
    std::vector<std::thread> threads;
    std::jthread watcher([&](const std::stop_token& stop) { campaign.watch(stop); });
    for (int n = 1; n < options.jobs; ++n) threads.emplace_back([&, n] { campaign.work(static_cast<std::size_t>(n)); });
    campaign.work(0);
    for (auto& thread : threads) thread.join();
    return campaign.summary();
}
