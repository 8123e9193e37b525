#include "backends/vulkan/device.hpp"
#include "backends/vulkan/program.hpp"
#include "backends/vulkan/self_test.hpp"

namespace wadi::vulkan {
namespace {

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

    Result<compute::Buffer> create_buffer(const compute::BufferDesc& desc) override { return buffers_.create(desc); }

    std::span<std::byte> mapped(compute::Buffer buffer) override {
        const Memory& memory = *buffers_.find(buffer);
        return {static_cast<std::byte*>(memory.mapped), memory.bytes};
    }

    void destroy_buffer(compute::Buffer buffer) override {
        if (recorded_in_flight()) {
            doomed_buffers_.push_back(buffer);
            return;
        }
        context_->wait_idle();
        buffers_.destroy(buffer);
    }

    Status write(compute::Buffer buffer, std::uint64_t offset, std::span<const std::byte> bytes) override {
        Status order = submissions_.check_order();
        return order ? transfers_.write(*buffers_.find(buffer), offset, bytes) : order;
    }

    Status read(compute::Buffer buffer, std::uint64_t offset, std::span<std::byte> bytes) override {
        Status order = submissions_.check_order();
        return order ? transfers_.read(*buffers_.find(buffer), offset, bytes) : order;
    }

    Result<compute::Pipeline> create_pipeline(int stage, std::uint32_t effects, compute::GroupSize group) override {
        return pipelines_.create(stage, effects, group);
    }

    Result<compute::Program> compile(const compute::ProgramBuilder& builder, const WorldParams& params) override {
        const ProgramParts parts{*context_, transfers_, buffers_, pipelines_, submissions_};
        programs_.reserve();
        auto program = CompiledProgram::compile(parts, builder, params);
        if (!program) return program.status();
        return compute::Program{programs_.add(std::move(*program))};
    }

    void destroy_program(compute::Program program) override {
        auto taken = programs_.take(program.id); // destroying it waits for the queue
        if (recorded_in_flight()) doomed_programs_.push_back(std::move(taken));
    }

    Result<compute::Ticket> submit_inputs(compute::Program program, std::span<const StepInput> inputs) override {
        if (!submissions_.recording()) {
            if (Status s = submissions_.check_order(); !s) return s;
            destroy_doomed();
        }
        auto slot = submissions_.acquire();
        if (!slot) return slot.status();
        CompiledProgram& compiled = *programs_.find(program.id);
        auto commands = submissions_.recording() ? compiled.secondary_for(*slot)
                                                 : compiled.commands_for(*slot, submissions_.own_commands(*slot));
        if (!commands) return commands.status();
        return submissions_.submit(*slot, inputs, *commands, program);
    }

    bool finished(compute::Ticket ticket) override {
        auto done = submissions_.finished(ticket);
        return done ? *done : context_->lost;
    }

    Status wait(compute::Ticket ticket) override { return submissions_.wait(ticket); }

    Result<std::vector<compute::Timing>> timings(compute::Ticket ticket) override {
        CompiledProgram* compiled = programs_.find(submissions_.program_of(ticket).id);
        return compiled == nullptr ? std::vector<compute::Timing>{} : compiled->timings(Submissions::slot_of(ticket.value));
    }

    Result<compute::NativeBuffer> native(compute::Buffer buffer) override {
        const Memory& memory = *buffers_.find(buffer);
        return compute::NativeBuffer{compute::NativeBuffer::Kind::vulkan_buffer, reinterpret_cast<std::uintptr_t>(memory.buffer),
                                     memory.bytes};
    }

    compute::HostSync* host_sync() override { return &submissions_; }

  private:
    // The host's command buffers may refer to anything that was alive when they were recorded.
    bool recorded_in_flight() { return !context_->lost && submissions_.check_order().code == Code::not_ready; }

    void destroy_doomed() {
        if (doomed_buffers_.empty() && doomed_programs_.empty()) return;
        context_->wait_idle();
        for (const compute::Buffer buffer : doomed_buffers_) buffers_.destroy(buffer);
        doomed_buffers_.clear();
        doomed_programs_.clear();
    }

    // Destroyed from the last to the first.
    std::unique_ptr<Context> context_;
    OneTimeCommands once_{*context_};
    Transfers transfers_{*context_, once_};
    Buffers buffers_{*context_, transfers_};
    Pipelines pipelines_{*context_};
    Submissions submissions_{*context_};
    backends::HandleTable<CompiledProgram> programs_;
    // Destroyed once recorded work that may use them has run.
    std::vector<std::unique_ptr<CompiledProgram>> doomed_programs_;
    std::vector<compute::Buffer> doomed_buffers_;
};

} // namespace

Result<std::unique_ptr<compute::Device>> open_device(int index, const compute::DeviceOptions& options) {
    auto context = Context::open(index, options);
    if (!context) return context.status();
    auto device = std::make_unique<VulkanDevice>(std::move(*context));
    if (Status s = device->open(); !s) return s;
    return std::unique_ptr<compute::Device>(std::move(device));
}

} // namespace wadi::vulkan
