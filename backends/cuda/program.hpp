// A compiled program: its calls with all arguments frozen, and the graphs that replay them.
#pragma once
#include "backends/cuda/plan.hpp"
#include "backends/cuda/submissions.hpp"

namespace wadi::cuda {

/// What a program refers to.
struct ProgramParts {
    Context& context;
    const Buffers& buffers;
    const Pipelines& pipelines;
    const Submissions& submissions;
};

class CompiledProgram {
  public:
    /// Errors: not_supported (too many groups), out_of_memory.
    static Result<std::unique_ptr<CompiledProgram>> compile(const ProgramParts& parts, const compute::ProgramBuilder& builder,
                                                            const WorldParams& params);
    ~CompiledProgram();
    CompiledProgram(const CompiledProgram&) = delete;
    CompiledProgram& operator=(const CompiledProgram&) = delete;

    /// Puts the program on the stream, for the submission in a submission slot.
    Status launch(std::size_t slot);
    /// Of a finished submission that ran in `slot`.
    Result<std::vector<compute::Timing>> timings(std::size_t slot);

  private:
    CompiledProgram(Context& context, const WorldParams& params, const StepInput* inputs)
        : c_(context), params_(params), inputs_(inputs) {}
    Status create_events();
    Status record_replays(const std::vector<std::vector<int>>& waits);
    Status add_nodes(cudaGraph_t graph, const std::vector<std::vector<int>>& waits, std::size_t slot);
    Status add_node(cudaGraphNode_t& node, cudaGraph_t graph, const std::vector<cudaGraphNode_t>& after, Call& call,
                    std::size_t slot);
    Status run(Call& call, std::size_t slot);
    cudaEvent_t event(std::size_t slot, std::size_t number) const { return events_[slot * timestamps_.size() + number]; }

    Context& c_;
    std::string label_;
    WorldParams params_;
    const StepInput* inputs_; // device address
    std::vector<Call> calls_;
    std::vector<cudaGraphExec_t>
        replays_;                         // one, or one per submission slot where each has events of its own; none without replay
    std::vector<cudaEvent_t> events_;     // timestamps_.size() per submission slot
    std::vector<std::string> timestamps_; // labels
};

} // namespace wadi::cuda
