#include "tests/conformance/locate.hpp"
#include "engine/world.hpp"
#include "tests/conformance/compare.hpp"
#include "tests/conformance/fields.hpp"
#include "tests/conformance/pass_runner.hpp"
#include "tests/conformance/stage_reference.hpp"
#include <algorithm>
#include <bit>

namespace wadi::conformance {

namespace {

// What a pass writes: binding, plan field and the buffer behind it, found before the pass flips names.
struct Written {
    std::string binding, field;
    compute::Scalar type;
    compute::Buffer buffer;
};

std::vector<Written> written_by(const PassRunner& runner, const PlanPass& pass) {
    std::vector<Written> written;
    const auto& bindings = compute::stage_table()[static_cast<std::size_t>(pass.stage)].bindings;
    for (std::size_t b = 0; b < pass.fields.size(); ++b) {
        if (pass.fields[b].empty() || bindings[b].access == compute::Access::in) continue;
        written.push_back({std::string(bindings[b].name), pass.fields[b], bindings[b].type, runner.buffer(pass.fields[b])});
    }
    return written;
}

std::string where(const PassRunner& runner, int step, std::size_t pass, const std::string& what) {
    const std::string label = pass_label(runner.plan(), runner.passes(step == 0), pass);
    return "first difference in step " + std::to_string(step) + ", " + label + ": " + what;
}

// The state that a World of the scene begins with.
Status begin(PassRunner& runner, const Scene& scene) {
    if (auto status = runner.open(); !status) return status;
    auto plain = open_plain_cpu();
    if (!plain) return plain.status();
    auto world = World::create(scene.settings, scene.fields, std::move(*plain));
    if (!world) return world.status();
    for (const auto& field : runner.plan().fields) {
        if (field.role != FieldRole::state || (*world)->plan().find(field.name) == nullptr) continue;
        auto values = (*world)->reader().read_raw(field.name);
        if (!values) return values.status();
        std::vector<std::uint32_t> words(values->size());
        for (std::size_t n = 0; n < words.size(); ++n) words[n] = std::bit_cast<std::uint32_t>((*values)[n]);
        if (auto status = runner.write(field.name, words); !status) return status;
    }
    return ok_status();
}

std::vector<float> as_floats(const std::vector<std::uint32_t>& words) {
    std::vector<float> values(words.size());
    for (std::size_t n = 0; n < words.size(); ++n) values[n] = std::bit_cast<float>(words[n]);
    return values;
}

} // namespace

std::string locate_against_reference(compute::Device& device, const Scene& scene, int steps) {
    PassRunner runner(device, scene);
    if (auto status = begin(runner, scene); !status) return status.message;
    References references(scene);
    StepInputs inputs(scene.settings);
    for (int step = 0; step < steps; ++step) {
        const StepInput input = inputs.next(step);
        const auto passes = runner.passes(step == 0);
        const auto& start = runner.plan().start_passes;
        for (std::size_t n = 0; n < passes.size(); ++n) {
            const std::string stage(compute::stage_table()[static_cast<std::size_t>(passes[n]->stage)].name);
            const bool starts = std::any_of(start.begin(), start.end(), [&](const PlanPass& pass) { return &pass == passes[n]; });
            const auto written = written_by(runner, *passes[n]);
            if (auto status = runner.run(*passes[n], input); !status) return where(runner, step, n, status.message);
            if (starts && stage != "start_water_velocity") continue; // the reference has them as one
            references.run_stage(stage);
            for (const Written& out : written) {
                if (out.type != compute::Scalar::f32) continue;
                auto words = runner.read(out.buffer, out.field);
                if (!words) return words.status().message;
                const auto got = as_floats(*words);
                const FieldName name = field_of(stage, out.binding, scene.effects);
                const auto low = reference_field(references.narrow, stage, name, true);
                const auto high = reference_field(references.wide, stage, name, true);
                const auto plain = reference_field(references.unrounded, stage, name, true);
                const FieldCheck check{out.field, values_of(name.base, runner.params()), got, low, high, plain};
                const Verdict verdict = compare_fields({check}, runner.layout(), static_cast<double>(runner.params().quantum));
                if (verdict.outcome == Outcome::fail) return where(runner, step, n, verdict.detail);
            }
        }
        references.finish_step();
    }
    return "no single pass differs from the reference";
}

std::string locate_against_device(compute::Device& device, compute::Device& other, const Scene& scene, int steps) {
    PassRunner tested(device, scene), trusted(other, scene);
    if (auto status = begin(tested, scene); !status) return status.message;
    if (auto status = begin(trusted, scene); !status) return status.message;
    StepInputs inputs(scene.settings);
    for (int step = 0; step < steps; ++step) {
        const StepInput input = inputs.next(step);
        const auto passes = trusted.passes(step == 0);
        for (std::size_t n = 0; n < passes.size(); ++n) {
            for (const std::string& field : passes[n]->fields) {
                if (field.empty()) continue;
                auto words = trusted.read(field);
                if (!words) return words.status().message;
                if (auto status = tested.write(field, *words); !status) return status.message;
            }
            const auto from = written_by(tested, *passes[n]), expected = written_by(trusted, *passes[n]);
            if (auto status = trusted.run(*passes[n], input); !status) return status.message;
            if (auto status = tested.run(*passes[n], input); !status) return where(tested, step, n, status.message);
            for (std::size_t out = 0; out < from.size(); ++out) {
                auto got = tested.read(from[out].buffer, from[out].field);
                auto want = trusted.read(expected[out].buffer, expected[out].field);
                if (!got) return got.status().message;
                if (!want) return want.status().message;
                if (*got == *want) continue;
                const FieldLayout layout = tested.layout();
                if (got->size() != layout.size()) return where(tested, step, n, from[out].field + " counts differently");
                return where(
                    tested, step, n,
                    compare_bits(from[out].field, as_floats(*got), as_floats(*want), layout, whole_layout(layout)).detail);
            }
        }
    }
    return "every pass alone gives the same bits: look at the order of passes, barriers or parity";
}

} // namespace wadi::conformance
