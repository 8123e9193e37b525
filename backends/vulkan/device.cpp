#include "backends/vulkan/device.hpp"
#include "backends/vulkan/program.hpp"
#include "backends/vulkan/self_test.hpp"
#include <new>

namespace wadi::vulkan {
namespace {

// No exception leaves the interface; the only one that this backend's own code can meet is a failed host allocation.
template <class Call> auto guarded(Call call) -> decltype(call()) {
    try {
        return call();
    } catch (const std::bad_alloc&) {
        return error(Code::out_of_memory, "out of memory"); // short enough to need none
    }
}

class VulkanDevice final : public compute::Device {
  public:
    explicit VulkanDevice(std::unique_ptr<Context> context) : context_(std::move(context)) {}

    ~VulkanDevice() override { context_->wait_idle(); }

    Status open() {
        if (Status s = once_.open(); !s) return s;
        if (Status s = transfers_.open(); !s) return s;
        if (Status s = buffers_.open(); !s) return s;
        if (Status s = pipelines_.open(); !s) return s;
        if (Status s = submissions_.open(); !s) return s;
        return run_self_test(*context_, once_, transfers_);
    }

    const compute::Capabilities& capabilities() const override { return context_->capabilities; }

    compute::DeviceCounters counters() const override {
        compute::DeviceCounters counters = context_->counters;
        counters.validation_messages = context_->instance->messages().validation;
        return counters;
    }

    Result<compute::Buffer> create_buffer(const compute::BufferDesc& desc) override {
        return unless_lost<Result<compute::Buffer>>([&] { return buffers_.create(desc); });
    }

    std::span<std::byte> mapped(compute::Buffer buffer) override { return buffers_.mapped(buffer); }

    void destroy_buffer(compute::Buffer buffer) override {
        if (buffer.id == 0) return;
        if (recorded_in_flight()) {
            doomed_buffers_.push_back(buffer);
            return;
        }
        context_->wait_idle();
        buffers_.destroy(buffer);
    }

    Status write(compute::Buffer buffer, std::uint64_t offset, std::span<const std::byte> bytes) override {
        return unless_lost<Status>([&] {
            Status order = submissions_.check_order();
            return order ? buffers_.write(buffer, offset, bytes) : order;
        });
    }

    Status read(compute::Buffer buffer, std::uint64_t offset, std::span<std::byte> bytes) override {
        return unless_lost<Status>([&] {
            Status order = submissions_.check_order();
            return order ? buffers_.read(buffer, offset, bytes) : order;
        });
    }

    Result<compute::Pipeline> create_pipeline(int stage, std::uint32_t effects, compute::GroupSize group) override {
        return unless_lost<Result<compute::Pipeline>>([&] { return pipelines_.create(stage, effects, group); });
    }

    Result<compute::Program> compile(const compute::ProgramBuilder& builder, const WorldParams& params) override {
        return unless_lost<Result<compute::Program>>([&]() -> Result<compute::Program> {
            const ProgramParts parts{*context_, transfers_, buffers_, pipelines_, submissions_};
            auto program = CompiledProgram::compile(parts, builder, params);
            if (!program) return program.status();
            programs_.push_back(std::move(*program));
            return compute::Program{static_cast<std::uint32_t>(programs_.size())};
        });
    }

    void destroy_program(compute::Program program) override {
        if (find(program) == nullptr) return;
        auto& owner = programs_[program.id - 1];
        if (recorded_in_flight()) {
            doomed_programs_.push_back(std::move(owner));
        } else {
            owner.reset(); // waits for the queue
        }
    }

    Result<compute::Ticket> submit(compute::Program program, const StepInput& input) override {
        return unless_lost<Result<compute::Ticket>>([&]() -> Result<compute::Ticket> {
            CompiledProgram* compiled = find(program);
            if (compiled == nullptr)
                return error(Code::bad_argument, "submit: no program has the handle " + std::to_string(program.id));
            if (!submissions_.recording()) {
                if (Status s = submissions_.check_order(); !s) return s;
                destroy_doomed();
            }
            auto slot = submissions_.acquire();
            if (!slot) return slot.status();
            auto commands = submissions_.recording() ? compiled->secondary_for(*slot)
                                                     : compiled->commands_for(*slot, submissions_.own_commands(*slot));
            if (!commands) return commands.status();
            return submissions_.submit(*slot, input, *commands, program);
        });
    }

    /// True on a lost device too: nothing is going to run any more.
    bool finished(compute::Ticket ticket) override {
        if (context_->lost) return true;
        auto done = guarded([&] { return submissions_.finished(ticket); });
        return done ? *done : context_->lost;
    }

    Status wait(compute::Ticket ticket) override {
        return unless_lost<Status>([&] { return submissions_.wait(ticket); });
    }

    Result<std::vector<compute::Timing>> timings(compute::Ticket ticket) override {
        using Timings = std::vector<compute::Timing>;
        return unless_lost<Result<Timings>>([&]() -> Result<Timings> {
            auto done = submissions_.finished(ticket);
            if (!done) return done.status();
            if (!*done)
                return error(Code::bad_argument,
                             "ticket " + std::to_string(ticket.value) + " has not finished; wait for it first");
            CompiledProgram* compiled = find(submissions_.program_of(ticket));
            return compiled == nullptr ? Result<Timings>(Timings{}) : compiled->timings(Submissions::slot_of(ticket.value));
        });
    }

    Result<compute::NativeBuffer> native(compute::Buffer buffer) override {
        const Memory* memory = buffers_.find(buffer);
        if (memory == nullptr) return error(Code::bad_argument, "native: no buffer has the handle " + std::to_string(buffer.id));
        return compute::NativeBuffer{compute::NativeBuffer::Kind::vulkan_buffer, reinterpret_cast<std::uintptr_t>(memory->buffer),
                                     memory->bytes};
    }

    Status wait_before(std::span<const compute::SyncPoint> points) override {
        return unless_lost<Status>([&] { return submissions_.wait_before(points); });
    }

    Status signal_after(const compute::SyncPoint& point) override {
        return unless_lost<Status>([&] { return submissions_.signal_after(point); });
    }

    Status begin_recording(void* commands, const compute::SyncPoint& promise) override {
        return unless_lost<Status>([&] { return submissions_.begin_recording(static_cast<VkCommandBuffer>(commands), promise); });
    }

    Status end_recording() override {
        return unless_lost<Status>([&] { return submissions_.end_recording(); });
    }

    void inject_device_lost() override { context_->lost = true; }

  private:
    template <class R, class Call> R unless_lost(Call call) {
        if (context_->lost) return guarded([&] { return R(context_->lost_status()); });
        return guarded([&] { return R(call()); });
    }

    // The host's command buffers may refer to anything that was alive when they were recorded.
    bool recorded_in_flight() { return !context_->lost && submissions_.check_order().code == Code::not_ready; }

    void destroy_doomed() {
        if (doomed_buffers_.empty() && doomed_programs_.empty()) return;
        context_->wait_idle();
        for (const compute::Buffer buffer : doomed_buffers_) buffers_.destroy(buffer);
        doomed_buffers_.clear();
        doomed_programs_.clear();
    }

    CompiledProgram* find(compute::Program program) const {
        return program.id == 0 || program.id > programs_.size() ? nullptr : programs_[program.id - 1].get();
    }

    // Destroyed from the last to the first.
    std::unique_ptr<Context> context_;
    OneTimeCommands once_{*context_};
    Transfers transfers_{*context_, once_};
    Buffers buffers_{*context_, transfers_};
    Pipelines pipelines_{*context_};
    Submissions submissions_{*context_};
    std::vector<std::unique_ptr<CompiledProgram>> programs_; // handle id - 1 is the place; ids are never used again
    // Destroyed once recorded work that may use them has run.
    std::vector<std::unique_ptr<CompiledProgram>> doomed_programs_;
    std::vector<compute::Buffer> doomed_buffers_;
};

} // namespace

Result<std::unique_ptr<compute::Device>> open_device(int index, const compute::DeviceOptions& options) {
    using Opened = Result<std::unique_ptr<compute::Device>>;
    return guarded([&]() -> Opened {
        auto context = Context::open(index, options);
        if (!context) return context.status();
        auto device = std::make_unique<VulkanDevice>(std::move(*context));
        if (Status s = device->open(); !s) return s;
        return Opened(std::unique_ptr<compute::Device>(std::move(device)));
    });
}

} // namespace wadi::vulkan
