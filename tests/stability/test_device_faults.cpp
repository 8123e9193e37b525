// Every call to a device fails once, with out_of_memory or as a lost device: the caller is told, everything is freed, and after a
// lack of memory the world can be used on or made again.
#include "backends/registry.hpp"
#include "tests/stability/quality.hpp"
#include <set>

using namespace wadi;
using namespace wadi::test;
using compute::Device;

namespace {

/// Forwards to a device that outlives it; the call with number `fail_at` fails.
class FaultyDevice final : public Device {
  public:
    struct Plan {
        int fail_at = 0; // counting from 1; 0 = none
        Code code = Code::out_of_memory;
        int calls = 0, live = 0; // calls that could fail; buffers and programs that were not destroyed
        bool lost = false;
    };
    FaultyDevice(Device& device, Plan& plan) : device_(device), plan_(plan) {}
    // What a world leaves goes with its device.
    ~FaultyDevice() override {
        for (const auto id : programs_) device_.destroy_program({id});
        for (const auto id : buffers_) device_.destroy_buffer({id});
        plan_.live = 0;
    }

    const compute::Capabilities& capabilities() const override { return device_.capabilities(); }
    const compute::Tuning& tuning() const override { return device_.tuning(); }
    compute::DeviceCounters counters() const override { return device_.counters(); }
    Result<compute::Buffer> create_buffer(const compute::BufferDesc& desc) override {
        if (auto status = fault(); !status) return status;
        auto made = device_.create_buffer(desc);
        if (made) buffers_.insert(made->id);
        count();
        return made;
    }
    std::span<std::byte> mapped(compute::Buffer buffer) override { return device_.mapped(buffer); }
    void destroy_buffer(compute::Buffer buffer) override {
        buffers_.erase(buffer.id);
        device_.destroy_buffer(buffer);
        count();
    }
    Status write(compute::Buffer buffer, std::uint64_t offset, std::span<const std::byte> bytes) override {
        auto status = fault();
        return status ? device_.write(buffer, offset, bytes) : status;
    }
    Status read(compute::Buffer buffer, std::uint64_t offset, std::span<std::byte> bytes) override {
        auto status = fault();
        return status ? device_.read(buffer, offset, bytes) : status;
    }
    Result<compute::Pipeline> create_pipeline(int stage, std::uint32_t effects, compute::GroupSize group) override {
        if (auto status = fault(); !status) return status;
        return device_.create_pipeline(stage, effects, group);
    }
    Result<compute::Program> compile(const compute::ProgramBuilder& builder, const WorldParams& params) override {
        if (auto status = fault(); !status) return status;
        auto made = device_.compile(builder, params);
        if (made) programs_.insert(made->id);
        count();
        return made;
    }
    void destroy_program(compute::Program program) override {
        programs_.erase(program.id);
        device_.destroy_program(program);
        count();
    }
    Result<compute::Ticket> submit_inputs(compute::Program program, std::span<const StepInput> inputs) override {
        if (auto status = fault(); !status) return status;
        return device_.submit_inputs(program, inputs);
    }
    bool finished(compute::Ticket ticket) override { return device_.finished(ticket); }
    Status wait(compute::Ticket ticket) override {
        auto status = fault();
        return status ? device_.wait(ticket) : status;
    }
    Result<std::vector<compute::Timing>> timings(compute::Ticket ticket) override { return device_.timings(ticket); }
    Result<compute::NativeBuffer> native(compute::Buffer buffer) override { return device_.native(buffer); }
    void inject_device_lost() override { plan_.lost = true; }

  private:
    Status fault() {
        if (plan_.lost) return error(Code::device_lost, "injected");
        if (++plan_.calls != plan_.fail_at) return ok_status();
        plan_.lost = plan_.code == Code::device_lost;
        return error(plan_.code, "injected");
    }
    void count() { plan_.live = static_cast<int>(buffers_.size() + programs_.size()); }

    Device& device_;
    Plan& plan_;
    std::set<std::uint32_t> buffers_, programs_;
};

Edit pour(EditLayer layer) {
    Edit edit;
    edit.layer = layer;
    edit.x0 = edit.y0 = 1;
    edit.radius = 0.8;
    edit.amount = 0.2;
    return edit;
}

/// Everything that talks to a device: making, stepping, a promotion, outputs, queries, saves, roll-back. `note` hears each
/// result, and what the log says where no call can.
template <class Note> void session(Device& device, FaultyDevice::Plan& plan, Note note) {
    auto scene = flat_scene(9, 7, 0.25, 0.02);
    scene.fill(scene.fields.water, [](double x, double) { return x < 1 ? 0.6 : 0.1; });
    auto made = World::create(scene.settings, scene.fields, std::make_unique<FaultyDevice>(device, plan));
    note(made.status());
    if (!made) return;
    World& world = **made;
    note(world.set_log([&](int severity, const std::string& message) {
        if (severity == 1 && message.find("for roll-back") != std::string::npos) note(error(Code::out_of_memory, message));
    }));
    note(world.roll_back().set(2, 1));
    note(world.outputs().set_mask(1));
    note(world.step(2));
    const Edit edits[] = {pour(EditLayer::sand), pour(EditLayer::water)};
    if (plan.lost) return; // an edit is only queued
    note(world.commands().edit(edits));
    note(world.step(2));
    Frame frame;
    note(world.update(50'000'000, frame));
    std::vector<std::byte> bytes(world.snapshots().bytes());
    const auto saved = world.snapshots().save(bytes);
    note(saved);
    note(world.step(1));
    if (saved) note(world.snapshots().load(bytes));
    std::vector<float> cells(9 * 7);
    note(world.reader().read("free_surface", cells));
    const auto stats = world.reader().stats();
    note(stats.status());
    if (stats) CHECK(ledger_holds(world, *stats)); // after a lack of memory too
    note(world.commands().write_region(EditLayer::sand, {1, 1, 2, 2}, std::vector<float>(4, 0.1F)));
    note(world.step(1));
}

} // namespace

TEST_CASE("every device call fails in turn: out of memory or lost, it is told and all is freed") {
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto device = backends::open_device(backend, -1, {});
        REQUIRE(device);
        for (const Code code : {Code::out_of_memory, Code::device_lost}) {
            FaultyDevice::Plan whole;
            std::string trouble;
            session(**device, whole, [&](const Status& status) { trouble += status.message; });
            CHECK_MESSAGE(trouble.empty(), trouble); // nothing fails without a fault
            CHECK(whole.calls > 100);
            const int stride = backend == "cpu" ? 1 : 7;
            int silent = 0, wrong = 0;
            for (int n = 1; n <= whole.calls; n += stride) {
                FaultyDevice::Plan plan;
                plan.fail_at = n;
                plan.code = code;
                int failures = 0;
                bool ended = false; // a lost device: every later call says so
                session(**device, plan, [&](const Status& status) {
                    if (status && ended) ++wrong;
                    if (status) return;
                    ++failures;
                    if (status.code != code) ++wrong;
                    ended = code == Code::device_lost;
                });
                if (failures == 0) ++silent;
                CHECK(plan.live == 0);
            }
            CHECK(wrong == 0);
            CHECK(silent == 0);
        }
        // The device is as good as before.
        FaultyDevice::Plan plan;
        session(**device, plan, [](const Status& status) { CHECK_MESSAGE(status, status.message); });
    }
}

TEST_CASE("a pipeline for effects that no world has together is refused by the CPU, which has no code for it") {
    auto device = backends::open_device("cpu", -1, {});
    REQUIRE(device);
    const int stage = compute::find_stage("integrate_water_velocity");
    const std::uint32_t rough = EFFECT_ROUGHNESS; // of no bed that has friction
    const auto made = (*device)->create_pipeline(stage, rough, {});
    CHECK(made.status().code == Code::internal);
    CHECK(made.status().message.find("stage integrate_water_velocity has no code") != std::string::npos);
    CHECK((*device)->create_pipeline(stage, EFFECT_ROUGHNESS | EFFECT_BED_FRICTION, {}));
    CHECK((*device)->create_pipeline(stage, EFFECT_SECOND_ORDER_WATER, {}));
}

TEST_CASE("a written region or a trim that fails half way changes nothing: state and books are what they were") {
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto device = backends::open_device(backend, -1, {});
        REQUIRE(device);
        auto scene = mixed_scene(24, 19);
        scene.settings.sides[SIDE_EAST] = {SideKind::outflow, 0, 1e30, {}};
        const std::vector<float> heights(12, 0.75F);
        const Region region{5, 4, 4, 3};
        const auto drift = [](World& world) {
            const auto stats = world.reader().stats();
            REQUIRE(stats);
            const auto off = [](std::int64_t held, std::int64_t initial, std::int64_t in, std::int64_t out) {
                return held - initial - in + out;
            };
            return std::pair{off(stats->sand_quanta, stats->sand_initial, stats->ledger.sand_in, stats->ledger.sand_out),
                             off(stats->water_quanta, stats->water_initial, stats->ledger.water_in, stats->ledger.water_out)};
        };
        const auto run = [&](FaultyDevice::Plan& plan, int what, int fail_at) {
            auto made = World::create(scene.settings, scene.fields, std::make_unique<FaultyDevice>(**device, plan), {});
            REQUIRE(made);
            World& world = **made;
            step(world, 3);
            const auto before = state_of(world);
            const int first = plan.calls;
            plan.fail_at = fail_at == 0 ? 0 : plan.calls + fail_at;
            const auto layer = what == 0 ? EditLayer::terrain : what == 1 ? EditLayer::sand : EditLayer::water;
            const auto status = what == 3 ? world.commands().trim() : world.commands().write_region(layer, region, heights);
            plan.fail_at = 0;
            const int calls = plan.calls - first;
            CHECK(drift(world) == std::pair<std::int64_t, std::int64_t>{0, 0});
            if (!status) CHECK(state_of(world) == before);
            if (fail_at == 0 && what < 3) CHECK(state_of(world) != before); // negative control
            CHECK(static_cast<bool>(status) == (fail_at == 0));
            REQUIRE(world.stepper().steps(2));
            return calls;
        };
        for (int what = 0; what < 4; ++what) {
            CAPTURE(what);
            FaultyDevice::Plan whole;
            const int calls = run(whole, what, 0);
            CHECK(calls >= 4);
            for (int n = 1; n <= calls; n += backend == "cpu" ? 1 : 7) {
                CAPTURE(n);
                FaultyDevice::Plan plan;
                run(plan, what, n);
            }
        }
    }
}

TEST_CASE("an update that fails has not taken the time: repeated, it takes what steps are left of it") {
    auto device = backends::open_device("cpu", -1, {});
    REQUIRE(device);
    auto scene = flat_scene(9, 7, 0.25, 0.01);
    scene.fill(scene.fields.water, [](double x, double) { return x < 1 ? 0.6 : 0.1; });
    const auto run = [&](FaultyDevice::Plan& plan, int fail_at) {
        auto made = World::create(scene.settings, scene.fields, std::make_unique<FaultyDevice>(**device, plan), {});
        REQUIRE(made);
        World& world = **made;
        REQUIRE(world.outputs().set_mask(1));
        const Edit edits[] = {pour(EditLayer::sand)}; // promotes the world in the first step
        REQUIRE(world.commands().edit(edits));
        const int first = plan.calls;
        plan.fail_at = fail_at == 0 ? 0 : first + fail_at;
        Frame frame;
        const auto status = world.update(35'000'000, frame);
        plan.fail_at = 0;
        const int calls = plan.calls - first;
        if (!status) REQUIRE(world.update(35'000'000, frame));
        CHECK(world.steps() == 3);
        REQUIRE(world.update(5'000'000, frame)); // 40 ms in all
        CHECK(world.steps() == 4);
        CHECK(static_cast<bool>(status) == (fail_at == 0));
        return calls;
    };
    FaultyDevice::Plan whole;
    const int calls = run(whole, 0);
    CHECK(calls > 4);
    for (int n = 1; n <= calls; ++n) {
        CAPTURE(n);
        FaultyDevice::Plan plan;
        run(plan, n);
    }
}
