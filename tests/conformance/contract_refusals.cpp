// What every backend refuses, in the same words. Each demand was seen to fail without its check.
#include "tests/conformance/contracts.hpp"
#include <functional>
#include <limits>

namespace wadi::conformance {

namespace {

using compute::Buffer;
using compute::Device;
using compute::Dispatch;
using compute::ProgramBuilder;

constexpr Buffer never_made{4'000'000'000u};

void refuse_program(Device& device, Expect& expect, const ProgramBuilder& builder, const WorldParams& params,
                    const std::string& words) {
    auto program = device.compile(builder, params);
    expect.refused(program.status(), words, "compile");
    if (program) device.destroy_program(*program);
}

void bad_dispatches(Session&, Device& device, Expect& expect) {
    const Buffer gone = buffer_of(device, {0});
    device.destroy_buffer(gone);
    const Rain rain(device);
    const auto refuse = [&](const std::string& words, const std::function<void(Dispatch&)>& change) {
        auto dispatch = rain_dispatch(device, rain.terrain, rain.water, rain.ledger);
        expect.ok(dispatch.status(), "create_pipeline");
        if (!dispatch) return;
        change(*dispatch);
        ProgramBuilder builder("refused");
        builder.dispatch(*dispatch);
        refuse_program(device, expect, builder, small_params(), "program 'refused', dispatch 'rain'" + words);
    };
    refuse(" of apply_rain: 4 slots, the stage has 5", [](Dispatch& d) { d.slots.pop_back(); });
    refuse(" of apply_rain: 6 slots, the stage has 5", [](Dispatch& d) { d.slots.emplace_back(); });
    refuse(" of apply_rain, water_height: the buffer is null", [](Dispatch& d) { d.slots[1] = {}; });
    refuse(" of apply_rain, water_height: no buffer has the handle " + std::to_string(gone.id),
           [&](Dispatch& d) { d.slots[1] = gone; });
    refuse(" of apply_rain, terrain: no buffer has the handle 4000000000", [](Dispatch& d) { d.slots[0] = never_made; });
    refuse(" of apply_rain, water_height: buffer 'test' is bound twice and written",
           [](Dispatch& d) { d.slots[0] = d.slots[1]; });
    refuse(" of apply_rain: the pipeline is null", [](Dispatch& d) { d.pipeline = {}; });
    refuse(" of apply_rain: no pipeline has the handle 4000000000", [](Dispatch& d) { d.pipeline = {4'000'000'000u}; });
    const auto stages = static_cast<int>(compute::stage_table().size());
    for (const int stage : {-1, stages, std::numeric_limits<int>::max()})
        refuse(": no stage has the index " + std::to_string(stage), [&](Dispatch& d) { d.stage = stage; });
    auto other = device.create_pipeline(compute::find_stage("publish_velocity"), EFFECT_WATER, {});
    expect.ok(other.status(), "create_pipeline");
    if (other)
        refuse(" of apply_rain: the pipeline was made for stage publish_velocity", [&](Dispatch& d) { d.pipeline = *other; });
    auto with_sand = device.create_pipeline(compute::find_stage("apply_rain"), EFFECT_WATER | EFFECT_SAND | EFFECT_RAIN, {});
    expect.ok(with_sand.status(), "create_pipeline");
    if (with_sand)
        refuse(" of apply_rain: the pipeline was made for other effects", [&](Dispatch& d) { d.pipeline = *with_sand; });
    // A binding that does not exist is not looked at.
    auto dispatch = rain_dispatch(device, rain.terrain, rain.water, rain.ledger);
    if (!dispatch) return;
    for (const Buffer absent : {Buffer{}, gone, never_made, rain.terrain}) {
        dispatch->slots[3] = absent;
        ProgramBuilder builder("absent");
        builder.dispatch(*dispatch);
        expect.ok(run_once(device, builder), "a dispatch with any handle where the binding does not exist");
    }
}

// Over active tiles: the lists, and a pipeline made for them.
void bad_tiles(Session&, Device& device, Expect& expect) {
    const char* name = "backtrace_sand_velocity";
    const int stage = compute::find_stage(name);
    const auto& info = compute::stage_table()[static_cast<std::size_t>(stage)];
    const std::vector<std::uint32_t> zeros(4096, 0);
    std::vector<Buffer> buffers; // the stage's own, then five lists
    for (std::size_t n = 0; n < info.bindings.size() + 5; ++n) buffers.push_back(buffer_of(device, zeros));
    auto shared = device.create_buffer({64, "shared", compute::HostAccess::upload});
    const auto own = buffers.begin() + static_cast<std::ptrdiff_t>(info.bindings.size());
    const compute::ActiveTiles lists{own[0], own[1], own[2], own[3], own[4]};
    WorldParams params = small_params();
    params.tile_size = 16;
    const auto with = [&](compute::GroupSize group, const WorldParams& p, const compute::ActiveTiles& tiles) {
        auto pipeline = device.create_pipeline(stage, 0, group);
        expect.ok(pipeline.status(), "create_pipeline");
        ProgramBuilder builder("tiles");
        builder.dispatch(
            {pipeline ? *pipeline : compute::Pipeline{}, stage, 0, {buffers.begin(), own}, {0, 0, 4, 4}, "trace", tiles});
        return device.compile(builder, p);
    };
    const auto refuse = [&](compute::GroupSize group, const WorldParams& p, const compute::ActiveTiles& tiles,
                            const std::string& words) {
        expect.refused(with(group, p, tiles).status(), "program 'tiles', dispatch 'trace' of " + std::string(name) + words,
                       "compile");
    };
    auto program = with({0, 0, 16}, params, lists);
    expect.ok(program.status(), "a dispatch over active tiles");
    if (program) device.destroy_program(*program);
    refuse({}, params, lists,
           ": the pipeline was made to run without active tiles, the dispatch runs over active tiles of 16 cells");
    refuse({0, 0, 16}, params, {},
           ": the pipeline was made to run over active tiles of 16 cells, the dispatch runs without active tiles");
    refuse({0, 0, 32}, params, lists,
           ": the pipeline was made to run over active tiles of 32 cells, the dispatch runs over active tiles of 16 cells");
    WorldParams none = params;
    none.tile_size = 0;
    refuse({0, 0, 16}, none, lists, ": the parameters have active tiles of 0 cells");
    for (auto list : {&compute::ActiveTiles::activity, &compute::ActiveTiles::flags, &compute::ActiveTiles::counts,
                      &compute::ActiveTiles::list, &compute::ActiveTiles::dispatch}) {
        auto changed = lists;
        if (list != &compute::ActiveTiles::activity) { // null there means no tiles
            changed.*list = {};
            refuse({0, 0, 16}, params, changed, ", lists of active tiles: the buffer is null");
        }
        changed.*list = never_made;
        refuse({0, 0, 16}, params, changed, ", lists of active tiles: no buffer has the handle 4000000000");
        changed.*list = shared ? *shared : Buffer{};
        refuse({0, 0, 16}, params, changed, ", lists of active tiles: buffer 'shared' is the host's memory");
    }
    const int rain = compute::find_stage("apply_rain");
    expect.refused(device.create_pipeline(rain, EFFECT_WATER, {0, 0, 16}).status(),
                   "stage apply_rain cannot run over active tiles of 16 cells", "create_pipeline");
    expect.refused(device.create_pipeline(stage, 0, {0, 0, -16}).status(), "cannot run over active tiles of -16 cells",
                   "create_pipeline");
    if (shared) device.destroy_buffer(*shared);
    for (const Buffer buffer : buffers) device.destroy_buffer(buffer);
}

void bad_transfers(Session&, Device& device, Expect& expect) {
    const Buffer a = buffer_of(device, std::vector<std::uint32_t>(16, 1)),
                 b = buffer_of(device, std::vector<std::uint32_t>(8, 2));
    const Buffer gone = buffer_of(device, {0});
    device.destroy_buffer(gone);
    const std::string no_gone = "no buffer has the handle " + std::to_string(gone.id);
    const auto copy = [&](compute::Copy c, const std::string& words) {
        ProgramBuilder builder("transfer");
        builder.copy(c);
        refuse_program(device, expect, builder, small_params(), "program 'transfer', copy: " + words);
    };
    constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
    copy({{}, b, 0, 0, 4}, "the buffer is null");
    copy({a, {}, 0, 0, 4}, "the buffer is null");
    copy({a, gone, 0, 0, 4}, no_gone);
    copy({gone, b, 0, 0, 4}, no_gone);
    copy({a, a, 0, 32, 4}, "from and to one buffer, 'test'");
    copy({a, b, 0, 0, 36}, "36 bytes at offset 0 reach past the 32 bytes of buffer 'test'");
    copy({b, a, 4, 0, 32}, "32 bytes at offset 4 reach past the 32 bytes of buffer 'test'");
    copy({a, b, most - 3, 0, 8}, "8 bytes at offset " + std::to_string(most - 3) + " reach past the 64 bytes of buffer 'test'");
    for (const Buffer buffer : {Buffer{}, gone}) {
        ProgramBuilder builder("transfer");
        builder.fill({buffer, 1});
        refuse_program(device, expect, builder, small_params(),
                       "program 'transfer', fill: " + (buffer.id == 0 ? "the buffer is null" : no_gone));
    }
    expect.that(words_of(device, b, 8) == std::vector<std::uint32_t>(8, 2), "a refused copy changed its target");
    device.destroy_buffer(a);
    device.destroy_buffer(b);
}

// A program outlives what it uses: each kind of operation, and a binding that does not exist.
void destroyed_buffers(Session&, Device& device, Expect& expect) {
    const auto check = [&](const char* what, Buffer victim, const ProgramBuilder& builder, bool refused) {
        auto program = device.compile(builder, small_params());
        expect.ok(program.status(), "compile");
        if (!program) return;
        expect.ok(device.submit(*program, StepInput{}).status(), "submit with all buffers");
        device.destroy_buffer(victim);
        const Status status = device.submit(*program, StepInput{}).status();
        if (!refused) expect.ok(status, what);
        const std::string handle = std::to_string(victim.id);
        if (refused)
            expect.refused(status, "submit: program 'outlives': its buffer with the handle " + handle + " was destroyed", what);
        device.destroy_program(*program);
    };
    const Buffer kept = buffer_of(device, {1, 2});
    for (const bool from : {true, false}) {
        const Buffer victim = buffer_of(device, {3, 4});
        ProgramBuilder builder("outlives");
        builder.copy(from ? compute::Copy{victim, kept, 0, 0, 8} : compute::Copy{kept, victim, 0, 0, 8});
        check("a copy", victim, builder, true);
    }
    Buffer victim = buffer_of(device, {5});
    ProgramBuilder fill("outlives");
    fill.fill({kept, 1});
    fill.fill({victim, 1});
    check("a fill", victim, fill, true);
    const Rain rain(device);
    auto dispatch = rain_dispatch(device, rain.terrain, rain.water, rain.ledger);
    expect.ok(dispatch.status(), "create_pipeline");
    if (!dispatch) return;
    victim = dispatch->slots[3] = buffer_of(device, {6});
    ProgramBuilder absent("outlives");
    absent.dispatch(*dispatch);
    check("a dispatch whose binding does not exist", victim, absent, false);
    victim = rain.water;
    ProgramBuilder present("outlives");
    present.dispatch(*dispatch);
    check("a dispatch", victim, present, true);
    device.destroy_buffer(kept);
}

// A submission that is still running when it is asked for its times, where the device is slow enough to be caught at it.
void early_timings(Session&, Device& device, Expect& expect) {
    const Buffer a = buffer_of(device, std::vector<std::uint32_t>(1u << 22, 1)),
                 b = buffer_of(device, std::vector<std::uint32_t>(1u << 22, 2));
    ProgramBuilder builder("long");
    builder.timestamp("start");
    for (int n = 0; n < 10; ++n) {
        builder.copy({a, b, 0, 0, std::uint64_t{4} << 22});
        builder.copy({b, a, 0, 0, std::uint64_t{4} << 22});
    }
    builder.timestamp("copies");
    auto program = device.compile(builder, small_params());
    if (!program) return expect.ok(program.status(), "compile");
    auto ticket = device.submit(*program, StepInput{});
    if (!ticket) return expect.ok(ticket.status(), "submit");
    const Status early = device.timings(*ticket).status();
    if (!device.finished(*ticket))
        expect.refused(early, "ticket " + std::to_string(ticket->value) + " has not finished; wait for it first", "timings");
    expect.ok(device.wait(*ticket), "wait");
    device.destroy_program(*program);
    device.destroy_buffer(a);
    device.destroy_buffer(b);
}

} // namespace

std::span<const Contract> refusal_contracts() {
    static constexpr Contract contracts[] = {
        {"bad_dispatches", bad_dispatches},       {"bad_tiles", bad_tiles},         {"bad_transfers", bad_transfers},
        {"destroyed_buffers", destroyed_buffers}, {"early_timings", early_timings},
    };
    return contracts;
}

} // namespace wadi::conformance
