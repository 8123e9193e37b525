#include "tests/conformance/case.hpp"
#include <algorithm>
#include <utility>

namespace wadi::conformance {

const char* outcome_name(Outcome outcome) {
    switch (outcome) {
    case Outcome::ok:
        return "OK";
    case Outcome::fail:
        return "FAIL";
    case Outcome::not_supported:
        return "NOT_SUPPORTED";
    case Outcome::skipped:
        return "SKIPPED";
    }
    return "";
}

Verdict verdict_of(const Status& status) {
    if (status) return {};
    return {status.code == Code::not_supported ? Outcome::not_supported : Outcome::fail,
            std::string(code_name(status.code)) + ": " + status.message};
}

std::string CaseSpec::text() const {
    std::string text = name;
    for (std::size_t n = 0; n < parameters.size(); ++n)
        text += (n == 0 ? "(" : ",") + parameters[n].first + "=" + parameters[n].second;
    return parameters.empty() ? text : text + ")";
}

std::string CaseSpec::get(const std::string& key, const std::string& otherwise) const {
    const auto found = std::find_if(parameters.begin(), parameters.end(), [&](const auto& p) { return p.first == key; });
    return found == parameters.end() ? otherwise : found->second;
}

Result<CaseSpec> parse_case(const std::string& text) {
    const auto bad = [&](const std::string& why) {
        return error(Code::bad_argument, "--case \"" + text + "\": " + why + "; want NAME or NAME(key=value,key=value)");
    };
    CaseSpec spec;
    const std::size_t open = text.find('(');
    spec.name = text.substr(0, open);
    if (spec.name.empty()) return bad("no name");
    if (open == std::string::npos) return spec;
    if (text.back() != ')') return bad("no closing parenthesis");
    std::size_t at = open + 1;
    while (at < text.size() - 1) {
        const std::size_t end = std::min(text.find(',', at), text.size() - 1);
        const std::string part = text.substr(at, end - at);
        const std::size_t equals = part.find('=');
        if (equals == std::string::npos || equals == 0) return bad("\"" + part + "\" is not key=value");
        spec.parameters.emplace_back(part.substr(0, equals), part.substr(equals + 1));
        at = end + 1;
    }
    return spec;
}

} // namespace wadi::conformance
