#include "engine/step/plan/world_params.hpp"
#include "tests/conformance/contracts.hpp"
#include "tests/conformance/inputs.hpp"
#include <cstring>

namespace wadi::conformance {

namespace {

std::vector<CaseSpec> list() {
    std::vector<CaseSpec> cases;
    for (const auto contracts :
         {buffer_contracts(), program_contracts(), refusal_contracts(), device_contracts(), host_contracts()})
        for (const Contract& contract : contracts) cases.push_back({contract.name, {}});
    return cases;
}

Verdict run(const CaseSpec& spec, Session& session) {
    auto device = session.device();
    if (!device) return verdict_of(device.status());
    for (const auto contracts :
         {buffer_contracts(), program_contracts(), refusal_contracts(), device_contracts(), host_contracts()}) {
        for (const Contract& contract : contracts) {
            if (spec.name != contract.name) continue;
            Expect expect;
            contract.check(session, **device, expect);
            return expect.verdict();
        }
    }
    return failed("no such contract");
}

} // namespace

compute::Buffer buffer_of(compute::Device& device, const std::vector<std::uint32_t>& words) {
    auto made = device.create_buffer({words.size() * 4, "test"});
    if (!made || !device.write(*made, 0, std::as_bytes(std::span(words)))) return {};
    return *made;
}

std::vector<std::uint32_t> words_of(compute::Device& device, compute::Buffer buffer, std::size_t count) {
    std::vector<std::uint32_t> words(count, 0xDEADBEEFu);
    if (!device.read(buffer, 0, std::as_writable_bytes(std::span(words)))) words.clear();
    return words;
}

Status run_once(compute::Device& device, const compute::ProgramBuilder& builder) {
    auto program = device.compile(builder, small_params());
    if (!program) return program.status();
    auto ticket = device.submit(*program, StepInput{});
    Status status = ticket ? device.wait(*ticket) : ticket.status();
    device.destroy_program(*program);
    return status;
}

WorldParams small_params() {
    static const WorldParams params = [] {
        auto scene = make_scene("33x17", "flat", "default", EFFECT_WATER);
        return scene ? derive_params(scene->settings, scene->effects) : WorldParams{};
    }();
    return params;
}

Result<compute::Dispatch> rain_dispatch(compute::Device& device, compute::Buffer terrain, compute::Buffer water,
                                        compute::Buffer ledger) {
    const int stage = compute::find_stage("apply_rain");
    auto pipeline = device.create_pipeline(stage, EFFECT_WATER | EFFECT_RAIN, {});
    if (!pipeline) return pipeline.status();
    return compute::Dispatch{*pipeline,
                             stage,
                             EFFECT_WATER | EFFECT_RAIN,
                             {terrain, water, ledger, {}, {}},
                             compute::extent_range(compute::Extent::strips, small_params()),
                             "rain"};
}

const Suite& contract_suite() {
    static const Suite suite = {"contract", "every call of the compute interface, with good and bad arguments", list, run};
    return suite;
}

} // namespace wadi::conformance
