// Printing outcomes, as a table for people or as CSV.
#pragma once
#include "tests/conformance/case.hpp"
#include <cstdio>
#include <string>

namespace wadi::conformance {

class Report {
  public:
    explicit Report(bool csv) : csv_(csv) {}
    void start();
    void add(const std::string& target, const std::string& suite, const std::string& name, const Verdict& verdict,
             double seconds);
    /// "N passed, M failed, K skipped" alone on the last line; not supported counts as skipped there.
    void finish();
    int passes() const { return counts_[static_cast<int>(Outcome::ok)]; }
    int failures() const { return counts_[static_cast<int>(Outcome::fail)]; }
    int total() const { return counts_[0] + counts_[1] + counts_[2] + counts_[3]; }

  private:
    bool csv_;
    int counts_[4] = {};
    std::vector<std::string> failed_;
};

/// A CSV field: quoted where it holds a comma or a quote.
std::string csv_field(const std::string& text);

} // namespace wadi::conformance
