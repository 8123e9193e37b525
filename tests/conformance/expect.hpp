// Collects what a contract demands; the first demand that is not met becomes the verdict.
#pragma once
#include "engine/compute/status.hpp"
#include "tests/conformance/case.hpp"
#include <initializer_list>
#include <string>

namespace wadi::conformance {

class Expect {
  public:
    void that(bool held, const std::string& demand) {
        if (!held && verdict_.outcome == Outcome::ok) verdict_ = failed(demand);
    }
    void ok(const Status& status, const std::string& what) { that(bool(status), what + ": " + status.message); }
    /// The status must have one of the codes, and an error a message.
    void code(const Status& status, std::initializer_list<Code> wanted, const std::string& what) {
        bool found = false;
        std::string names;
        for (const Code c : wanted) {
            found |= status.code == c;
            if (!names.empty()) names += " or ";
            names += code_name(c);
        }
        that(found, what + " gave " + code_name(status.code) + ", wanted " + names);
        that(status || !status.message.empty(), what + ": an error without a message");
    }
    /// A bad argument, in these words.
    void refused(const Status& status, const std::string& words, const std::string& what) {
        code(status, {Code::bad_argument}, what);
        that(status.message.find(words) != std::string::npos,
             what + ": \"" + status.message + "\" does not say \"" + words + "\"");
    }
    const Verdict& verdict() const { return verdict_; }

  private:
    Verdict verdict_;
};

} // namespace wadi::conformance
