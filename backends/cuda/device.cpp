#include "backends/cuda/device.hpp"
#include "backends/cuda/program.hpp"
#include "backends/cuda/self_test.hpp"
#include <new>

namespace wadi::cuda {
namespace {

// No exception leaves the interface; the only one that this backend's own code can meet is a failed host allocation.
template <class Call> auto guarded(Call call) -> decltype(call()) {
    try {
        return call();
    } catch (const std::bad_alloc&) {
        return error(Code::out_of_memory, "out of memory"); // short enough to need none
    }
}

class CudaDevice final : public compute::Device {
  public:
    explicit CudaDevice(std::unique_ptr<Context> context) : context_(std::move(context)) {}

    ~CudaDevice() override { context_->wait_idle(); }

    Status open() {
        const CurrentContext current(*context_);
        if (Status s = submissions_.open(); !s) return s;
        return run_self_test(*context_);
    }

    const compute::Capabilities& capabilities() const override { return context_->capabilities; }

    compute::DeviceCounters counters() const override { return context_->counters; }

    Result<compute::Buffer> create_buffer(const compute::BufferDesc& desc) override {
        return unless_lost<Result<compute::Buffer>>([&] { return buffers_.create(desc); });
    }

    std::span<std::byte> mapped(compute::Buffer buffer) override { return buffers_.mapped(buffer); }

    void destroy_buffer(compute::Buffer buffer) override {
        if (buffers_.find(buffer) == nullptr) return;
        const CurrentContext current(*context_);
        context_->wait_idle();
        buffers_.destroy(buffer);
    }

    Status write(compute::Buffer buffer, std::uint64_t offset, std::span<const std::byte> bytes) override {
        return unless_lost<Status>([&] { return buffers_.write(buffer, offset, bytes); });
    }

    Status read(compute::Buffer buffer, std::uint64_t offset, std::span<std::byte> bytes) override {
        return unless_lost<Status>([&] { return buffers_.read(buffer, offset, bytes); });
    }

    Result<compute::Pipeline> create_pipeline(int stage, std::uint32_t effects, compute::GroupSize group) override {
        return unless_lost<Result<compute::Pipeline>>([&] { return pipelines_.create(stage, effects, group); });
    }

    Result<compute::Program> compile(const compute::ProgramBuilder& builder, const WorldParams& params) override {
        return unless_lost<Result<compute::Program>>([&]() -> Result<compute::Program> {
            const ProgramParts parts{*context_, buffers_, pipelines_, submissions_};
            auto program = CompiledProgram::compile(parts, builder, params);
            if (!program) return program.status();
            programs_.push_back(std::move(*program));
            return compute::Program{static_cast<std::uint32_t>(programs_.size())};
        });
    }

    void destroy_program(compute::Program program) override {
        if (find(program) != nullptr) programs_[program.id - 1].reset(); // waits for the stream
    }

    Result<compute::Ticket> submit(compute::Program program, const StepInput& input) override {
        return unless_lost<Result<compute::Ticket>>([&]() -> Result<compute::Ticket> {
            CompiledProgram* compiled = find(program);
            if (compiled == nullptr)
                return error(Code::bad_argument, "submit: no program has the handle " + std::to_string(program.id));
            auto slot = submissions_.acquire();
            if (!slot) return slot.status();
            if (Status s = submissions_.begin(*slot, input); !s) return s;
            if (Status s = compiled->launch(*slot); !s) return s;
            return submissions_.finish(*slot, program);
        });
    }

    /// True on a lost device too: nothing is going to run any more.
    bool finished(compute::Ticket ticket) override {
        auto done = unless_lost<Result<bool>>([&] { return submissions_.finished(ticket); });
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
        if (const auto& lent = memory->borrowed.lent; lent.handle != 0)
            return compute::NativeBuffer{compute::NativeBuffer::Kind::vulkan_buffer, lent.handle, memory->bytes};
        return compute::NativeBuffer{compute::NativeBuffer::Kind::cuda_pointer, reinterpret_cast<std::uintptr_t>(memory->data),
                                     memory->bytes};
    }

    Status wait_before(std::span<const compute::SyncPoint> points) override {
        if (context_->options.lender == nullptr) return Device::wait_before(points);
        return unless_lost<Status>([&] { return semaphores_.wait(points); });
    }

    Status signal_after(const compute::SyncPoint& point) override {
        if (context_->options.lender == nullptr) return Device::signal_after(point);
        return unless_lost<Status>([&] { return semaphores_.signal(point); });
    }

    void inject_device_lost() override { context_->lose("injected"); }

  private:
    template <class R, class Call> R unless_lost(Call call) {
        return guarded([&] {
            if (context_->lost) return R(context_->lost_status());
            const CurrentContext current(*context_);
            return context_->lost ? R(context_->lost_status()) : R(call());
        });
    }

    CompiledProgram* find(compute::Program program) const {
        return program.id == 0 || program.id > programs_.size() ? nullptr : programs_[program.id - 1].get();
    }

    // Destroyed from the last to the first.
    std::unique_ptr<Context> context_;
    Semaphores semaphores_{*context_};
    Buffers buffers_{*context_};
    Pipelines pipelines_{*context_};
    Submissions submissions_{*context_};
    std::vector<std::unique_ptr<CompiledProgram>> programs_; // handle id - 1 is the place; ids are never used again
};

} // namespace

Result<std::unique_ptr<compute::Device>> open_device(int index, const compute::DeviceOptions& options) {
    using Opened = Result<std::unique_ptr<compute::Device>>;
    return guarded([&]() -> Opened {
        auto context = Context::open(index, options);
        if (!context) return context.status();
        auto device = std::make_unique<CudaDevice>(std::move(*context));
        if (Status s = device->open(); !s) return s;
        return Opened(std::unique_ptr<compute::Device>(std::move(device)));
    });
}

} // namespace wadi::cuda
