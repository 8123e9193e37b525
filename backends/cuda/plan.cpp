#include "backends/cuda/plan.hpp"
#include "engine/compute/hazards.hpp"
#include <algorithm>

namespace wadi::cuda {
namespace {

constexpr std::uint32_t most_groups_x = 0x7fffffff, most_groups_y = 65535; // of every compute capability that CUDA supports

constexpr std::uint32_t active_groups =
    4096; // several for each place on the largest GPUs, so that all end at nearly the same time

// A timestamp waits for all that is ahead of it and holds up all that follows, so that it separates what it times.
void add_timestamps(const std::vector<compute::Op>& ops, std::vector<std::vector<int>>& waits) {
    int last = -1; // newest timestamp ahead of operation n
    for (int n = 0; n < static_cast<int>(ops.size()); ++n) {
        auto& before = waits[static_cast<std::size_t>(n)];
        const bool timestamp = std::holds_alternative<compute::Timestamp>(ops[static_cast<std::size_t>(n)]);
        if (last >= 0) before.push_back(last);
        if (!timestamp) continue;
        for (int earlier = last + 1; earlier < n; ++earlier) before.push_back(earlier);
        last = n;
    }
}

// Drops each edge that a longer path implies: on the GPU every edge between branches of the graph is a wait.
void keep_direct_edges(std::vector<std::vector<int>>& waits) {
    std::vector<std::vector<bool>> implied(waits.size()); // implied[n][m]: n runs after m
    for (std::size_t n = 0; n < waits.size(); ++n) {
        implied[n].assign(n, false);
        std::vector<int> direct;
        std::sort(waits[n].rbegin(), waits[n].rend()); // newest first
        for (const int wait : waits[n]) {
            const auto m = static_cast<std::size_t>(wait);
            if (implied[n][m]) continue;
            direct.push_back(wait);
            implied[n][m] = true;
            for (std::size_t k = 0; k < m; ++k) implied[n][k] = implied[n][k] || implied[m][k];
        }
        waits[n] = std::move(direct);
    }
}

std::vector<std::vector<int>> plan_waits(const std::vector<compute::Op>& ops, bool full_barriers) {
    std::vector<std::vector<int>> waits;
    if (full_barriers) {
        for (int n = 0; n < static_cast<int>(ops.size()); ++n)
            waits.push_back(n == 0 ? std::vector<int>{} : std::vector<int>{n - 1});
        return waits;
    }
    waits = compute::plan_dependencies(ops);
    add_timestamps(ops, waits);
    keep_direct_edges(waits);
    return waits;
}

class Planner {
  public:
    Planner(const Buffers& buffers, const Pipelines& pipelines, const compute::ProgramBuilder& builder)
        : buffers_(buffers), pipelines_(pipelines), builder_(builder) {}

    Result<Call> plan(const compute::Dispatch& d) const {
        const StagePipeline& pipeline = pipelines_.at(d.pipeline);
        const compute::StageInfo& info = compute::stage_table()[static_cast<std::size_t>(d.stage)];
        KernelCall call{pipeline.kernel, {}, {}, {}, {}, static_cast<std::size_t>(d.input)};
        for (const auto& binding : info.bindings)
            call.slots.push_back(binding.exists(d.effects) ? at(d.slots[static_cast<std::size_t>(binding.slot)]).data : nullptr);
        if (call.slots.empty()) call.slots.push_back(nullptr); // the kernel's struct of slots holds at least one
        if (d.tiles.on()) {
            call.tiles = {at(d.tiles.list).data, at(d.tiles.dispatch).data, at(d.tiles.activity).data};
        }
        if (d.range.i1 <= d.range.i0 || d.range.j1 <= d.range.j0) return Call(NoCall{});
        const auto groups = [](int first, int last, int size) {
            return static_cast<std::uint32_t>((last - first - 1) / size + 1);
        };
        const int columns = info.fused() ? FUSED_COLUMNS : pipeline.group_x;
        const int rows = info.fused() ? FUSED_ROWS : pipeline.group_y;
        call.groups = dim3(groups(d.range.i0, d.range.i1, columns), groups(d.range.j0, d.range.j1, rows));
        call.threads = dim3(static_cast<std::uint32_t>(pipeline.group_x), static_cast<std::uint32_t>(pipeline.group_y));
        // Enough groups to fill the GPU; each takes every so many-th tile of the list.
        if (d.tiles.on() && info.extent != compute::Extent::rim) call.groups = dim3(active_groups);
        if (call.groups.x > most_groups_x || call.groups.y > most_groups_y) {
            return error(Code::not_supported, "program '" + builder_.label() + "', dispatch '" + d.label +
                                                  "': " + std::to_string(call.groups.x) + " x " + std::to_string(call.groups.y) +
                                                  " groups; CUDA allows " + std::to_string(most_groups_x) + " x " +
                                                  std::to_string(most_groups_y));
        }
        return Call(std::move(call));
    }

    Result<Call> plan(const compute::Copy& copy) const {
        if (copy.bytes == 0) return Call(NoCall{});
        return Call(CopyCall{at(copy.to).data + copy.to_offset, at(copy.from).data + copy.from_offset, copy.bytes});
    }

    Result<Call> plan(const compute::Fill& fill) const {
        const Memory& memory = at(fill.buffer);
        if (memory.bytes < 4) return Call(NoCall{});
        return Call(FillCall{memory.data, memory.bytes / 4, fill.word});
    }

    Result<Call> plan(const compute::Timestamp&) { return Call(TimestampCall{timestamps_++}); }

  private:
    const Memory& at(compute::Buffer buffer) const { return *buffers_.find(buffer); }

    const Buffers& buffers_;
    const Pipelines& pipelines_;
    const compute::ProgramBuilder& builder_;
    std::size_t timestamps_ = 0;
};

} // namespace

Result<Plan> plan_calls(const Context& context, const Buffers& buffers, const Pipelines& pipelines,
                        const compute::ProgramBuilder& builder) {
    Planner planner(buffers, pipelines, builder);
    Plan plan;
    for (const compute::Op& op : builder.ops()) {
        auto call = std::visit([&](const auto& o) { return planner.plan(o); }, op);
        if (!call) return call.status();
        plan.calls.push_back(std::move(*call));
    }
    plan.waits = plan_waits(builder.ops(), context.options.full_barriers);
    return plan;
}

} // namespace wadi::cuda
