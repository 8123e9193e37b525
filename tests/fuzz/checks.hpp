// What must hold for a case: invariants of its run, and other ways of running it that must give the same.
#pragma once
#include "tests/conformance/target.hpp"
#include "tests/fuzz/fuzz_case.hpp"
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace wadi::fuzz {

/// The devices of one job, opened once: pipelines are kept from case to case.
struct Devices {
    std::unique_ptr<conformance::Session> plain; // one thread of the CPU, against which all others are compared
    std::vector<std::unique_ptr<conformance::Session>> others;
};
/// `plain_set`: instruction set of the plain one. Errors: not_found for a backend that is not there.
Result<Devices> open_devices(const std::vector<std::string>& backends, const std::string& plain_set);

/// Names of all checks (README.md).
const std::vector<std::string>& check_names();

/// What is made wrong on purpose, to see it found.
enum class Weaken { nothing, limiter, bits, rings };

struct Outcome {
    std::string refused;              // why the world could not be made; not a failure
    std::string check, failure;       // the check that failed, and how
    std::map<std::string, int> count; // checks made
    std::uint32_t effects = 0;
    bool failed() const { return !failure.empty(); }
};

/// Runs a case and its checks: `only` that one (and books), or those that its seed picks.
Outcome run_case(const Case& c, Devices& devices, Weaken weaken, const std::string& only = "");

/// The smallest case found that fails the same check: halves of the grid, fewer steps, commands and effects, default parameters.
Case shrink(Case c, const std::string& check, Devices& devices, Weaken weaken, double seconds);

} // namespace wadi::fuzz
