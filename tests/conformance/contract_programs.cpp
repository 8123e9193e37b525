// Programs: copies and fills, order, replay, tickets and timings.
#include "shaders/effect_rows.hpp"
#include "tests/conformance/contracts.hpp"
#include <algorithm>
#include <limits>

namespace wadi::conformance {

namespace {

using compute::Buffer;
using compute::Device;
using compute::ProgramBuilder;

void transfers(Session&, Device& device, Expect& expect) {
    std::vector<std::uint32_t> count(16);
    for (std::uint32_t n = 0; n < 16; ++n) count[n] = n;
    const Buffer a = buffer_of(device, count), b = buffer_of(device, std::vector<std::uint32_t>(16, 9)),
                 c = buffer_of(device, std::vector<std::uint32_t>(16, 8));
    ProgramBuilder builder("transfers");
    builder.fill({b, 0xABCD1234u});
    builder.copy({a, b, 8, 20, 12});
    builder.copy({b, c, 0, 0, 64});
    builder.fill({b, 3});
    builder.copy({a, b, 0, 0, 0});
    expect.ok(run_once(device, builder), "fills and copies");
    std::vector<std::uint32_t> wanted(16, 0xABCD1234u);
    for (std::uint32_t n = 0; n < 3; ++n) wanted[5 + n] = 2 + n;
    expect.that(words_of(device, c, 16) == wanted, "fill, copy at offsets, copy on: wrong content");
    expect.that(words_of(device, b, 16) == std::vector<std::uint32_t>(16, 3),
                "a fill after a copy from the same buffer: wrong content");
    expect.that(words_of(device, a, 16) == count, "a copy changed its source");
    for (const Buffer buffer : {a, b, c}) device.destroy_buffer(buffer);
}

void order(Session&, Device& device, Expect& expect) {
    const Buffer a = buffer_of(device, std::vector<std::uint32_t>(4096, 1)),
                 b = buffer_of(device, std::vector<std::uint32_t>(4096, 0)),
                 c = buffer_of(device, std::vector<std::uint32_t>(4096, 0));
    ProgramBuilder to_b("to b"), to_c("to c");
    to_b.copy({a, b, 0, 0, 16384});
    to_c.copy({a, c, 0, 0, 16384});
    auto first = device.compile(to_b, small_params()), second = device.compile(to_c, small_params());
    expect.ok(first.status(), "compile");
    expect.ok(second.status(), "compile");
    if (!first || !second) return;
    const std::vector<std::uint32_t> two(4096, 2);
    expect.ok(device.submit(*first, StepInput{}).status(), "submit");
    expect.ok(device.write(a, 0, std::as_bytes(std::span(two))), "write between submissions");
    expect.ok(device.submit(*second, StepInput{}).status(), "submit");
    expect.that(words_of(device, b, 4096) == std::vector<std::uint32_t>(4096, 1), "a write overtook an earlier submission");
    expect.that(words_of(device, c, 4096) == two, "a submission did not see an earlier write, or a read did not wait for it");
    device.destroy_program(*first);
    device.destroy_program(*second);
    for (const Buffer buffer : {a, b, c}) device.destroy_buffer(buffer);
}

// More submissions than any queue holds, each with its own input, none waited for.
void replay(Session& session, Device& device, Expect& expect) {
    Rain rain(device);
    auto dispatch = rain_dispatch(device, rain.terrain, rain.water, rain.ledger);
    expect.ok(dispatch.status(), "create_pipeline");
    if (!dispatch) return;
    ProgramBuilder builder("rain");
    builder.dispatch(*dispatch);
    auto program = device.compile(builder, small_params());
    expect.ok(program.status(), "compile");
    if (!program) return;
    const auto before = device.counters();
    const float quantum = small_params().quantum;
    float expected = 0;
    std::uint64_t last = 0;
    for (int n = 1; n <= 100; ++n) {
        StepInput input{};
        input.rain = static_cast<float>(n) * quantum;
        expected += input.rain;
        auto ticket = device.submit(*program, input);
        expect.ok(ticket.status(), "submit");
        if (!ticket) return;
        expect.that(ticket->value > last, "tickets do not increase");
        last = ticket->value;
    }
    expect.ok(device.wait({last}), "wait");
    expect.that(device.finished({last}) && device.finished({1}), "a ticket waited for, or an older one, is not finished");
    expect.ok(device.wait({1}), "wait for an old ticket");
    const auto after = device.counters();
    expect.that(rain.depth() == expected, "100 replays with their own inputs do not add up");
    expect.that(after.allocations == before.allocations, "a submission allocates");
    expect.that(after.descriptor_writes == before.descriptor_writes, "a submission writes descriptors");
    expect.that(after.recordings == before.recordings || session.options().no_replay, "a submission records anew");
    expect.that(after.submits >= before.submits + 100, "submits are not counted");
    device.destroy_program(*program);
}

// Each dispatch of a program reads its own step's input, submission after submission.
void inputs_of_one_submission(Session&, Device& device, Expect& expect) {
    Rain rain(device);
    auto dispatch = rain_dispatch(device, rain.terrain, rain.water, rain.ledger);
    if (!dispatch) return expect.ok(dispatch.status(), "create_pipeline");
    const float quantum = small_params().quantum;
    ProgramBuilder builder("rains");
    for (int n = 0; n < compute::most_inputs; ++n) {
        if (n > 0) builder.next_input();
        for (int times = 0; times <= n; ++times) builder.dispatch(*dispatch);
    }
    auto program = device.compile(builder, small_params());
    expect.ok(program.status(), "compile");
    if (!program) return;
    std::vector<StepInput> inputs(compute::most_inputs);
    float expected = 0;
    for (int repeat = 0; repeat < 40; ++repeat) {
        for (int n = 0; n < compute::most_inputs; ++n) {
            const auto quanta = static_cast<float>((n * 5 + repeat) % 7);
            inputs[static_cast<std::size_t>(n)].rain = quanta * quantum;
            expected += static_cast<float>(n + 1) * quanta * quantum;
        }
        expect.ok(device.submit_inputs(*program, inputs).status(), "submit_inputs");
    }
    expect.that(rain.depth() == expected, "dispatches do not read the inputs of their steps");
    expect.code(device.submit(*program, inputs[0]).status(), {Code::bad_argument}, "submit with too few inputs");
    builder.next_input();
    expect.code(device.compile(builder, small_params()).status(), {Code::bad_argument}, "compile with too many inputs");
    device.destroy_program(*program);
}

void frozen_params(Session&, Device& device, Expect& expect) {
    Rain rain(device);
    auto dispatch = rain_dispatch(device, rain.terrain, rain.water, rain.ledger);
    if (!dispatch) return expect.ok(dispatch.status(), "create_pipeline");
    ProgramBuilder builder("rain");
    builder.dispatch(*dispatch);
    WorldParams low = small_params();
    low.largest_height = 0; // no rain fits under it
    auto wet = device.compile(builder, small_params()), dry = device.compile(builder, low);
    expect.ok(wet.status(), "compile");
    expect.ok(dry.status(), "compile");
    if (!wet || !dry) return;
    StepInput input{};
    input.rain = small_params().quantum;
    for (const auto program : {*wet, *dry, *wet, *dry}) expect.ok(device.submit(program, input).status(), "submit");
    expect.that(rain.depth() == 2 * input.rain, "programs do not keep the parameters they were compiled with");
    device.destroy_program(*wet);
    device.destroy_program(*dry);
}

void program_handles(Session&, Device& device, Expect& expect) {
    ProgramBuilder builder("nothing");
    auto program = device.compile(builder, small_params());
    expect.ok(program.status(), "compile of an empty program");
    if (!program) return;
    auto ticket = device.submit(*program, StepInput{});
    expect.ok(ticket.status(), "submit of an empty program");
    if (ticket) expect.ok(device.wait(*ticket), "wait for an empty program");
    device.destroy_program(*program);
    device.destroy_program(*program);
    device.destroy_program({});
    for (const compute::Program p : {compute::Program{}, compute::Program{4'000'000'000u}, *program})
        expect.refused(device.submit(p, StepInput{}).status(), "no program has the handle " + std::to_string(p.id), "submit");
    constexpr compute::Ticket never{1'000'000'000'000};
    expect.that(!device.finished(never), "a ticket never given out is finished");
    expect.refused(device.wait(never), "ticket 1000000000000 was never given out", "wait");
    expect.refused(device.timings(never).status(), "ticket 1000000000000 was never given out", "timings");
}

void pipelines(Session&, Device& device, Expect& expect) {
    const int stages = static_cast<int>(compute::stage_table().size());
    for (const int stage : {-1, stages, std::numeric_limits<int>::max()})
        expect.refused(device.create_pipeline(stage, 0, {}).status(), "no stage has the index " + std::to_string(stage),
                       "a pipeline of a stage that does not exist");
    const int rain = compute::find_stage("apply_rain");
    auto a = device.create_pipeline(rain, EFFECT_WATER, {}), b = device.create_pipeline(rain, EFFECT_WATER, {});
    auto untested = device.create_pipeline(rain, EFFECT_WATER | EFFECT_BED_FRICTION, {}),
         other = device.create_pipeline(rain, EFFECT_WATER | EFFECT_SAND, {});
    expect.that(a && b && a->id == b->id, "equal requests do not share a pipeline");
    expect.that(a && untested && a->id == untested->id, "an effect that the stage does not test makes another pipeline");
    expect.that(a && other && a->id != other->id, "a tested effect makes no other pipeline");
    // All that a world can have at once: the paper's method with its own choice, or what it knows nothing of.
    constexpr std::uint32_t published = EFFECT_PUBLISHED | EFFECT_DIRECT_STRAIN;
    for (int stage = 0; stage < stages; ++stage)
        for (const std::uint32_t mask : {~published, ~never_published, all_effects}) {
            const auto& info = compute::stage_table()[static_cast<std::size_t>(stage)];
            const auto made = device.create_pipeline(stage, mask, {});
            if (info.fused() && !device.capabilities().fused_stages) {
                expect.code(made.status(), {Code::not_supported}, std::string(info.name) + " on a device that cannot");
            } else {
                expect.ok(made.status(), "all effects of " + std::string(info.name));
            }
        }
}

void timings(Session&, Device& device, Expect& expect) {
    Rain rain(device);
    auto dispatch = rain_dispatch(device, rain.terrain, rain.water, rain.ledger);
    if (!dispatch) return expect.ok(dispatch.status(), "create_pipeline");
    ProgramBuilder timed("timed"), plain("plain");
    timed.timestamp("start");
    timed.dispatch(*dispatch);
    timed.timestamp("rain");
    timed.fill({rain.water, 0});
    timed.timestamp("fill");
    plain.dispatch(*dispatch);
    auto with = device.compile(timed, small_params()), without = device.compile(plain, small_params());
    expect.ok(with.status(), "compile with timestamps");
    expect.ok(without.status(), "compile without timestamps");
    if (!with || !without) return;
    for (int n = 0; n < 20; ++n) { // every slot of a queue, and again
        auto ticket = device.submit(*with, StepInput{});
        if (!ticket) return expect.ok(ticket.status(), "submit");
        expect.ok(device.wait(*ticket), "wait");
        auto times = device.timings(*ticket);
        if (!device.capabilities().timestamps) {
            expect.code(times.status(), {Code::not_supported, Code::ok}, "timings without timestamps");
            continue;
        }
        if (!times) return expect.ok(times.status(), "timings");
        expect.that(times->size() == 2 && (*times)[0].label == "rain" && (*times)[1].label == "fill",
                    "three timestamps do not give the times of two labels");
        for (const auto& t : *times)
            expect.that(t.milliseconds >= 0 && t.milliseconds < 60000, "a time of " + std::to_string(t.milliseconds) + " ms");
    }
    auto ticket = device.submit(*without, StepInput{});
    if (!ticket) return expect.ok(ticket.status(), "submit");
    expect.ok(device.wait(*ticket), "wait");
    auto times = device.timings(*ticket);
    expect.that(times && times->empty(), "a program without timestamps has timings");
    device.destroy_program(*with);
    device.destroy_program(*without);
}

// A large dispatch and a fill of one word in turn: the time must go to the one that takes it.
void timings_by_label(Session&, Device& device, Expect& expect) {
    if (!device.capabilities().timestamps) return;
    WorldParams params = small_params();
    params.nx = params.ny = 2048;
    params.pitch = FieldLayout{params.nx, params.ny}.pitch();
    const FieldLayout layout{params.nx, params.ny};
    std::vector<Buffer> fields;
    for (int n = 0; n < 4; ++n) {
        auto made = device.create_buffer({layout.size() * 4, "large"});
        if (!made) return expect.ok(made.status(), "a field of 2048 x 2048");
        fields.push_back(*made);
    }
    const Buffer word = buffer_of(device, {0});
    const int stage = compute::find_stage("publish_velocity");
    auto pipeline = device.create_pipeline(stage, 0, {});
    if (!pipeline) return expect.ok(pipeline.status(), "create_pipeline");
    ProgramBuilder builder("labels");
    builder.timestamp("start");
    for (int n = 0; n < 8; ++n) {
        builder.fill({word, 1});
        builder.timestamp("small");
        builder.dispatch(
            {*pipeline, stage, 0, fields, compute::extent_range(compute::Extent::cells, params), "publish_velocity"});
        builder.timestamp("large");
    }
    auto program = device.compile(builder, params);
    if (!program) return expect.ok(program.status(), "compile");
    // Each of its own best over several runs: another process on the cores may stretch any one of them.
    double small = 1e30, large = 1e30;
    for (int n = 0; n < 40 && (n < 3 || small >= 0.5 * large); ++n) {
        auto ticket = device.submit(*program, StepInput{});
        if (!ticket) return expect.ok(ticket.status(), "submit");
        expect.ok(device.wait(*ticket), "wait");
        auto times = device.timings(*ticket);
        if (!times) return expect.ok(times.status(), "timings");
        double run_small = 0, run_large = 0;
        for (const auto& time : *times) (time.label == "small" ? run_small : run_large) += time.milliseconds;
        small = std::min(small, run_small);
        large = std::min(large, run_large);
    }
    expect.that(small < 0.5 * large, "24 fills of one word took " + std::to_string(small) +
                                         " ms, 24 passes over 2048 x 2048 cells " + std::to_string(large) + " ms");
    device.destroy_program(*program);
    for (const Buffer buffer : fields) device.destroy_buffer(buffer);
    device.destroy_buffer(word);
}

} // namespace

std::span<const Contract> program_contracts() {
    static constexpr Contract contracts[] = {
        {"transfers", transfers},
        {"order", order},
        {"replay", replay},
        {"inputs_of_one_submission", inputs_of_one_submission},
        {"frozen_params", frozen_params},
        {"program_handles", program_handles},
        {"pipelines", pipelines},
        {"timings", timings},
        {"timings_by_label", timings_by_label},
    };
    return contracts;
}

} // namespace wadi::conformance
