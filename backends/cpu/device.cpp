#include "backends/cpu/device.hpp"
#include "backends/cpu/backend.hpp"
#include "backends/cpu/host_memory.hpp"
#include "engine/compute/float_environment.hpp"
#include "engine/compute/hazards.hpp"
#include "engine/compute/thread_name.hpp"
#include <algorithm>
#include <chrono>
#include <cstring>
#include <exception>
#include <functional>
#include <limits>
#include <new>
#include <system_error>

namespace wadi::cpu {

namespace {

constexpr std::size_t most_in_flight = 64;
constexpr std::uint64_t most_in_small_pages = 65536;
constexpr std::size_t kept_timings = 2 * most_in_flight; // room is made as submissions come
constexpr std::int64_t small_pass = 8192;                // cells below which a second thread costs more than it gives

std::int64_t area(const compute::Range2& r) { return std::int64_t{std::max(0, r.i1 - r.i0)} * std::max(0, r.j1 - r.j0); }

} // namespace

CpuDevice::CpuDevice(const InstructionSet& set, const compute::DeviceOptions& options)
    : set_(set), full_barriers_(options.full_barriers), flush_denormals_(options.flush_denormals), allocator_(options.allocator) {
    capabilities_.backend = "cpu";
    capabilities_.name = processor_name();
    capabilities_.kind = compute::DeviceKind::cpu;
    capabilities_.memory_bytes = physical_memory();
    capabilities_.largest_buffer_bytes =
        capabilities_.memory_bytes != 0 ? capabilities_.memory_bytes : std::numeric_limits<std::ptrdiff_t>::max();
    capabilities_.exact_float = true;
    capabilities_.timestamps = true;
    capabilities_.fused_stages = set.fused;
    capabilities_.queue_depth = most_in_flight;
}

void CpuDevice::start(int threads, const compute::RunJobs& jobs) {
    try {
        runner_ = std::thread([this] { device_thread(); });
    } catch (const std::system_error&) { // none left, or a system without any: what is submitted runs within submit
    }
    pool_.emplace(threads, jobs);
    const int got = pool_->size();
    capabilities_.driver = std::string(set_.name) + ", " + std::to_string(got) + (got == 1 ? " thread" : " threads");
}

CpuDevice::~CpuDevice() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    if (runner_.joinable()) runner_.join();
}

Result<BudgetShare> CpuDevice::share_of_budget(const compute::BufferDesc& desc) {
    auto& budget = MemoryBudget::of_process();
    bool fits = budget.take(desc.bytes);
    if (!fits) {
        drain(); // what submissions have with them is free then
        free(retired_buffers_, retired_programs_);
        fits = budget.take(desc.bytes);
    }
    if (!fits) {
        return error(Code::out_of_memory, "buffer '" + desc.label + "': " + std::to_string(desc.bytes >> 20) +
                                              " MiB more than the " + std::to_string(budget.room() >> 20) +
                                              " MiB that this machine can give");
    }
    return BudgetShare(desc.bytes);
}

Result<compute::Buffer> CpuDevice::create_buffer(const compute::BufferDesc& desc) {
    BudgetShare share;
    if (allocator_ == nullptr) { // a host knows what it has
        auto found = share_of_budget(desc);
        if (!found) return found.status();
        share = std::move(*found);
    }
    // Fields start 64 bytes apart modulo 4 KiB: equal offsets in many arrays would share cache sets.
    const std::size_t stagger = 64 * ((counters_.allocations + 1) % 64);
    buffers_.reserve();
    auto owner = std::make_unique<Memory>();
    auto& memory = *owner;
    const auto bytes = static_cast<std::size_t>(desc.bytes);
    // The host's first touch of a large page would clear all of it, in a call of a frame.
    const bool small = desc.host != compute::HostAccess::none && desc.bytes <= most_in_small_pages;
    if (bytes == desc.bytes) // or more than a system of 32 bits has addresses for
        memory.block = allocator_ ? take_from(allocator_, bytes, stagger) : (small ? small_pages_ : pages_).take(bytes, stagger);
    if (!memory.block)
        return error(Code::out_of_memory, "buffer '" + desc.label + "': no memory for " + std::to_string(desc.bytes) + " bytes");
    memory.data = memory.block.get();
    memory.bytes = bytes;
    memory.share = std::move(share);
    ++counters_.allocations;
    return compute::Buffer{buffers_.add(std::move(owner))};
}

std::span<std::byte> CpuDevice::mapped(compute::Buffer buffer) { return {at(buffer).data, at(buffer).bytes}; }

Result<compute::NativeBuffer> CpuDevice::native(compute::Buffer buffer) {
    auto& memory = at(buffer);
    if (!memory.exposed) {
        std::unique_lock lock(mutex_);
        memory.exposed = true;
        const bool told = memory.content != nullptr;
        lock.unlock();
        if (told) {
            drain();
            memory.content->expose();
        }
    }
    return compute::NativeBuffer{compute::NativeBuffer::Kind::host_pointer, reinterpret_cast<std::uintptr_t>(memory.data),
                                 memory.bytes};
}

void CpuDevice::destroy_buffer(compute::Buffer buffer) { retired_buffers_.put(buffers_.take(buffer.id), submitted_); }

void CpuDevice::free(backends::Retired<Memory>& buffers, backends::Retired<Recorded>& programs) {
    programs.release(UINT64_MAX, SIZE_MAX, [](Recorded&) {});
    buffers.release(UINT64_MAX, SIZE_MAX, [](Memory&) {});
}

void CpuDevice::drain() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return done_ == submitted_; });
}

Status CpuDevice::write(compute::Buffer buffer, std::uint64_t offset, std::span<const std::byte> bytes) {
    drain();
    const auto& memory = at(buffer);
    std::copy(bytes.begin(), bytes.end(), memory.data + offset);
    if (memory.content) memory.content->look_everywhere();
    return ok_status();
}

Status CpuDevice::read(compute::Buffer buffer, std::uint64_t offset, std::span<std::byte> bytes) {
    drain();
    std::copy_n(at(buffer).data + offset, bytes.size(), bytes.data());
    return ok_status();
}

Result<compute::Pipeline> CpuDevice::create_pipeline(int stage, std::uint32_t effects, compute::GroupSize) {
    const auto block = set_.select[stage](effects);
    if (block == nullptr) {
        return error(Code::internal, "stage " + std::string(compute::stage_table()[static_cast<std::size_t>(stage)].name) +
                                         " has no code for the effects " + std::to_string(effects));
    }
    pipelines_.push_back(block);
    return compute::Pipeline{static_cast<std::uint32_t>(pipelines_.size())};
}

Result<compute::Program> CpuDevice::compile(const compute::ProgramBuilder& builder, const WorldParams& params) {
    auto recorded = std::make_unique<Recorded>();
    recorded->params = params;
    const auto barriers = compute::plan_barriers(builder.ops());
    std::int64_t largest = 0;
    for (std::size_t n = 0; n < builder.ops().size(); ++n) {
        const auto& op = builder.ops()[n];
        Step step;
        step.barrier_before = barriers[n].memory || full_barriers_;
        if (const auto* d = std::get_if<compute::Dispatch>(&op)) {
            const auto& stage = compute::stage_table()[static_cast<std::size_t>(d->stage)];
            step.block = pipelines_[d->pipeline.id - 1];
            step.stage = &stage;
            step.effects = d->effects;
            for (const auto& binding : stage.bindings) {
                auto* memory = binding.exists(d->effects) ? &at(d->slots[static_cast<std::size_t>(binding.slot)]) : nullptr;
                step.buffers.push_back(memory != nullptr ? memory->data : nullptr);
                step.sizes.push_back(memory != nullptr ? memory->bytes : 0);
                step.bound.push_back(memory);
                if (memory != nullptr && binding.access != compute::Access::in) step.written.push_back(memory);
            }
            step.range = d->range;
            step.input = static_cast<std::size_t>(d->input);
            if (d->tiles.on()) {
                if (auto status = set_active(*d, stage, step); !status) return status;
            }
            largest = std::max(largest, area(d->range));
        } else if (const auto* copy = std::get_if<compute::Copy>(&op)) {
            step.from = at(copy->from).data + copy->from_offset;
            step.to = at(copy->to).data + copy->to_offset;
            step.bytes = static_cast<std::size_t>(copy->bytes); // within two buffers
            step.written.push_back(&at(copy->to));
        } else if (const auto* fill = std::get_if<compute::Fill>(&op)) {
            auto& to = at(fill->buffer);
            step.written.push_back(&to);
            step.to = to.data;
            step.bytes = to.bytes / 4 * 4;
            step.word = fill->word;
        } else if (const auto* stamp = std::get_if<compute::Timestamp>(&op)) {
            step.timestamp = static_cast<int>(recorded->timestamp_labels.size());
            recorded->timestamp_labels.push_back(stamp->label);
        }
        recorded->steps.push_back(std::move(step));
    }
    recorded->small = largest < small_pass;
    recorded->progress = std::make_unique<Progress[]>(std::max<std::size_t>(1, recorded->steps.size()));
    ++counters_.recordings;
    return compute::Program{programs_.add(std::move(recorded))};
}

Status CpuDevice::set_active(const compute::Dispatch& d, const compute::StageInfo& stage, Step& step) {
    const auto words = [&](compute::Buffer buffer) { return reinterpret_cast<std::uint32_t*>(at(buffer).data); };
    auto& active = step.active;
    active.activity = words(d.tiles.activity);
    active.flags = words(d.tiles.flags);
    active.counts = words(d.tiles.counts);
    active.rim = stage.extent == compute::Extent::rim;
    for (std::size_t b = 0; b < stage.bindings.size(); ++b) {
        const auto& binding = stage.bindings[b];
        if (binding.access == compute::Access::in || step.buffers[b] == nullptr) continue;
        using enum ActiveStage::Numbers;
        active.outputs.push_back({static_cast<std::byte*>(step.buffers[b]), binding.type == compute::Scalar::u32    ? counts
                                                                            : binding.type == compute::Scalar::vec4 ? memory
                                                                                                                    : field});
    }
    if (active.outputs.size() > ActiveStage::most_outputs)
        return error(Code::internal,
                     "'" + d.label + "' writes more than " + std::to_string(ActiveStage::most_outputs) + " buffers");
    return ok_status();
}

BlockContent* CpuDevice::content_of(Memory& memory, FieldLayout layout) {
    if (memory.bytes < layout.size() * 4) return nullptr;
    if (!memory.content) {
        auto content = std::make_unique<BlockContent>(layout, reinterpret_cast<const std::uint32_t*>(memory.data));
        const std::lock_guard lock(mutex_);
        memory.content = std::move(content);
        if (memory.exposed) memory.content->expose();
    }
    const auto& has = memory.content->blocks().layout;
    return has.nx == layout.nx && has.ny == layout.ny ? memory.content.get() : nullptr;
}

StageBlock CpuDevice::lean_block(int stage, std::uint32_t effects) const {
    const auto block = set_.select[stage](effects);
    const auto& base = instruction_sets().front();
    return &set_ != &base && block == base.select[stage](effects) ? nullptr : block;
}

void CpuDevice::set_content(const WorldParams& params, Step& step) {
    const FieldLayout layout{params.nx, params.ny};
    const auto& r = step.range;
    const bool whole = r.i0 == 0 && r.j0 == 0 && r.i1 >= layout.nx && r.j1 >= layout.ny;
    const bool tiles = step.active.activity != nullptr;
    if (step.stage->lacks.empty() || tiles || !whole) return;
    std::vector<BlockContent*> contents;
    for (auto* memory : step.bound) {
        contents.push_back(memory != nullptr ? content_of(*memory, layout) : nullptr);
        if (memory != nullptr && contents.back() == nullptr) return;
    }
    const auto stage = static_cast<int>(step.stage - compute::stage_table().data());
    step.content = content_stage(*step.stage, step.stage->lacks, step.effects, contents, step.buffers,
                                 [&](std::uint32_t effects) { return lean_block(stage, effects); });
}

void CpuDevice::prepare(Recorded& program) {
    for (auto& step : program.steps) {
        if (step.stage == nullptr) continue;
        try {
            set_content(program.params, step);
        } catch (const std::bad_alloc&) { // it computes everything then
        }
        step.rows_per_grab = std::max(1, step.rows() / (8 * pool_->size()));
        if (step.active.activity != nullptr) step.rows_per_grab = std::min(step.rows_per_grab, program.params.tile_size);
        if (step.stage->extent == compute::Extent::tile_lines) { // the lines of a tile store to the same numbers: by one thread
            const int size = program.params.tile_size;
            step.rows_per_grab = (step.rows_per_grab + size - 1) / size * size;
        }
    }
    program.prepared = true;
}

// A device at rest gets no submission that would free them.
void CpuDevice::destroy_program(compute::Program program) {
    retired_programs_.put(programs_.take(program.id), submitted_);
    if (finished_so_far() == submitted_) free(retired_buffers_, retired_programs_);
}

std::uint64_t CpuDevice::finished_so_far() {
    const std::lock_guard lock(mutex_);
    return done_;
}

Result<compute::Ticket> CpuDevice::submit_inputs(compute::Program program, std::span<const StepInput> inputs) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return queue_.size() < most_in_flight; });
    // What throws comes ahead of all that counts.
    auto* recorded = programs_.find(program.id);
    if (const auto& labels = recorded->timestamp_labels; labels.size() > 1) {
        auto& times = timings_[submitted_ + 1];
        times.clear();
        for (std::size_t n = 1; n < labels.size(); ++n) times.push_back({labels[n], 0});
        if (timings_.size() > kept_timings) timings_.erase(timings_.begin());
    }
    Submission next{submitted_ + 1, recorded, {inputs.begin(), inputs.end()}};
    next.stamps.resize(recorded->timestamp_labels.size());
    queue_.push_back(std::move(next));
    queue_.back().buffers = std::move(retired_buffers_);
    queue_.back().programs = std::move(retired_programs_);
    ++submitted_;
    ++counters_.submits;
    const compute::Ticket ticket{submitted_};
    if (!runner_.joinable()) {
        run_next(lock);
        return ticket;
    }
    lock.unlock();
    changed_.notify_all();
    return ticket;
}

bool CpuDevice::finished(compute::Ticket ticket) { return finished_so_far() >= ticket.value; }

Status CpuDevice::wait(compute::Ticket ticket) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return done_ >= ticket.value; });
    return ok_status();
}

Result<std::vector<compute::Timing>> CpuDevice::timings(compute::Ticket ticket) {
    const std::lock_guard lock(mutex_);
    const auto found = timings_.find(ticket.value);
    return found == timings_.end() || ticket.value > done_ ? std::vector<compute::Timing>{} : found->second;
}

void CpuDevice::device_thread() {
    compute::name_this_thread("wadi device");
    const compute::DefaultFloats floats;
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return stop_ || !queue_.empty(); });
        if (queue_.empty()) return;
        run_next(lock);
    }
}

void CpuDevice::run_next(std::unique_lock<std::mutex>& lock) {
    Submission& next = queue_.front(); // stays where it is while others are put behind it
    lock.unlock();
    execute(next);
    free(next.buffers, next.programs);
    lock.lock();
    done_ = next.ticket;
    if (const auto found = timings_.find(done_); found != timings_.end()) {
        for (std::size_t n = 1; n < next.stamps.size(); ++n)
            found->second[n - 1].milliseconds =
                std::chrono::duration<double, std::milli>(next.stamps[n] - next.stamps[n - 1]).count();
    }
    queue_.pop_front();
    changed_.notify_all();
}

void CpuDevice::look_into_written(const Step& step) {
    const compute::Range2& r = step.range;
    for (auto* memory : step.written) {
        auto* content = memory->content.get();
        if (content == nullptr) continue;
        const int nx = content->blocks().layout.nx, ny = content->blocks().layout.ny;
        switch (step.stage != nullptr ? step.stage->extent : compute::Extent::points) {
        case compute::Extent::strips:
            content->look({r.i0, r.j0 * STRIP, r.i1, r.j1 * STRIP});
            break;
        case compute::Extent::rim:
            for (const auto& side : {compute::Range2{0, 0, 1, ny}, {nx, 0, nx + 1, ny}, {0, 0, nx, 1}, {0, ny, nx, ny + 1}})
                content->look(side);
            break;
        default:
            content->look_everywhere();
        }
    }
}

void CpuDevice::run_rows(Step& step, const WorldParams& params, const StepInput& input, int first, int last) {
    if (step.content.on()) {
        const StageCall call{step.block, step.buffers.data(), step.sizes.data(), params, input, step.range};
        return run_by_content(step.content, call, first, last);
    }
    if (step.active.activity != nullptr) {
        run_active(step.active, {step.block, step.buffers.data(), step.sizes.data(), params, input, step.range}, first, last);
    } else if (step.block != nullptr) {
        step.block(step.buffers.data(), step.sizes.data(), &params, &input, step.range.i0, step.range.i1, step.range.j0 + first,
                   step.range.j0 + last);
    } else if (step.from != nullptr) {
        std::memcpy(step.to, step.from, step.bytes);
    } else if (step.to != nullptr) {
        for (std::size_t at = 0; at < step.bytes; at += 4) std::memcpy(step.to + at, &step.word, 4);
    }
}

// A barrier waits for rows, not for threads: one that the system has put aside holds nothing up but the rows it has taken.
void CpuDevice::execute(Submission& submission) {
    Recorded& program = *submission.program;
    const std::span<const StepInput> inputs = submission.inputs;
    auto& stamps = submission.stamps;
    if (!program.prepared) prepare(program);
    const std::size_t count = program.steps.size();
    for (std::size_t n = 0; n < count; ++n) {
        program.progress[n].next_row.store(0, std::memory_order_relaxed);
        program.progress[n].rows.set(program.steps[n].rows());
        program.progress[n].rows_to_run.store(program.steps[n].rows(), std::memory_order_relaxed);
    }
    const auto work = [&] {
        const compute::FlushedDenormals flushed(flush_denormals_);
        std::size_t waited = 0; // all steps before this one are done
        for (std::size_t n = 0; n < count; ++n) {
            auto& step = program.steps[n];
            auto& progress = program.progress[n];
            // A stamp is a step of its own between two barriers: nobody works on what it would then miss.
            const bool stamp = step.timestamp >= 0, behind_stamp = n > 0 && program.steps[n - 1].timestamp >= 0;
            if (step.barrier_before || stamp || behind_stamp) {
                for (; waited < n; ++waited) program.progress[waited].rows.wait();
            }
            const int rows = step.rows();
            for (;;) {
                const int first = progress.next_row.fetch_add(step.rows_per_grab, std::memory_order_relaxed);
                if (first >= rows) break;
                const int last = std::min(rows, first + step.rows_per_grab);
                if (stamp) {
                    stamps[static_cast<std::size_t>(step.timestamp)] = std::chrono::steady_clock::now();
                } else {
                    run_rows(step, program.params, inputs[step.input], first, last);
                    if (progress.rows_to_run.fetch_sub(last - first, std::memory_order_acq_rel) == last - first &&
                        !step.content.on())
                        look_into_written(step);
                }
                progress.rows.finish(last - first);
            }
        }
        for (; waited < count; ++waited) program.progress[waited].rows.wait();
    };
    if (program.small || pool_->size() == 1) {
        work();
    } else {
        pool_->run(std::ref(work)); // allocates nothing: nobody could catch it here
    }
}

const backends::Backend& cpu_backend() {
    static const backends::Backend backend = {
        "cpu",
        [](std::string&) {
            return std::vector<backends::DeviceInfo>{{"cpu", 0, processor_name(), compute::DeviceKind::cpu, physical_memory()}};
        },
        [](int, const compute::DeviceOptions& options) -> Result<std::unique_ptr<compute::Device>> {
            constexpr int most_threads = 256;
            if (options.threads < 0 || options.threads > most_threads) {
                return error(Code::bad_argument,
                             "threads: " + std::to_string(options.threads) + " is outside 0 ... " + std::to_string(most_threads));
            }
            const auto* set = choose_instruction_set(options.instruction_set);
            if (set == nullptr) {
                const std::string wanted = options.instruction_set;
                return error(Code::not_supported, wanted.empty()
                                                      ? "this build is for other processors than this one (WADI_CPU_SETS)"
                                                      : "this processor or build has no instruction set '" + wanted + "'");
            }
            const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
            try {
                auto device = std::make_unique<CpuDevice>(*set, options);
                device->start(options.threads == 0 ? std::min(cores, most_threads) : options.threads, options.run_jobs);
                return std::unique_ptr<compute::Device>(std::move(device));
            } catch (const std::exception& e) { // the system refuses memory
                return error(Code::out_of_memory, std::string("the CPU device cannot start: ") + e.what());
            }
        }};
    return backend;
}

} // namespace wadi::cpu
