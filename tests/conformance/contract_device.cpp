// The device as a whole: capabilities, loss, several devices, planned barriers, group sizes, and steps that allocate nothing.
#include "engine/step/plan/world_params.hpp"
#include "tests/conformance/compare.hpp"
#include "tests/conformance/contracts.hpp"
#include "tests/conformance/masks.hpp"
#include "tests/conformance/stage_inputs.hpp"
#include "tests/conformance/worlds.hpp"
#include <algorithm>

namespace wadi::conformance {

namespace {

using compute::Buffer;
using compute::Device;
using compute::ProgramBuilder;

constexpr auto lost = {Code::device_lost};

void capabilities(Session& session, Device& device, Expect& expect) {
    const auto& c = device.capabilities();
    expect.that(c.backend == session.target().info.backend, "capabilities().backend is " + c.backend);
    expect.that(!c.name.empty() && !c.driver.empty(), "a device without a name or driver");
    expect.that(c.kind == session.target().info.kind, "capabilities().kind is not what enumerate said");
    expect.code(backends::open_device(c.backend, 1000, {}).status(), {Code::not_found}, "device 1000 of " + c.backend);
    auto unknown = backends::open_device("abacus", -1, {});
    expect.code(unknown.status(), {Code::not_found}, "backend \"abacus\"");
    expect.that(unknown.status().message.find("cpu") != std::string::npos, "the message does not list the known backends");
}

void device_lost(Session& session, Device&, Expect& expect) {
    auto opened = session.fresh(session.options());
    if (!opened) return expect.ok(opened.status(), "open");
    Device& device = **opened;
    const Buffer buffer = buffer_of(device, std::vector<std::uint32_t>(64, 1));
    ProgramBuilder builder("fill");
    builder.fill({buffer, 2});
    auto program = device.compile(builder, small_params());
    if (!program) return expect.ok(program.status(), "compile");
    auto ticket = device.submit(*program, StepInput{});
    if (!ticket) return expect.ok(ticket.status(), "submit");
    device.inject_device_lost();
    std::vector<std::byte> bytes(4);
    for (int n = 0; n < 2; ++n) {
        expect.code(device.create_buffer({64, "after"}).status(), lost, "create_buffer");
        expect.code(device.write(buffer, 0, bytes), lost, "write");
        expect.code(device.read(buffer, 0, bytes), lost, "read");
        expect.code(device.create_pipeline(0, 0, {}).status(), lost, "create_pipeline");
        expect.code(device.compile(builder, small_params()).status(), lost, "compile");
        expect.code(device.submit(*program, StepInput{}).status(), lost, "submit");
        expect.code(device.wait(*ticket), lost, "wait");
        expect.code(device.timings(*ticket).status(), lost, "timings");
        expect.that(!device.capabilities().name.empty(), "a lost device has no capabilities");
        expect.that(device.finished({ticket->value + 1}), "on a lost device something is still going to finish");
    }
    device.destroy_program(*program);
    device.destroy_buffer(buffer);
}

void world_after_loss(Session& session, Device&, Expect& expect) {
    auto scene = make_scene("33x17", "dam_break", "default", EFFECT_WATER);
    auto world = scene ? open_world(session, *scene, session.options()) : Result<std::unique_ptr<World>>(scene.status());
    if (!world) return expect.ok(world.status(), "a World");
    expect.ok((*world)->step(3), "step");
    (*world)->device().inject_device_lost();
    std::vector<float> field(33 * 17);
    expect.code((*world)->step(1), lost, "step of a World whose device is lost");
    expect.code((*world)->reader().read("water_height", field), lost, "read of a World whose device is lost");
    expect.code((*world)->reader().stats().status(), lost, "stats of a World whose device is lost");
    auto after = open_world(session, *scene, session.options());
    expect.ok(after.status(), "a World on a device opened anew");
    if (after) expect.ok((*after)->step(1), "step on a device opened anew");
}

void two_devices(Session& session, Device&, Expect& expect) {
    auto a = session.fresh(session.options()), b = session.fresh(session.options());
    expect.ok(a.status(), "the first device");
    expect.ok(b.status(), "the second device");
    if (!a || !b) return;
    const Buffer on_a = buffer_of(**a, {1, 2, 3}), on_b = buffer_of(**b, {4, 5, 6});
    a->reset();
    expect.that(on_a.id != 0 && words_of(**b, on_b, 3) == std::vector<std::uint32_t>{4, 5, 6},
                "closing one device disturbs another");
}

// A program whose operations read and write a few buffers in every order, the same on the device, on the device with a barrier
// before every operation, and on the CPU.
class RandomProgram {
  public:
    explicit RandomProgram(std::uint32_t seed) : state_(seed) {}

    Result<std::vector<std::uint32_t>> run(Device& device) {
        const WorldParams params = small_params();
        const FieldLayout layout{params.nx, params.ny};
        std::vector<Buffer> buffers;
        for (std::uint32_t n = 0; n < 7; ++n) {
            std::vector<float> values(layout.size(), 0.0F);
            for (int j = 0; j < layout.ny; ++j)
                for (int i = 0; i < layout.nx; ++i) values[layout.index(i, j)] = band_limited(n, i, j);
            auto made = device.create_buffer({values.size() * 4, "random"});
            if (!made) return made.status();
            if (auto status = device.write(*made, 0, std::as_bytes(std::span(values))); !status) return status;
            buffers.push_back(*made);
        }
        ProgramBuilder builder("random");
        for (int n = 0; n < 300; ++n) {
            if (auto status = add(device, builder, buffers, params, layout); !status) return status;
        }
        if (auto status = run_once(device, builder); !status) return status;
        std::vector<std::uint32_t> all;
        for (const Buffer buffer : buffers) {
            const auto words = words_of(device, buffer, layout.size());
            all.insert(all.end(), words.begin(), words.end());
            device.destroy_buffer(buffer);
        }
        return all;
    }

  private:
    std::uint32_t next(std::uint32_t below) {
        state_ = state_ * 1664525u + 1013904223u;
        return (state_ >> 8) % below;
    }

    Status add(Device& device, ProgramBuilder& builder, const std::vector<Buffer>& buffers, const WorldParams& params,
               const FieldLayout& layout) {
        std::vector<Buffer> shuffled = buffers;
        for (std::size_t n = shuffled.size(); n > 1; --n)
            std::swap(shuffled[n - 1], shuffled[next(static_cast<std::uint32_t>(n))]);
        const std::uint32_t kind = next(10);
        if (kind == 0) {
            builder.fill({shuffled[0], 0});
        } else if (kind < 3) {
            const std::uint32_t half = static_cast<std::uint32_t>(layout.size()) * 2;
            builder.copy({shuffled[0], shuffled[1], next(half / 4) * 4, next(half / 4) * 4, half});
        } else {
            const char* name = kind < 6 ? "publish_velocity" : "integrate_sand_height";
            const int stage = compute::find_stage(name);
            auto pipeline = device.create_pipeline(stage, EFFECT_SAND, {});
            if (!pipeline) return pipeline.status();
            builder.dispatch({*pipeline,
                              stage,
                              EFFECT_SAND,
                              {shuffled[0], shuffled[1], shuffled[2], shuffled[3]},
                              compute::extent_range(compute::Extent::cells, params),
                              name});
        }
        return ok_status();
    }

    std::uint32_t state_;
};

void planned_barriers(Session& session, Device& device, Expect& expect) {
    auto cpu = open_plain_cpu();
    auto options = session.options();
    options.full_barriers = !options.full_barriers;
    auto other = session.fresh(options);
    if (!cpu) return expect.ok(cpu.status(), "open the CPU");
    if (!other) return expect.ok(other.status(), "open with other barriers");
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
        auto expected = RandomProgram(seed).run(**cpu), got = RandomProgram(seed).run(device),
             barriers = RandomProgram(seed).run(**other);
        expect.ok(expected.status(), "a random program on the CPU");
        expect.ok(got.status(), "a random program");
        expect.ok(barriers.status(), "a random program with other barriers");
        if (!expected || !got || !barriers) return;
        const std::string which = " of random program " + std::to_string(seed);
        expect.that(*got == *barriers, "a barrier before every operation changes the result" + which);
        if (device.capabilities().exact_float) expect.that(*got == *expected, "the result is not the CPU's" + which);
    }
}

void group_sizes(Session&, Device& device, Expect& expect) {
    for (const char* name : {"integrate_water_velocity", "compute_saturation", "account_sides", "apply_sources"}) {
        const int stage = compute::find_stage(name);
        const auto& info = compute::stage_table()[static_cast<std::size_t>(stage)];
        auto scene = make_scene("65x3", "random", "default", stage_masks(stage).back());
        if (!scene) return expect.ok(scene.status(), "a scene");
        const Pilot pilot = make_pilot(*scene, name);
        const WorldParams params = derive_params(scene->settings, scene->effects);
        std::vector<BenchBuffer> first;
        for (const compute::GroupSize group : {compute::GroupSize{0, 0}, {1, 1}, {8, 8}, {128, 1}, {3, 5}}) {
            auto buffers = stage_buffers(info, *scene, pilot, params);
            expect.ok(run_bench(device, stage, scene->effects, params, pilot.input, group, buffers),
                      "group size " + std::to_string(group.x) + " x " + std::to_string(group.y));
            if (first.empty()) first = buffers;
            for (std::size_t b = 0; b < buffers.size(); ++b)
                expect.that(buffers[b].after == first[b].after, std::string(name) + ": group size " + std::to_string(group.x) +
                                                                    " x " + std::to_string(group.y) + " changes a bit");
        }
        const bool groups = device.capabilities().groups.threads > 0;
        for (const compute::GroupSize group :
             {compute::GroupSize{-1, 1}, {1, -1}, {1 << 20, 1}, {1, 1 << 20}, {1 << 15, 1 << 15}}) {
            const auto made = device.create_pipeline(stage, scene->effects, group);
            if (groups || group.x < 0 || group.y < 0) {
                expect.refused(made.status(),
                               "group size of stage " + std::string(name) + " is " + std::to_string(group.x) + " x " +
                                   std::to_string(group.y),
                               "create_pipeline");
            } else {
                expect.ok(made.status(), "any group size on a device that has no groups");
            }
        }
    }
}

void steps_allocate_nothing(Session& session, Device&, Expect& expect) {
    auto scene = make_scene("33x17", "slope", "default", stage_masks(compute::find_stage("mark_limits")).back());
    if (!scene) return expect.ok(scene.status(), "a scene");
    auto world = open_world(session, *scene);
    if (!world) return expect.ok(world.status(), "a World");
    for (const std::uint32_t steps : {8u, 1u, 8u, 1u}) expect.ok((*world)->step(steps), "step"); // all programs are recorded
    const auto before = (*world)->device().counters();
    for (int n = 0; n < 40; ++n) expect.ok((*world)->step(1), "step");
    expect.ok((*world)->step(40), "step");
    const auto after = (*world)->device().counters();
    expect.that(after.allocations == before.allocations, "a step allocates");
    expect.that(after.descriptor_writes == before.descriptor_writes, "a step writes descriptors");
    expect.that(after.recordings == before.recordings || session.options().no_replay, "a step records anew");
    expect.that(after.submits == before.submits + 40 + 40 / Stepper::run_steps, "a step or a run is not one submission");
}

// A host that loads one level after another.
void opened_again_and_again(Session& session, Device&, Expect& expect) {
    for (int n = 0; n < 32; ++n) {
        auto fresh = session.fresh({});
        expect.ok(fresh.status(), "opening the device for the " + std::to_string(n + 1) + ". time");
        if (!fresh) return;
    }
}

} // namespace

std::span<const Contract> device_contracts() {
    static constexpr Contract contracts[] = {
        {"opened_again_and_again", opened_again_and_again},
        {"capabilities", capabilities},
        {"device_lost", device_lost},
        {"world_after_loss", world_after_loss},
        {"two_devices", two_devices},
        {"planned_barriers", planned_barriers},
        {"group_sizes", group_sizes},
        {"steps_allocate_nothing", steps_allocate_nothing},
    };
    return contracts;
}

} // namespace wadi::conformance
