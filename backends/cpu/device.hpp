// The compute interface on the CPU's own threads. submit() queues and returns; one device thread runs the queue in order and
// shares each pass with the pool.
#pragma once
#include "backends/common/handle_table.hpp"
#include "backends/common/retired.hpp"
#include "backends/cpu/active_tiles.hpp"
#include "backends/cpu/content.hpp"
#include "backends/cpu/host_memory.hpp"
#include "backends/cpu/memory_budget.hpp"
#include "backends/cpu/thread_pool.hpp"
#include "engine/compute/device.hpp"
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

namespace wadi::cpu {

class CpuDevice final : public compute::Device {
  public:
    CpuDevice(const InstructionSet& set, const compute::DeviceOptions& options);
    ~CpuDevice() override;
    /// Before anything else: starts the device thread and `threads` - 1 others, or as many as the system gives. Throws
    /// std::system_error where it gives none.
    void start(int threads, const compute::RunJobs& jobs);

    const compute::Capabilities& capabilities() const override { return capabilities_; }
    const compute::Tuning& tuning() const override { return tuning_; }
    compute::DeviceCounters counters() const override { return counters_; }
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

  private:
    struct Memory : backends::Retirable<Memory> {
        BudgetShare share;
        std::shared_ptr<std::byte> block;
        std::byte* data = nullptr;
        std::size_t bytes = 0;
        std::unique_ptr<BlockContent> content; // of a field that some stage can be empty without
        bool exposed = false;                  // its address was given away
    };
    /// One operation, ready to run.
    struct Step {
        StageBlock block = nullptr; // null for copies and fills
        std::vector<void*> buffers;
        std::vector<unsigned long long> sizes;
        compute::Range2 range{};
        std::size_t input = 0; // of the submission
        ActiveStage active;
        ContentStage content;
        const compute::StageInfo* stage = nullptr;
        std::uint32_t effects = 0;    // of a stage, as the rest
        std::vector<Memory*> bound;   // by binding, null where the mask lacks it
        std::vector<Memory*> written; // by what has no content of its own
        int rows_per_grab = 1;
        std::byte* from = nullptr; // copy
        std::byte* to = nullptr;   // copy and fill
        std::size_t bytes = 0;
        std::uint32_t word = 0;
        bool barrier_before = false;
        int timestamp = -1;
        /// Shares of the work that threads take: rows, rows of blocks, or one.
        int rows() const {
            return content.on() ? content.written.front()->blocks().rows() : block != nullptr ? range.j1 - range.j0 : 1;
        }
    };
    /// How far one execution of a step has come.
    struct Progress {
        std::atomic<int> next_row{0};    // the first that nobody has taken yet
        std::atomic<int> rows_to_run{0}; // that nobody has run yet
        Remaining rows;
    };
    struct Recorded : backends::Retirable<Recorded> {
        WorldParams params{};
        std::vector<Step> steps;
        std::vector<std::string> timestamp_labels;
        std::unique_ptr<Progress[]> progress; // per step
        bool small = false;                   // not worth waking other threads for
        bool prepared = false;                // by the device thread, ahead of the first run
    };
    struct Submission {
        std::uint64_t ticket;
        Recorded* program;
        std::vector<StepInput> inputs;
        // Of its program's timestamps; room is made ahead, since on the device's thread nobody could be told that there is none.
        std::vector<std::chrono::steady_clock::time_point> stamps = {};
        // Destroyed ahead of it: the device thread frees them behind it, since a host waits for its own.
        backends::Retired<Memory> buffers = {};
        backends::Retired<Recorded> programs = {};
    };

    Memory& at(compute::Buffer buffer) const { return *buffers_.find(buffer.id); }
    void drain();
    /// A share of what this machine can give. Errors: out_of_memory.
    Result<BudgetShare> share_of_budget(const compute::BufferDesc& desc);
    /// The newest submission that has.
    std::uint64_t finished_so_far();
    /// Frees what was destroyed; nothing may use it any more.
    static void free(backends::Retired<Memory>& buffers, backends::Retired<Recorded>& programs);
    void device_thread();
    /// The oldest submission that waits, with the lock given back meanwhile.
    void run_next(std::unique_lock<std::mutex>& lock);
    void execute(Submission& submission);
    /// Errors: internal (more outputs than any stage has).
    Status set_active(const compute::Dispatch& dispatch, const compute::StageInfo& stage, Step& step);
    /// On the device thread, while nothing else runs: what depends on what fields hold.
    void prepare(Recorded& program);
    /// Leaves the step's content off where it cannot be told.
    void set_content(const WorldParams& params, Step& step);
    /// Null for a buffer that is no field of this layout.
    BlockContent* content_of(Memory& memory, FieldLayout layout);
    /// The stage of the step without some effects, null where its instruction set has no code of its own for it.
    StageBlock lean_block(int stage, std::uint32_t effects) const;
    /// For those that follow; what has content itself has looked already.
    static void look_into_written(const Step& step);
    static void run_rows(Step& step, const WorldParams& params, const StepInput& input, int first, int last);

    const InstructionSet& set_;
    std::optional<ThreadPool> pool_;
    const bool full_barriers_;
    const bool flush_denormals_;
    const std::shared_ptr<const compute::Allocator> allocator_; // null: pages of the system's
    compute::Capabilities capabilities_;
    compute::Tuning tuning_; // all 0: stages run one by one, and worlds do not choose tiles
    compute::DeviceCounters counters_;
    PageArena pages_{true}, small_pages_{false};
    backends::HandleTable<Memory> buffers_;
    std::vector<StageBlock> pipelines_; // by id - 1
    backends::HandleTable<Recorded> programs_;
    backends::Retired<Memory> retired_buffers_;
    backends::Retired<Recorded> retired_programs_;

    std::mutex mutex_; // of what follows, and of Memory::content and ::exposed while it runs
    std::condition_variable changed_;
    std::deque<Submission> queue_;
    std::uint64_t submitted_ = 0, done_ = 0;
    bool stop_ = false;
    std::map<std::uint64_t, std::vector<compute::Timing>> timings_; // of the last submissions that have any
    std::thread runner_;
};

} // namespace wadi::cpu
