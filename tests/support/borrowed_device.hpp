// A device that several worlds share.
#pragma once
#include "engine/compute/device.hpp"
#include <set>

namespace wadi::test {

/// Forwards to a device that outlives it and on destruction frees what was made through it, so that a World can own it and
/// pipelines are built only once.
class BorrowedDevice final : public compute::Device {
  public:
    explicit BorrowedDevice(compute::Device& device) : device_(device) {}
    ~BorrowedDevice() override {
        for (const auto id : programs_) device_.destroy_program({id});
        for (const auto id : buffers_) device_.destroy_buffer({id});
    }

    const compute::Capabilities& capabilities() const override { return device_.capabilities(); }
    const compute::Tuning& tuning() const override { return device_.tuning(); }
    compute::DeviceCounters counters() const override { return device_.counters(); }
    Result<compute::Buffer> create_buffer(const compute::BufferDesc& desc) override {
        auto made = device_.create_buffer(desc);
        if (made) buffers_.insert(made->id);
        return made;
    }
    std::span<std::byte> mapped(compute::Buffer buffer) override { return device_.mapped(buffer); }
    void destroy_buffer(compute::Buffer buffer) override {
        buffers_.erase(buffer.id);
        device_.destroy_buffer(buffer);
    }
    Status write(compute::Buffer buffer, std::uint64_t offset, std::span<const std::byte> bytes) override {
        return device_.write(buffer, offset, bytes);
    }
    Status read(compute::Buffer buffer, std::uint64_t offset, std::span<std::byte> bytes) override {
        return device_.read(buffer, offset, bytes);
    }
    Result<compute::Pipeline> create_pipeline(int stage, std::uint32_t effects, compute::GroupSize group) override {
        return device_.create_pipeline(stage, effects, group);
    }
    Result<compute::Program> compile(const compute::ProgramBuilder& builder, const WorldParams& params) override {
        auto made = device_.compile(builder, params);
        if (made) programs_.insert(made->id);
        return made;
    }
    void destroy_program(compute::Program program) override {
        programs_.erase(program.id);
        device_.destroy_program(program);
    }
    Result<compute::Ticket> submit_inputs(compute::Program program, std::span<const StepInput> inputs) override {
        return device_.submit_inputs(program, inputs);
    }
    bool finished(compute::Ticket ticket) override { return device_.finished(ticket); }
    Status wait(compute::Ticket ticket) override { return device_.wait(ticket); }
    Result<std::vector<compute::Timing>> timings(compute::Ticket ticket) override { return device_.timings(ticket); }
    Result<compute::NativeBuffer> native(compute::Buffer buffer) override { return device_.native(buffer); }
    compute::HostSync* host_sync() override { return device_.host_sync(); }
    void inject_device_lost() override { device_.inject_device_lost(); }

  private:
    compute::Device& device_;
    std::set<std::uint32_t> buffers_, programs_;
};

} // namespace wadi::test
