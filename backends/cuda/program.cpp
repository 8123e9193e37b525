#include "backends/cuda/program.hpp"

namespace wadi::cuda {
namespace {

/// What cudaLaunchKernel and kernel nodes take: the addresses of the arguments, of which only kernels over active tiles and
/// fused ones have a fourth. They are copied during the call.
struct Arguments {
    Arguments(WorldParams& params, const StepInput* inputs, KernelCall& call)
        : input(inputs + call.input), addresses{&params, &input, call.slots.data(), call.tiles.data()} {}
    const StepInput* input; // device address
    void* addresses[4];
};

struct GraphOwner {
    cudaGraph_t graph = nullptr;
    Context& c;
    ~GraphOwner() {
        if (graph != nullptr) c.note(cudaGraphDestroy(graph), "cudaGraphDestroy");
    }
};

} // namespace

Result<std::unique_ptr<CompiledProgram>>
CompiledProgram::compile(const ProgramParts& parts, const compute::ProgramBuilder& builder, const WorldParams& params) {
    auto plan = plan_calls(parts.context, parts.buffers, parts.pipelines, builder);
    if (!plan) return plan.status();
    std::unique_ptr<CompiledProgram> program(new CompiledProgram(parts.context, params, parts.submissions.inputs()));
    program->label_ = builder.label();
    program->calls_ = std::move(plan->calls);
    for (const compute::Op& op : builder.ops()) {
        if (const auto* t = std::get_if<compute::Timestamp>(&op)) program->timestamps_.push_back(t->label);
    }
    if (Status s = program->create_events(); !s) return s;
    if (!parts.context.options.no_replay) {
        if (Status s = program->record_replays(plan->waits); !s) return s;
    }
    return program;
}

CompiledProgram::~CompiledProgram() {
    c_.wait_idle();
    const CurrentContext current(c_);
    for (cudaGraphExec_t replay : replays_) {
        if (replay != nullptr) c_.note(cudaGraphExecDestroy(replay), "cudaGraphExecDestroy", label_);
    }
    for (cudaEvent_t e : events_) {
        if (e != nullptr) c_.note(cudaEventDestroy(e), "cudaEventDestroy", label_);
    }
}

Status CompiledProgram::create_events() {
    events_.resize(timestamps_.size() * Submissions::most_in_flight, nullptr);
    for (cudaEvent_t& e : events_) {
        if (Status s = c_.check(cudaEventCreate(&e), "cudaEventCreate", label_); !s) return s;
    }
    return ok_status();
}

Status CompiledProgram::record_replays(const std::vector<std::vector<int>>& waits) {
    replays_.resize(timestamps_.empty() ? 1 : Submissions::most_in_flight, nullptr);
    for (std::size_t slot = 0; slot < replays_.size(); ++slot) {
        GraphOwner owner{nullptr, c_};
        if (Status s = c_.check(cudaGraphCreate(&owner.graph, 0), "cudaGraphCreate", label_); !s) return s;
        if (Status s = add_nodes(owner.graph, waits, slot); !s) return s;
        if (Status s = c_.check(cudaGraphInstantiate(&replays_[slot], owner.graph, 0), "cudaGraphInstantiate", label_); !s)
            return s;
        // So that the first launch does nothing that later ones do not.
        if (Status s = c_.check(cudaGraphUpload(replays_[slot], c_.stream), "cudaGraphUpload", label_); !s) return s;
        ++c_.counters.recordings;
    }
    return ok_status();
}

Status CompiledProgram::add_nodes(cudaGraph_t graph, const std::vector<std::vector<int>>& waits, std::size_t slot) {
    std::vector<cudaGraphNode_t> nodes(calls_.size(), nullptr);
    for (std::size_t n = 0; n < calls_.size(); ++n) {
        std::vector<cudaGraphNode_t> after;
        for (const int earlier : waits[n]) after.push_back(nodes[static_cast<std::size_t>(earlier)]);
        if (Status s = add_node(nodes[n], graph, after, calls_[n], slot); !s) return s;
    }
    return ok_status();
}

Status CompiledProgram::add_node(cudaGraphNode_t& node, cudaGraph_t graph, const std::vector<cudaGraphNode_t>& after, Call& call,
                                 std::size_t slot) {
    if (auto* k = std::get_if<KernelCall>(&call)) {
        Arguments arguments(params_, inputs_, *k);
        cudaKernelNodeParams kernel{};
        kernel.func = const_cast<void*>(k->kernel);
        kernel.gridDim = k->groups;
        kernel.blockDim = k->threads;
        kernel.kernelParams = arguments.addresses;
        return c_.check(cudaGraphAddKernelNode(&node, graph, after.data(), after.size(), &kernel), "cudaGraphAddKernelNode",
                        label_);
    }
    if (const auto* copy = std::get_if<CopyCall>(&call)) {
        const cudaError_t r = cudaGraphAddMemcpyNode1D(&node, graph, after.data(), after.size(), copy->to, copy->from,
                                                       copy->bytes, cudaMemcpyDefault);
        return c_.check(r, "cudaGraphAddMemcpyNode1D", label_);
    }
    if (const auto* fill = std::get_if<FillCall>(&call)) {
        cudaMemsetParams memset{};
        memset.dst = fill->to;
        memset.elementSize = sizeof(fill->word);
        memset.value = fill->word;
        memset.width = fill->words;
        memset.height = 1;
        return c_.check(cudaGraphAddMemsetNode(&node, graph, after.data(), after.size(), &memset), "cudaGraphAddMemsetNode",
                        label_);
    }
    if (const auto* t = std::get_if<TimestampCall>(&call)) {
        const cudaError_t r = cudaGraphAddEventRecordNode(&node, graph, after.data(), after.size(), event(slot, t->number));
        return c_.check(r, "cudaGraphAddEventRecordNode", label_);
    }
    return c_.check(cudaGraphAddEmptyNode(&node, graph, after.data(), after.size()), "cudaGraphAddEmptyNode", label_);
}

Status CompiledProgram::launch(std::size_t slot) {
    if (!replays_.empty()) {
        return c_.check(cudaGraphLaunch(replays_[replays_.size() == 1 ? 0 : slot], c_.stream), "cudaGraphLaunch", label_);
    }
    for (Call& call : calls_) {
        if (Status s = run(call, slot); !s) return s;
    }
    ++c_.counters.recordings;
    return ok_status();
}

// The stream alone keeps the order.
Status CompiledProgram::run(Call& call, std::size_t slot) {
    if (auto* k = std::get_if<KernelCall>(&call)) {
        Arguments arguments(params_, inputs_, *k);
        const cudaError_t r = cudaLaunchKernel(k->kernel, k->groups, k->threads, arguments.addresses, 0, c_.stream);
        return c_.check(r, "cudaLaunchKernel", label_);
    }
    if (const auto* copy = std::get_if<CopyCall>(&call)) {
        const cudaError_t r = cudaMemcpyAsync(copy->to, copy->from, copy->bytes, cudaMemcpyDefault, c_.stream);
        return c_.check(r, "cudaMemcpyAsync", label_);
    }
    if (const auto* fill = std::get_if<FillCall>(&call)) {
        const auto to = reinterpret_cast<CUdeviceptr>(fill->to);
        return c_.check(c_.driver.fill_words(to, fill->word, fill->words, c_.stream), "cuMemsetD32Async");
    }
    if (const auto* t = std::get_if<TimestampCall>(&call)) {
        return c_.check(cudaEventRecord(event(slot, t->number), c_.stream), "cudaEventRecord", label_);
    }
    return ok_status();
}

Result<std::vector<compute::Timing>> CompiledProgram::timings(std::size_t slot) {
    std::vector<compute::Timing> timings;
    for (std::size_t n = 1; n < timestamps_.size(); ++n) {
        float milliseconds = 0;
        const cudaError_t r = cudaEventElapsedTime(&milliseconds, event(slot, n - 1), event(slot, n));
        if (Status s = c_.check(r, "cudaEventElapsedTime", label_); !s) return s;
        timings.push_back({timestamps_[n], static_cast<double>(milliseconds)});
    }
    return timings;
}

} // namespace wadi::cuda
