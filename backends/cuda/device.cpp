#include "backends/cuda/device.hpp"
#include "backends/cuda/host_order.hpp"
#include "backends/cuda/program.hpp"
#include "backends/cuda/self_test.hpp"

namespace wadi::cuda {
namespace {

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
    const compute::Tuning& tuning() const override { return context_->tuning; }

    compute::DeviceCounters counters() const override { return context_->counters; }

    Result<compute::Buffer> create_buffer(const compute::BufferDesc& desc) override {
        const CurrentContext current(*context_);
        return buffers_.create(desc);
    }

    std::span<std::byte> mapped(compute::Buffer buffer) override {
        const Memory& memory = *buffers_.find(buffer);
        return {memory.data, memory.bytes};
    }

    void destroy_buffer(compute::Buffer buffer) override {
        const CurrentContext current(*context_);
        context_->wait_idle();
        buffers_.destroy(buffer);
    }

    Status write(compute::Buffer buffer, std::uint64_t offset, std::span<const std::byte> bytes) override {
        const CurrentContext current(*context_);
        return copy_in(*context_, *buffers_.find(buffer), offset, bytes);
    }

    Status read(compute::Buffer buffer, std::uint64_t offset, std::span<std::byte> bytes) override {
        const CurrentContext current(*context_);
        return copy_out(*context_, *buffers_.find(buffer), offset, bytes);
    }

    Result<compute::Pipeline> create_pipeline(int stage, std::uint32_t effects, compute::GroupSize group) override {
        const CurrentContext current(*context_);
        return pipelines_.create(stage, effects, group);
    }

    Result<compute::Program> compile(const compute::ProgramBuilder& builder, const WorldParams& params) override {
        const CurrentContext current(*context_);
        const ProgramParts parts{*context_, buffers_, pipelines_, submissions_};
        programs_.reserve();
        auto program = CompiledProgram::compile(parts, builder, params);
        if (!program) return program.status();
        return compute::Program{programs_.add(std::move(*program))};
    }

    void destroy_program(compute::Program program) override { programs_.take(program.id); } // waits for the stream

    Result<compute::Ticket> submit_inputs(compute::Program program, std::span<const StepInput> inputs) override {
        const CurrentContext current(*context_);
        auto slot = submissions_.acquire();
        if (!slot) return slot.status();
        if (Status s = submissions_.begin(*slot, inputs); !s) return s;
        if (Status s = programs_.find(program.id)->launch(*slot); !s) return s;
        return submissions_.finish(*slot, program);
    }

    bool finished(compute::Ticket ticket) override {
        const CurrentContext current(*context_);
        auto done = submissions_.finished(ticket);
        return done ? *done : context_->lost;
    }

    Status wait(compute::Ticket ticket) override {
        const CurrentContext current(*context_);
        return submissions_.wait(ticket);
    }

    Result<std::vector<compute::Timing>> timings(compute::Ticket ticket) override {
        const CurrentContext current(*context_);
        CompiledProgram* compiled = programs_.find(submissions_.program_of(ticket).id);
        return compiled == nullptr ? std::vector<compute::Timing>{} : compiled->timings(Submissions::slot_of(ticket.value));
    }

    Result<compute::NativeBuffer> native(compute::Buffer buffer) override {
        const Memory& memory = *buffers_.find(buffer);
        if (const auto& lent = memory.borrowed.lent; lent.handle != 0)
            return compute::NativeBuffer{compute::NativeBuffer::Kind::vulkan_buffer, lent.handle, memory.bytes};
        return compute::NativeBuffer{compute::NativeBuffer::Kind::cuda_pointer, reinterpret_cast<std::uintptr_t>(memory.data),
                                     memory.bytes};
    }

    compute::HostSync* host_sync() override { return &host_order_; }

  private:
    // Destroyed from the last to the first.
    std::unique_ptr<Context> context_;
    Buffers buffers_{*context_};
    Pipelines pipelines_{*context_};
    Submissions submissions_{*context_};
    HostOrder host_order_{*context_, buffers_, submissions_};
    backends::HandleTable<CompiledProgram> programs_;
};

} // namespace

Result<std::unique_ptr<compute::Device>> open_device(int index, const compute::DeviceOptions& options) {
    auto context = Context::open(index, options);
    if (!context) return context.status();
    auto device = std::make_unique<CudaDevice>(std::move(*context));
    if (Status s = device->open(); !s) return s;
    return std::unique_ptr<compute::Device>(std::move(device));
}

} // namespace wadi::cuda
