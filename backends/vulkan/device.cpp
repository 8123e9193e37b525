#include "backends/vulkan/device.hpp"
#include "backends/vulkan/program.hpp"
#include "backends/vulkan/self_test.hpp"

namespace wadi::vulkan {
namespace {

class VulkanDevice final : public compute::Device {
  public:
    explicit VulkanDevice(std::unique_ptr<Context> context) : context_(std::move(context)) {}

    ~VulkanDevice() override {
        context_->wait_idle();
        free_retired(UINT64_MAX, SIZE_MAX);
    }

    Status open() {
        if (Status s = once_.open(); !s) return s;
        if (Status s = transfers_.open(); !s) return s;
        if (Status s = buffers_.open(); !s) return s;
        if (Status s = pipelines_.open(); !s) return s;
        if (Status s = submissions_.open(); !s) return s;
        return run_self_test(*context_, once_, transfers_);
    }

    const compute::Capabilities& capabilities() const override { return context_->capabilities; }
    const compute::Tuning& tuning() const override { return context_->tuning; }

    compute::DeviceCounters counters() const override {
        compute::DeviceCounters counters = context_->counters;
        counters.validation_messages = context_->instance->messages().validation;
        return counters;
    }

    Result<compute::Buffer> create_buffer(const compute::BufferDesc& desc) override {
        auto made = buffers_.create(desc);
        if (made || made.status().code != Code::out_of_memory || retired_buffers_.empty()) return made;
        context_->wait_idle();
        free_retired(submissions_.look_for_finished(), SIZE_MAX);
        return buffers_.create(desc);
    }

    std::span<std::byte> mapped(compute::Buffer buffer) override {
        const Memory& memory = *buffers_.find(buffer);
        return {static_cast<std::byte*>(memory.mapped), memory.bytes};
    }

    void destroy_buffer(compute::Buffer buffer) override {
        // A transfer that has no ticket is done when the next submission is.
        retired_buffers_.put(buffers_.take(buffer), submissions_.newest() + (once_.in_flight() ? 1 : 0));
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
        const ProgramParts parts{*context_, buffers_, pipelines_, submissions_};
        programs_.reserve();
        auto program = CompiledProgram::compile(parts, builder, params);
        if (!program) return program.status();
        return compute::Program{programs_.add(std::move(*program))};
    }

    void destroy_program(compute::Program program) override {
        retired_programs_.put(programs_.take(program.id), submissions_.newest());
    }

    Result<compute::Ticket> submit_inputs(compute::Program program, std::span<const StepInput> inputs) override {
        if (!submissions_.recording()) {
            if (Status s = submissions_.check_order(); !s) return s;
            free_retired(submissions_.look_for_finished(), 1); // a promotion leaves many
        }
        auto slot = submissions_.acquire();
        if (!slot) return slot.status();
        CompiledProgram& compiled = *programs_.find(program.id);
        auto commands = submissions_.recording() ? compiled.secondary_for(*slot)
                                                 : compiled.commands_for(*slot, submissions_.own_commands(*slot));
        if (!commands) return commands.status();
        auto ticket = submissions_.submit(*slot, inputs, compiled.first_update(), *commands, program);
        if (ticket) compiled.submitted();
        return ticket;
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

    // A host's handles are of its own device.
    compute::HostSync* host_sync() override { return context_->options.host ? &submissions_ : nullptr; }

  private:
    void free_retired(std::uint64_t finished, std::size_t most) {
        retired_programs_.release(finished, most, [](CompiledProgram&) {});
        retired_buffers_.release(finished, most, [this](Memory& memory) { release(*context_, memory); });
    }

    // Destroyed from the last to the first.
    std::unique_ptr<Context> context_;
    OneTimeCommands once_{*context_};
    Transfers transfers_{*context_, once_};
    Buffers buffers_{*context_, transfers_};
    Pipelines pipelines_{*context_};
    Submissions submissions_{*context_, buffers_};
    backends::HandleTable<CompiledProgram> programs_;
    // The host's command buffers, too, may refer to anything that was alive when they were recorded.
    backends::Retired<CompiledProgram> retired_programs_;
    backends::Retired<Memory> retired_buffers_;
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
