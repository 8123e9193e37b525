#include "tests/conformance/report.hpp"

namespace wadi::conformance {

namespace {

std::string number(double x) {
    if (x < 0) return {};
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", x);
    return text;
}

} // namespace

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

void Report::start() {
    if (csv_) std::printf("outcome,device,layer,case,error,allowed,seconds,detail\n");
}

void Report::add(const std::string& target, const std::string& suite, const std::string& name, const Verdict& v, double seconds) {
    ++counts_[static_cast<int>(v.outcome)];
    if (v.outcome == Outcome::fail) failed_.push_back("--backend " + target + " --case \"" + name + "\"");
    if (csv_) {
        std::printf("%s,%s,%s,%s,%s,%s,%.4f,%s\n", outcome_name(v.outcome), target.c_str(), suite.c_str(),
                    csv_field(name).c_str(), number(v.error).c_str(), number(v.allowed).c_str(), seconds,
                    csv_field(v.detail).c_str());
    } else {
        std::string tail;
        if (v.error >= 0) tail = "  error " + number(v.error) + " of " + number(v.allowed);
        if (!v.detail.empty()) tail += "  " + v.detail;
        std::printf("%-13s %-9s %-9s %s%s\n", outcome_name(v.outcome), target.c_str(), suite.c_str(), name.c_str(), tail.c_str());
    }
    std::fflush(stdout);
}

void Report::finish() {
    const int not_supported = counts_[static_cast<int>(Outcome::not_supported)],
              skipped = counts_[static_cast<int>(Outcome::skipped)];
    std::FILE* out = csv_ ? stderr : stdout;
    if (!failed_.empty()) std::fprintf(out, "\nto repeat what failed:\n");
    for (const std::string& line : failed_) std::fprintf(out, "  conformance test %s\n", line.c_str());
    if (not_supported > 0) std::fprintf(out, "%d of the skipped cases are not supported by their device\n", not_supported);
    std::fprintf(out, "%d passed, %d failed, %d skipped\n", counts_[0], failures(), skipped + not_supported);
}

} // namespace wadi::conformance
