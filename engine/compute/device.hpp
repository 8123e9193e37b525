// The compute interface that every backend implements, and the only thing the engine knows of a device.
// How to add a backend: backends/README.md.
#pragma once
#include "engine/compute/host_sync.hpp"
#include "engine/compute/lender.hpp"
#include "engine/compute/program.hpp"
#include "engine/compute/status.hpp"
#include "shaders/params.hpp"
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wadi::compute {

enum class DeviceKind : std::uint8_t { cpu, integrated_gpu, discrete_gpu, virtual_gpu, software_gpu };

/// Threads of a group. All 0: the device has no groups and ignores GroupSize.
struct GroupLimits {
    int x = 0, y = 0; // at most, along i and j
    int threads = 0;  // at most, in all
    int rim = 0;      // of a rim stage's group, where the caller leaves it open
};

/// Filled once when a device is opened.
struct Capabilities {
    std::string backend; // "cpu", "vulkan", "cuda"
    std::string name;    // as the driver names it
    std::string driver;  // driver name and version, or the instruction set for the CPU
    DeviceKind kind = DeviceKind::cpu;
    std::uint64_t memory_bytes = 0;         // of the largest device-local heap; 0 = unknown
    std::uint64_t largest_buffer_bytes = 0; // of one buffer bound to a stage
    GroupLimits groups;
    bool exact_float = false; // measured: + - * / sqrt agree with the CPU in every bit
    bool timestamps = false;
    bool fused_stages = false;     // groups of fused_group_x x fused_group_y threads that share fused_shared_bytes
    std::uint32_t queue_depth = 0; // submissions in flight before submit() waits for the oldest
};

/// What was measured to be faster on devices of this kind. It changes no bit.
struct Tuning {
    std::int64_t fused_gain_cells = 0; // cells of a grid from which fused stages are faster than one by one; 0 = never
    bool fused_slopes = false;         // so is what accelerates sand on slopes, whose fused stages want many registers
    std::int64_t tiles_gain_cells = 0; // and from which active tiles may be, where few are awake
};

/// A host's own Vulkan device to run on instead of one that we open. Handles as Vulkan's, opaque here; all must outlive the
/// device that is opened on them.
struct HostDevice {
    void* instance = nullptr;
    void* physical_device = nullptr;
    void* device = nullptr;
    void* queue = nullptr;                       // of queue_family; used inside calls only, and nobody else may use it during one
    void* get_instance_proc_addr = nullptr;      // PFN_vkGetInstanceProcAddr
    std::uint32_t queue_family = 0;              // must have compute
    std::vector<std::uint32_t> sharing_families; // other queue families whose commands touch our buffers
    bool timeline_semaphore = false;             // the feature is enabled on the device
};

/// A buffer as its API knows it.
struct NativeBuffer {
    enum class Kind : std::uint8_t { host_pointer, vulkan_buffer, cuda_pointer };
    Kind kind = Kind::host_pointer;
    std::uint64_t handle = 0; // address, or VkBuffer
    std::uint64_t bytes = 0;
};

/// Severity: 0 = error, 1 = warning, 2 = information. Drivers call it from any thread.
using Log = std::function<void(int severity, const std::string& message)>;

/// Calls `job` `count` times, on any threads, at once or one after the other, and returns when all calls have. Must not throw.
using RunJobs = std::function<void(int count, const std::function<void()>& job)>;

/// A host's memory. Called from any thread, those of several devices at once; neither throws.
struct Allocator {
    std::function<void*(std::size_t bytes, std::size_t alignment)> allocate; // null where it refuses
    std::function<void(void* memory, std::size_t bytes)> free;
};

struct DeviceOptions {
    int threads = 0;  // CPU backend: worker threads, 0 = all cores
    RunJobs run_jobs; // CPU backend: a host's threads in place of all but the device thread; `threads` calls a pass
    std::shared_ptr<const Allocator> allocator; // CPU backend: of all buffers; null = the system's pages
    std::string instruction_set;                // CPU backend: "" = best, "base", "avx2", "avx512"
    bool flush_denormals = false;               // CPU backend, for tests: stages take denormal numbers for 0, as some GPUs do
    bool validate = false;                      // Vulkan: validation and synchronization validation layers
    bool full_barriers = false;                 // a barrier before every operation
    std::optional<HostDevice> host;             // Vulkan: run on the host's device; CUDA: beside it
    std::shared_ptr<Lender> lender;             // CUDA: lends shared buffers and semaphores; filled when the device is opened
    bool no_replay = false;                     // record anew for each submit (GPU backends; the CPU has nothing recorded)
    Log log;                                    // of drivers and validation layers
};

/// Memory that the host reads or writes in place.
enum class HostAccess : std::uint8_t { none, upload, readback };

struct BufferDesc {
    std::uint64_t bytes = 0;
    std::string label; // for errors
    HostAccess host = HostAccess::none;
    bool shared = false; // the host's API works with it too: with a lender it is the lender's
};

/// Threads per group along i and j (GPU backends; the CPU ignores it). 0 = the backend's choice for the stage.
/// tile: side of the active tiles that the pipeline's dispatches run over, 0 = none; over them x and y are ignored, and cells and
/// faces have groups of a tile's width.
struct GroupSize {
    int x = 0, y = 0, tile = 0;
    friend bool operator==(GroupSize, GroupSize) = default;
};

struct Timing {
    std::string label;
    double milliseconds = 0;
};

/// Counts since the device was opened; tests assert that none of them moves per step.
struct DeviceCounters {
    std::uint64_t allocations = 0; // buffers created
    std::uint64_t descriptor_writes = 0;
    std::uint64_t recordings = 0; // command buffers or graphs recorded
    std::uint64_t submits = 0;
    std::uint64_t validation_messages = 0; // warnings and errors from validation layers
};

/// A device runs programs. Calls come from one thread at a time, and no exception leaves one.
/// After device_lost every call that needs the device returns device_lost, and finished() is true.
/// What bad_argument stands for here, the front end of all backends refuses (backends/common/front_end.hpp); a backend, which
/// implements the same calls behind it, is never given such arguments, and may throw std::bad_alloc.
class Device {
  public:
    virtual ~Device() = default;

    virtual const Capabilities& capabilities() const = 0;
    virtual const Tuning& tuning() const = 0;
    virtual DeviceCounters counters() const = 0;

    /// A linear buffer, filled with zeros. Errors: bad_argument (0 bytes, or above largest_buffer_bytes), out_of_memory.
    virtual Result<Buffer> create_buffer(const BufferDesc& desc) = 0;
    /// Where the host reads or writes a buffer made for upload or readback; empty for other buffers. Valid until the buffer or
    /// the device is destroyed. What the host wrote before submit() is what that submission copies from; what a submission copied
    /// here may be read once its ticket has finished. Such buffers take part in copies only: compile() refuses them in
    /// dispatches and fills.
    virtual std::span<std::byte> mapped(Buffer buffer) = 0;
    /// Frees a buffer once work in flight is done with it; programs that use it can only be destroyed after that. Null is
    /// ignored. Does not wait where the backend can help it (the CPU).
    virtual void destroy_buffer(Buffer buffer) = 0;
    /// Copies host bytes into a buffer, ordered after all earlier and before all later submissions. May wait.
    virtual Status write(Buffer buffer, std::uint64_t offset, std::span<const std::byte> bytes) = 0;
    /// Copies a buffer to the host once all earlier submissions have finished. Waits.
    virtual Status read(Buffer buffer, std::uint64_t offset, std::span<std::byte> bytes) = 0;

    /// A stage specialised for a mask. Only the stage's tested_effects of `effects` matter; equal requests share one pipeline.
    /// Errors: bad_argument (no such stage, group size, active tiles for a stage that has no marks), not_supported.
    virtual Result<Pipeline> create_pipeline(int stage, std::uint32_t effects, GroupSize group) = 0;

    /// Records a program once, with its parameters frozen in. Errors: out_of_memory, not_supported (more than the device can run
    /// at once), bad_argument (a stage, buffer or pipeline that does not exist; too few or too many slots; a pipeline of another
    /// stage, other tested effects or other active tiles; a buffer bound twice and written; a copy past a buffer's end; more than
    /// most_inputs).
    virtual Result<Program> compile(const ProgramBuilder& builder, const WorldParams& params) = 0;
    /// Frees a program, likewise.
    virtual void destroy_program(Program program) = 0;

    /// Replays a program with its steps' inputs, ProgramBuilder::inputs() of them. Returns at once unless the queue of
    /// submissions is full. Tickets count up from 1. Errors: bad_argument (no such program, one of its buffers was destroyed,
    /// more or fewer inputs).
    virtual Result<Ticket> submit_inputs(Program program, std::span<const StepInput> inputs) = 0;
    /// The same for a program with one input.
    Result<Ticket> submit(Program program, const StepInput& input) { return submit_inputs(program, {&input, 1}); }
    /// False for a ticket that was never given out.
    virtual bool finished(Ticket ticket) = 0;
    /// Errors: bad_argument (a ticket that was never given out).
    virtual Status wait(Ticket ticket) = 0;
    /// Time between consecutive timestamps of a submission that contained any; empty if there were none or the ticket is older
    /// than the queue. Errors: bad_argument (a ticket that was never given out, or has not finished).
    virtual Result<std::vector<Timing>> timings(Ticket ticket) = 0;

    /// What a host passes to its own API. Errors: bad_argument (no such buffer).
    virtual Result<NativeBuffer> native(Buffer buffer) = 0;
    /// The host's semaphores, events, images and command buffers. Null where a device has none; the front end's is never null and
    /// refuses.
    virtual HostSync* host_sync() { return nullptr; }

    /// Makes every later call return device_lost, as a real fault would: for tests of the host's reaction. Of the front end
    /// alone; a backend inherits this.
    virtual void inject_device_lost() {}
};

} // namespace wadi::compute
