#include "tests/conformance/compare.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

namespace wadi::conformance {

namespace {

std::string number(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", x);
    return text;
}

std::string cell(int i, int j) {
    char text[32];
    std::snprintf(text, sizeof text, "(%d, %d)", i, j);
    return text;
}

// Calls f(field, i, j, index) for every compared value.
template <class F> void for_values(const std::vector<FieldCheck>& fields, const FieldLayout& layout, F f) {
    for (const auto& field : fields) {
        for (int j = field.range.j0; j < field.range.j1; ++j) {
            for (int i = field.range.i0; i < field.range.i1; ++i) {
                const std::size_t at = layout.index(i, j);
                f(field, i, j, at);
            }
        }
    }
}

} // namespace

Verdict compare_fields(const std::vector<FieldCheck>& components, const FieldLayout& layout, double quanta) {
    double scale = 0, e0 = 0, truncation = quanta, error = 0;
    std::string branch, place;
    for_values(components, layout, [&](const FieldCheck& field, int i, int j, std::size_t at) {
        scale = std::max(scale, std::abs(field.wide[at]));
        const double difference = std::abs(static_cast<double>(field.narrow[at]) - field.wide[at]);
        if (difference > e0) {
            e0 = difference;
            branch = field.name + cell(i, j);
        }
        if (!field.unrounded.empty()) truncation = std::max(truncation, std::abs(field.wide[at] - field.unrounded[at]));
    });
    const double allowed = 8 * e0 + 16 * static_cast<double>(std::numeric_limits<float>::epsilon()) * scale + truncation;
    std::string not_a_number;
    for_values(components, layout, [&](const FieldCheck& field, int i, int j, std::size_t at) {
        const double got = static_cast<double>(field.got[at]);
        if (!std::isfinite(got) && not_a_number.empty())
            not_a_number = field.name + cell(i, j) + " is " + number(got) + " (expected " + number(field.wide[at]) + ")";
        const double difference = std::abs(got - field.wide[at]);
        if (difference > error) {
            error = difference;
            place = field.name + cell(i, j) + " is " + number(got) + ", expected " + number(field.wide[at]) + " +- " +
                    number(allowed);
        }
    });
    Verdict verdict{Outcome::ok, {}, error, allowed};
    if (!not_a_number.empty()) {
        verdict = failed(not_a_number);
    } else if (error > allowed) {
        verdict.outcome = Outcome::fail;
        verdict.detail = place;
    } else if (8 * e0 + truncation > 0.05 * scale + 9 * quanta) {
        verdict.outcome = Outcome::fail;
        verdict.detail = "proves nothing: the float and the double reference differ by " + number(e0) + " of " + number(scale) +
                         " at " + branch + ", truncation by " + number(truncation);
    }
    return verdict;
}

Verdict compare_bits(const std::string& name, std::span<const float> got, std::span<const float> expected,
                     const FieldLayout& layout, compute::Range2 range) {
    for (int j = range.j0; j < range.j1; ++j) {
        for (int i = range.i0; i < range.i1; ++i) {
            const std::size_t at = layout.index(i, j);
            if (std::memcmp(&got[at], &expected[at], sizeof(float)) == 0) continue;
            return failed(name + cell(i, j) + " is " + number(static_cast<double>(got[at])) + ", expected the bits of " +
                          number(static_cast<double>(expected[at])));
        }
    }
    return {};
}

compute::Range2 whole_layout(const FieldLayout& layout) { return {-GHOST, -GHOST, layout.nx + 1 + GHOST, layout.ny + 1 + GHOST}; }

Verdict worse(const Verdict& a, const Verdict& b) {
    if (a.outcome == Outcome::fail || b.outcome == Outcome::fail) return a.outcome == Outcome::fail ? a : b;
    const auto nearness = [](const Verdict& v) { return v.allowed > 0 ? v.error / v.allowed : v.error < 0 ? -1 : v.error; };
    return nearness(a) >= nearness(b) ? a : b;
}

std::byte guard_byte(std::size_t n) { return static_cast<std::byte>(0xA5u ^ (n * 31u & 0xFFu)); }

float untouched_value() { return -2.7182817e33F; }

} // namespace wadi::conformance
