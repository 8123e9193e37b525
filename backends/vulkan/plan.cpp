#include "backends/vulkan/plan.hpp"
#include "engine/compute/hazards.hpp"
#include <algorithm>
#include <compare>
#include <map>

namespace wadi::vulkan {
namespace {

// Stage, which input, and the ids of the slots, 0 where nothing is bound.
struct SetKey {
    int stage, input;
    std::vector<std::uint32_t> slots;
    friend auto operator<=>(const SetKey&, const SetKey&) = default;
};

Kinds kinds_of(const compute::Op& op) {
    return {std::holds_alternative<compute::Dispatch>(op),
            std::holds_alternative<compute::Copy>(op) || std::holds_alternative<compute::Fill>(op)};
}

class Planner {
  public:
    Planner(const ProgramParts& parts, const compute::ProgramBuilder& builder, VkBuffer params, Plan& plan)
        : p_(parts), c_(parts.context), builder_(builder), params_(params), plan_(plan) {}

    Status run() {
        if (Status s = create_sets(); !s) return s;
        const auto& ops = builder_.ops();
        const auto planned = compute::plan_barriers(ops);
        Kinds before;
        for (std::size_t n = 0; n < ops.size(); ++n) {
            if (c_.options.full_barriers) {
                constexpr Kinds all{.compute = true, .transfer = true};
                plan_.commands.emplace_back(BarrierCommand{all, {.compute = true, .transfer = true, .indirect = true}});
            } else if (planned[n].memory || planned[n].groups) {
                Kinds after = kinds_until_barrier(ops, planned, n);
                after.indirect = planned[n].groups;
                if (!before.compute && !before.transfer) before.compute = true; // an earlier submission's
                plan_.commands.emplace_back(BarrierCommand{before, after});
            }
            const Kinds kinds = kinds_of(ops[n]);
            before = {before.compute || kinds.compute, before.transfer || kinds.transfer};
            if (Status s = std::visit([&](const auto& op) { return add(op); }, ops[n]); !s) return s;
        }
        if (host_reads_) plan_.commands.emplace_back(BarrierCommand{{.transfer = true}, {.host = true}});
        return ok_status();
    }

  private:
    // A barrier names all kinds of commands ahead of it in the program, not only those since the previous barrier:
    // so the last barrier ahead of an operation alone orders it after everything it conflicts with.
    static Kinds kinds_until_barrier(const std::vector<compute::Op>& ops, const std::vector<compute::Barrier>& planned,
                                     std::size_t first) {
        Kinds all = kinds_of(ops[first]);
        for (std::size_t n = first + 1; n < ops.size() && !planned[n].memory; ++n) {
            const Kinds kinds = kinds_of(ops[n]);
            all = {all.compute || kinds.compute, all.transfer || kinds.transfer};
        }
        return all;
    }

    Status too_many(const compute::Dispatch& d, const std::string& what, const std::string& most) const {
        return error(Code::not_supported, "program '" + builder_.label() + "', dispatch '" + d.label + "': " + what + "; " +
                                              c_.capabilities.name + " allows " + most);
    }

    static bool marks(int stage) { return compute::stage_table()[static_cast<std::size_t>(stage)].marks; }

    static SetKey key_of(const compute::Dispatch& d) {
        SetKey key{d.stage, d.input, {}};
        for (const auto& binding : compute::stage_table()[static_cast<std::size_t>(d.stage)].bindings)
            key.slots.push_back(binding.exists(d.effects) ? d.slots[static_cast<std::size_t>(binding.slot)].id : 0);
        if (marks(d.stage)) key.slots.insert(key.slots.end(), {d.tiles.list.id, d.tiles.activity.id});
        return key;
    }

    // Dispatches of one stage with the same buffers and input share a set.
    Status create_sets() {
        std::uint32_t storage = 0;
        for (const compute::Op& op : builder_.ops()) {
            const auto* d = std::get_if<compute::Dispatch>(&op);
            if (d == nullptr) continue;
            if (sets_.emplace(key_of(*d), VkDescriptorSet{VK_NULL_HANDLE}).second)
                storage += static_cast<std::uint32_t>(key_of(*d).slots.size());
        }
        if (sets_.empty()) return ok_status();
        const auto count = static_cast<std::uint32_t>(sets_.size());
        // At least one storage descriptor: a size of zero is not allowed, and a stage may have no binding.
        const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, first_slot_binding * count},
                                              {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, std::max(storage, 1u)}};
        auto info = vk_struct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
        info.maxSets = count;
        info.poolSizeCount = 2;
        info.pPoolSizes = sizes;
        const VkResult r = c_.vk.vkCreateDescriptorPool(c_.device, &info, nullptr, &plan_.descriptors);
        if (Status s = c_.check(r, "vkCreateDescriptorPool", builder_.label()); !s) return s;
        // Dispatches of the same buffers wait for each other: for several inputs they may share what stands in for absent ones.
        std::map<SetKey, std::uint64_t> slices;
        for (auto& [key, set] : sets_) {
            const std::uint64_t slice = slices.try_emplace({key.stage, 0, key.slots}, slices.size()).first->second;
            if (Status s = write_set(key, set, p_.buffers.null_slice(slice)); !s) return s;
        }
        return ok_status();
    }

    Status write_set(const SetKey& key, VkDescriptorSet& set, const VkDescriptorBufferInfo& absent) {
        auto info = vk_struct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
        info.descriptorPool = plan_.descriptors;
        info.descriptorSetCount = 1;
        info.pSetLayouts = &p_.pipelines.stage(key.stage).set_layout;
        const VkResult r = c_.vk.vkAllocateDescriptorSets(c_.device, &info, &set);
        if (Status s = c_.check(r, "vkAllocateDescriptorSets", builder_.label()); !s) return s;
        std::vector<VkDescriptorBufferInfo> buffers(first_slot_binding + key.slots.size());
        buffers[world_binding] = {params_, 0, sizeof(WorldParams)};
        buffers[input_binding] = {p_.submissions.input_buffer(), static_cast<VkDeviceSize>(key.input) * Submissions::input_stride,
                                  sizeof(StepInput)};
        for (std::size_t slot = 0; slot < key.slots.size(); ++slot) {
            const Memory* memory = p_.buffers.find({key.slots[slot]});
            buffers[first_slot_binding + slot] =
                memory != nullptr ? VkDescriptorBufferInfo{memory->buffer, 0, VK_WHOLE_SIZE} : absent;
        }
        std::vector<VkWriteDescriptorSet> writes(buffers.size());
        for (std::uint32_t b = 0; b < writes.size(); ++b) {
            writes[b] = vk_struct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
            writes[b].dstSet = set;
            writes[b].dstBinding = b;
            writes[b].descriptorCount = 1;
            writes[b].descriptorType =
                b < first_slot_binding ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
            writes[b].pBufferInfo = &buffers[b];
        }
        c_.vk.vkUpdateDescriptorSets(c_.device, static_cast<std::uint32_t>(writes.size()), writes.data(), 0, nullptr);
        c_.counters.descriptor_writes += writes.size();
        return ok_status();
    }

    Status add(const compute::Dispatch& d) {
        if (d.range.i1 <= d.range.i0 || d.range.j1 <= d.range.j0) return ok_status();
        const compute::StageInfo& info = compute::stage_table()[static_cast<std::size_t>(d.stage)];
        if (d.tiles.on() && info.extent != compute::Extent::rim) return add_over_tiles(d);
        const StagePipeline& pipeline = p_.pipelines.at(d.pipeline);
        const auto groups = [](int first, int last, std::uint32_t size) {
            return (static_cast<std::uint32_t>(last - first) + size - 1) / size;
        };
        const auto columns = info.fused() ? std::uint32_t{FUSED_COLUMNS} : pipeline.group_x;
        const auto rows = info.fused() ? std::uint32_t{FUSED_ROWS} : pipeline.group_y;
        const std::uint32_t x = groups(d.range.i0, d.range.i1, columns), y = groups(d.range.j0, d.range.j1, rows);
        if (x > c_.limits.group_count[0] || y > c_.limits.group_count[1]) {
            return too_many(d, std::to_string(x) + " x " + std::to_string(y) + " groups",
                            std::to_string(c_.limits.group_count[0]) + " x " + std::to_string(c_.limits.group_count[1]));
        }
        plan_.commands.emplace_back(
            DispatchCommand{pipeline.handle, p_.pipelines.stage(d.stage).layout, sets_.at(key_of(d)), x, y});
        return ok_status();
    }

    Status add_over_tiles(const compute::Dispatch& d) {
        const Memory* list = p_.buffers.find(d.tiles.list);
        if (list->bytes / 4 > c_.limits.group_count[0]) {
            return too_many(d, std::to_string(list->bytes / 4) + " active tiles", std::to_string(c_.limits.group_count[0]));
        }
        const VkBuffer groups = p_.buffers.find(d.tiles.dispatch)->buffer;
        const bool fused = compute::stage_table()[static_cast<std::size_t>(d.stage)].fused();
        plan_.commands.emplace_back(DispatchCommand{p_.pipelines.at(d.pipeline).handle, p_.pipelines.stage(d.stage).layout,
                                                    sets_.at(key_of(d)), 0, 0, groups, fused ? VkDeviceSize{16} : 0});
        return ok_status();
    }

    Status add(const compute::Copy& copy) {
        if (copy.bytes == 0) return ok_status();
        const Memory& to = *p_.buffers.find(copy.to);
        plan_.commands.emplace_back(
            CopyCommand{p_.buffers.find(copy.from)->buffer, to.buffer, {copy.from_offset, copy.to_offset, copy.bytes}});
        host_reads_ |= to.mapped != nullptr;
        return ok_status();
    }

    Status add(const compute::Fill& fill) {
        plan_.commands.emplace_back(FillCommand{p_.buffers.find(fill.buffer)->buffer, fill.word});
        return ok_status();
    }

    Status add(const compute::Timestamp&) {
        plan_.commands.emplace_back(TimestampCommand{timestamps_++});
        return ok_status();
    }

    const ProgramParts& p_;
    Context& c_;
    const compute::ProgramBuilder& builder_;
    VkBuffer params_;
    Plan& plan_;
    std::map<SetKey, VkDescriptorSet> sets_;
    std::uint32_t timestamps_ = 0;
    bool host_reads_ = false; // a copy goes to mapped memory
};

} // namespace

Status plan_commands(const ProgramParts& parts, const compute::ProgramBuilder& builder, VkBuffer params, Plan& plan) {
    return Planner(parts, builder, params, plan).run();
}

} // namespace wadi::vulkan
