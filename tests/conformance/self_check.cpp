#include "tests/conformance/self_check.hpp"
#include "tests/conformance/compare.hpp"
#include "tests/conformance/stage_suite.hpp"
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace wadi::conformance {

namespace {

using compute::Access;

struct Control {
    const char* name;
    Outcome wanted;
    const char* only; // stages it is for, "" = all
    Tamper tamper;
};

// The first buffer that the stage writes.
BenchBuffer& output_of(const compute::StageInfo& stage, std::vector<BenchBuffer>& buffers) {
    for (std::size_t b = 0; b < buffers.size(); ++b)
        if (buffers[b].exists && stage.bindings[b].access != Access::in) return buffers[b];
    return buffers.front();
}

void set_word(BenchBuffer& buffer, std::size_t word, std::uint32_t value) {
    std::memcpy(buffer.after.data() + word * 4, &value, 4);
}

// The cell that the stage wrote with the largest value.
std::size_t largest_cell(const BenchBuffer& buffer) {
    std::size_t found = 0;
    float most = -1;
    for (std::size_t w = 0; w < buffer.before.size(); ++w) {
        const float size = std::abs(buffer.floats()[w]);
        if (!buffer.may_change[w] || !(size > most)) continue;
        most = size;
        found = w;
    }
    return found;
}

const std::vector<Control>& controls() {
    static const std::vector<Control> all = {
        {"nothing", Outcome::ok, "", [](const auto&, auto&) {}},
        {"guard_byte", Outcome::fail, "",
         [](const auto&, auto& buffers) {
             auto& buffer = buffers.front();
             buffer.after[buffer.before.size() * 4 + 3000] ^= std::byte{1};
         }},
        {"input_word", Outcome::fail, "",
         [](const auto& stage, auto& buffers) {
             for (std::size_t b = 0; b < buffers.size(); ++b)
                 if (buffers[b].exists && stage.bindings[b].access == Access::in) return set_word(buffers[b], 5, 77);
             set_word(buffers[0], 0, 77); // no inputs: a ghost of the output
         }},
        {"nan_in_one_cell", Outcome::fail, "",
         [](const auto& stage, auto& buffers) {
             auto& out = output_of(stage, buffers);
             set_word(out, largest_cell(out), std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN()));
         }},
        {"one_cell_by_64_ulp", Outcome::fail,
         "integrate_water_height integrate_sand_height publish_free_surface sample_points compute_saturation",
         [](const auto& stage, auto& buffers) {
             auto& out = output_of(stage, buffers);
             const std::size_t cell = largest_cell(out);
             set_word(out, cell, out.words()[cell] + 64);
         }},
        {"ledger_by_one_quantum", Outcome::fail, "account_sides apply_rain apply_sources apply_edits write_values",
         [](const auto& stage, auto& buffers) {
             for (std::size_t b = 0; b < buffers.size(); ++b)
                 if (stage.bindings[b].name.ends_with("ledger")) set_word(buffers[b], 0, buffers[b].words()[0] + 1);
         }},
    };
    return all;
}

} // namespace

void run_self_check(Report& report) {
    auto device = open_plain_cpu();
    if (!device) return report.add("cpu0", "self-check", "open", verdict_of(device.status()), 0);
    std::string last;
    for (const CaseSpec& spec : stage_suite().list()) {
        if (spec.name == last) continue; // the first case of each stage
        last = spec.name;
        for (const Control& control : controls()) {
            if (*control.only != '\0' && std::string(control.only).find(spec.name) == std::string::npos) continue;
            const Verdict verdict = run_stage_case(spec, **device, control.tamper);
            Verdict judged = verdict.outcome == control.wanted
                                 ? passed(verdict.detail)
                                 : failed(std::string("gave ") + outcome_name(verdict.outcome) + ", wanted " +
                                          outcome_name(control.wanted) + " " + verdict.detail);
            report.add("cpu0", "self-check", std::string(control.name) + ": " + spec.text(), judged, 0);
        }
    }
}

} // namespace wadi::conformance
