// The front end refuses, backends run: a device as hosts and the engine see it, whatever backend is behind it.
#pragma once
#include "backends/common/backend.hpp"
#include "backends/common/program_check.hpp"
#include <new>
#include <set>

namespace wadi::backends {

/// No exception leaves the interface; the only one that a backend's own code can meet is a failed host allocation.
template <class Call> auto guarded(Call call) -> decltype(call()) {
    try {
        return call();
    } catch (const std::bad_alloc&) {
        return error(Code::out_of_memory, "out of memory"); // short enough to need none
    }
}

/// Refuses every argument that no backend could take, shares equal pipelines, and remembers that a device is lost. What reaches
/// the backend is right: handles are alive, ranges inside, group sizes chosen, tickets given out.
class FrontEnd final : public compute::Device, private compute::HostSync {
  public:
    explicit FrontEnd(std::unique_ptr<compute::Device> device) : device_(std::move(device)) {}

    const compute::Capabilities& capabilities() const override { return device_->capabilities(); }
    const compute::Tuning& tuning() const override { return device_->tuning(); }
    compute::DeviceCounters counters() const override { return device_->counters(); }
    Result<compute::Buffer> create_buffer(const compute::BufferDesc& desc) override;
    std::span<std::byte> mapped(compute::Buffer buffer) override;
    void destroy_buffer(compute::Buffer buffer) override;
    Status write(compute::Buffer buffer, std::uint64_t offset, std::span<const std::byte> bytes) override;
    Status read(compute::Buffer buffer, std::uint64_t offset, std::span<std::byte> bytes) override;
    Result<compute::Pipeline> create_pipeline(int stage, std::uint32_t effects, compute::GroupSize group) override;
    Result<compute::Program> compile(const compute::ProgramBuilder& builder, const WorldParams& params) override;
    void destroy_program(compute::Program program) override;
    Result<compute::Ticket> submit_inputs(compute::Program program, std::span<const StepInput> inputs) override;
    bool finished(compute::Ticket ticket) override;
    Status wait(compute::Ticket ticket) override;
    Result<std::vector<compute::Timing>> timings(compute::Ticket ticket) override;
    Result<compute::NativeBuffer> native(compute::Buffer buffer) override;
    compute::HostSync* host_sync() override { return this; }
    void inject_device_lost() override;

  private:
    Status wait_before(std::span<const compute::SyncPoint> points) override;
    Status signal_after(const compute::SyncPoint& point) override;
    Status wait_event(void* event) override;
    Status record_event(void* event) override;
    Result<compute::Ticket> copy_to_image(const compute::BufferRows& from, const compute::HostImage& to) override;
    Result<compute::Ticket> copy_from(const compute::HostRows& from, compute::Buffer to) override;
    Status begin_recording(void* commands, const compute::SyncPoint& promise) override;
    Status end_recording() override;
    template <class Call> auto with_host_sync(const char* what, Call call) -> decltype(call(std::declval<compute::HostSync&>()));
    template <class Call> auto unless_lost(Call call) -> decltype(call());
    Status check_given_out(compute::Ticket ticket) const;

    std::unique_ptr<compute::Device> device_;
    Status lost_; // not ok: every call that needs the device returns it
    Objects objects_;
    struct Program {
        std::string label;
        std::set<std::uint32_t> buffers;
        std::size_t inputs = 1;
        std::uint32_t gone = 0; // of the buffers, one that was destroyed
    };
    std::map<std::uint32_t, Program> programs_; // those that exist
    compute::Ticket newest_;
    bool recording_ = false;
};

} // namespace wadi::backends
