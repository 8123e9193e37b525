// A conformance case: a name with parameters that prints as the argument which repeats it, and its outcome.
#pragma once
#include "engine/compute/status.hpp"
#include <string>
#include <utility>
#include <vector>

namespace wadi::conformance {

class Session;

enum class Outcome { ok, fail, not_supported, skipped };
const char* outcome_name(Outcome outcome);

struct Verdict {
    Outcome outcome = Outcome::ok;
    std::string detail;
    double error = -1; // largest difference found, in the field's unit; -1 = the case compares no numbers
    double allowed = -1;
};

inline Verdict passed(std::string detail = {}) { return {Outcome::ok, std::move(detail)}; }
inline Verdict failed(std::string detail) { return {Outcome::fail, std::move(detail)}; }
/// not_supported stays what it is; every other code is a failure.
Verdict verdict_of(const Status& status);

/// "name(key=value,key=value)".
struct CaseSpec {
    std::string name;
    std::vector<std::pair<std::string, std::string>> parameters;

    std::string text() const;
    /// The value of a parameter, or `otherwise` where it is not given.
    std::string get(const std::string& key, const std::string& otherwise) const;
};

/// The inverse of CaseSpec::text(). Errors: bad_argument.
Result<CaseSpec> parse_case(const std::string& text);

/// A suite of tests: the cases it has, and how one is run.
struct Suite {
    const char* name;
    const char* meaning;
    std::vector<CaseSpec> (*list)();
    Verdict (*run)(const CaseSpec& spec, Session& session);
};

/// Defined in files of their names.
const Suite& contract_suite();
const Suite& stage_suite();
const Suite& step_suite();
const Suite& invariant_suite();
const Suite& fused_suite();

} // namespace wadi::conformance
