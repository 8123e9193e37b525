// The device of a world: the buffers that the world has on it, counted, and its loss, remembered.
#pragma once
#include "engine/compute/device.hpp"
#include <functional>
#include <memory>
#include <vector>

namespace wadi {

/// One buffer on the device.
struct MemoryItem {
    compute::Buffer buffer;
    std::string label;
    std::uint64_t bytes = 0;
};

/// What the components of a world call of compute::Device, with its meaning and its errors.
class WorldDevice {
  public:
    /// Is told of the loss, once.
    using OnLoss = std::function<void(const Status& lost)>;

    WorldDevice(std::unique_ptr<compute::Device> device, OnLoss on_loss)
        : device_(std::move(device)), on_loss_(std::move(on_loss)) {}

    /// The device itself; a loss that shows there is not remembered here.
    compute::Device& operator*() const { return *device_; }
    /// ok until the device is lost, then device_lost for ever.
    const Status& lost() const { return lost_; }
    /// The state is neither what it was nor what it should be, and cannot be mended: device_lost from here on.
    Status give_up(const std::string& why);
    /// Every buffer that the world has.
    const std::vector<MemoryItem>& memory() const { return memory_; }
    std::uint64_t bytes() const;

    Result<compute::Buffer> create_buffer(const compute::BufferDesc& desc);
    void destroy_buffer(compute::Buffer buffer);
    std::span<std::byte> mapped(compute::Buffer buffer) { return device_->mapped(buffer); }
    Status write(compute::Buffer buffer, std::uint64_t offset, std::span<const std::byte> bytes);
    Status read(compute::Buffer buffer, std::uint64_t offset, std::span<std::byte> bytes);

    Result<compute::Pipeline> create_pipeline(int stage, std::uint32_t effects, compute::GroupSize group);
    Result<compute::Program> compile(const compute::ProgramBuilder& builder, const WorldParams& params);
    /// Frees a program and forgets it: null from here on.
    void destroy_program(compute::Program& program);
    Result<compute::Ticket> submit(compute::Program program, const StepInput& input) {
        return submit_inputs(program, {&input, 1});
    }
    Result<compute::Ticket> submit_inputs(compute::Program program, std::span<const StepInput> inputs);
    bool finished(compute::Ticket ticket) { return device_->finished(ticket); }
    Status wait(compute::Ticket ticket);
    Result<std::vector<compute::Timing>> timings(compute::Ticket ticket);

  private:
    template <class Answer> Answer noted(Answer answer);

    std::unique_ptr<compute::Device> device_;
    OnLoss on_loss_;
    Status lost_;
    std::vector<MemoryItem> memory_;
};

} // namespace wadi
