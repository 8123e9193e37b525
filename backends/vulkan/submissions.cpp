#include "backends/vulkan/submissions.hpp"
#include "backends/vulkan/host_copies.hpp"
#include <algorithm>

namespace wadi::vulkan {
namespace {

// Handles that are no pointers on 32-bit systems travel as numbers.
VkSemaphore semaphore_of(const compute::SyncPoint& point) { return reinterpret_cast<VkSemaphore>(point.semaphore); }

} // namespace

Status Submissions::open() {
    c_.capabilities.queue_depth = most_in_flight;
    static_assert(sizeof(StepInput) <= input_stride);
    auto inputs =
        allocate(c_, compute::most_inputs * input_stride, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, Place::device, "step inputs");
    if (!inputs) return inputs.status();
    inputs_ = std::move(*inputs);
    auto pool = vk_struct<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = c_.queue_family;
    if (Status s = c_.check(c_.vk.vkCreateCommandPool(c_.device, &pool, nullptr, &pool_), "vkCreateCommandPool"); !s) return s;
    std::array<VkCommandBuffer, 2 * most_in_flight> commands{};
    auto info = vk_struct<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    info.commandPool = pool_;
    info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 2 * most_in_flight;
    const VkResult r = c_.vk.vkAllocateCommandBuffers(c_.device, &info, commands.data());
    if (Status s = c_.check(r, "vkAllocateCommandBuffers"); !s) return s;
    for (std::uint32_t n = 0; n < most_in_flight; ++n) {
        slots_[n].input = commands[2 * n];
        slots_[n].own = commands[2 * n + 1];
    }
    if (c_.timeline) {
        auto type = vk_struct<VkSemaphoreTypeCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
        type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
        auto semaphore = vk_struct<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
        semaphore.pNext = &type;
        return c_.check(c_.vk.vkCreateSemaphore(c_.device, &semaphore, nullptr, &timeline_), "vkCreateSemaphore");
    }
    for (Slot& slot : slots_) {
        const auto fence = vk_struct<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
        if (Status s = c_.check(c_.vk.vkCreateFence(c_.device, &fence, nullptr, &slot.fence), "vkCreateFence"); !s) return s;
    }
    return ok_status();
}

Submissions::~Submissions() {
    if (timeline_ != VK_NULL_HANDLE) c_.vk.vkDestroySemaphore(c_.device, timeline_, nullptr);
    for (const Slot& slot : slots_) {
        if (slot.fence != VK_NULL_HANDLE) c_.vk.vkDestroyFence(c_.device, slot.fence, nullptr);
    }
    if (pool_ != VK_NULL_HANDLE) c_.vk.vkDestroyCommandPool(c_.device, pool_, nullptr);
    release(c_, inputs_);
}

Result<std::uint32_t> Submissions::acquire() {
    const std::uint32_t slot = slot_of(last_ + 1);
    if (Status s = wait({slots_[slot].ticket}); !s) {
        if (s.code != Code::not_ready) return s;
        return error(Code::not_ready, "the host has not yet reached what it promised for " + std::to_string(most_in_flight) +
                                          " recorded submissions; submit those command buffers first");
    }
    return slot;
}

// Also the boundary between submissions: all earlier work is done and seen before anything of this one starts.
void Submissions::record_boundary(VkCommandBuffer commands, std::span<const StepInput> inputs, const Update& update) {
    const Kinds all{.compute = true, .transfer = true};
    record_barrier(c_, commands, all, all);
    for (std::size_t n = 0; n < inputs.size(); ++n)
        c_.vk.vkCmdUpdateBuffer(commands, inputs_.buffer, n * input_stride, sizeof(StepInput), &inputs[n]);
    if (update.to != VK_NULL_HANDLE) c_.vk.vkCmdUpdateBuffer(commands, update.to, 0, update.bytes.size(), update.bytes.data());
    record_barrier(c_, commands, {.transfer = true}, {.compute = true});
}

Status Submissions::record_inputs(const Slot& slot, std::span<const StepInput> inputs, const Update& update) {
    auto info = vk_struct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    if (Status s = c_.check(c_.vk.vkBeginCommandBuffer(slot.input, &info), "vkBeginCommandBuffer"); !s) return s;
    record_boundary(slot.input, inputs, update);
    return c_.check(c_.vk.vkEndCommandBuffer(slot.input), "vkEndCommandBuffer");
}

Result<compute::Ticket> Submissions::submit(std::uint32_t index, std::span<const StepInput> inputs, const Update& update,
                                            VkCommandBuffer commands, compute::Program program) {
    Slot& slot = slots_[index];
    if (recording()) {
        record_boundary(host_commands_, inputs, update);
        c_.vk.vkCmdExecuteCommands(host_commands_, 1, &commands);
    } else {
        if (Status s = record_inputs(slot, inputs, update); !s) return s;
        const VkCommandBuffer both[] = {slot.input, commands};
        if (Status s = send(slot, both); !s) return s;
    }
    return give_out(slot, program);
}

compute::Ticket Submissions::give_out(Slot& slot, compute::Program program) {
    ++c_.counters.submits;
    slot.ticket = ++last_;
    slot.program = program;
    slot.promise = recording() ? promise_ : compute::SyncPoint{};
    if (recording()) last_recorded_ = last_;
    return {last_};
}

template <class Record> Result<compute::Ticket> Submissions::submit_once(Record record) {
    if (Status s = recording() ? ok_status() : check_order(); !s) return s;
    auto index = acquire();
    if (!index) return index.status();
    Slot& slot = slots_[*index];
    if (recording()) {
        record(host_commands_);
    } else {
        auto info = vk_struct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
        info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
        if (Status s = c_.check(c_.vk.vkBeginCommandBuffer(slot.own, &info), "vkBeginCommandBuffer"); !s) return s;
        record(slot.own);
        if (Status s = c_.check(c_.vk.vkEndCommandBuffer(slot.own), "vkEndCommandBuffer"); !s) return s;
        if (Status s = send(slot, {&slot.own, 1}); !s) return s;
    }
    return give_out(slot, {});
}

Result<compute::Ticket> Submissions::copy_to_image(const compute::BufferRows& from, const compute::HostImage& to) {
    const VkBuffer buffer = buffers_.find(from.buffer)->buffer;
    return submit_once([&](VkCommandBuffer commands) { record_image_copy(c_, commands, buffer, from, to); });
}

Result<compute::Ticket> Submissions::copy_from(const compute::HostRows& from, compute::Buffer to) {
    const VkBuffer buffer = buffers_.find(to)->buffer;
    return submit_once([&](VkCommandBuffer commands) { record_rows_copy(c_, commands, from, buffer); });
}

Status Submissions::send(const Slot& slot, std::span<const VkCommandBuffer> commands) {
    const std::uint64_t ticket = last_ + 1;
    const std::vector<VkPipelineStageFlags> stages(wait_semaphores_.size(), VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
    auto value = vk_struct<VkTimelineSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO);
    value.waitSemaphoreValueCount = static_cast<std::uint32_t>(wait_values_.size());
    value.pWaitSemaphoreValues = wait_values_.data();
    value.signalSemaphoreValueCount = 1;
    value.pSignalSemaphoreValues = &ticket;
    auto info = vk_struct<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    info.commandBufferCount = static_cast<std::uint32_t>(commands.size());
    info.pCommandBuffers = commands.data();
    if (c_.timeline) {
        info.pNext = &value;
        info.waitSemaphoreCount = static_cast<std::uint32_t>(wait_semaphores_.size());
        info.pWaitSemaphores = wait_semaphores_.data();
        info.pWaitDstStageMask = stages.data();
        info.signalSemaphoreCount = 1;
        info.pSignalSemaphores = &timeline_;
    } else if (Status s = c_.check(c_.vk.vkResetFences(c_.device, 1, &slot.fence), "vkResetFences"); !s) {
        return s;
    }
    if (Status s = c_.check(c_.vk.vkQueueSubmit(c_.queue, 1, &info, slot.fence), "vkQueueSubmit"); !s) return s;
    wait_semaphores_.clear();
    wait_values_.clear();
    return ok_status();
}

Status Submissions::check_timeline() const {
    return c_.timeline ? ok_status() : error(Code::not_supported, c_.capabilities.name + " has no timeline semaphores");
}

Status Submissions::wait_before(std::span<const compute::SyncPoint> points) {
    if (Status s = check_timeline(); !s) return s;
    for (const auto& point : points) {
        wait_semaphores_.push_back(semaphore_of(point));
        wait_values_.push_back(point.value);
    }
    return ok_status();
}

Status Submissions::signal_after(const compute::SyncPoint& point) {
    if (Status s = check_timeline(); !s) return s;
    if (Status s = check_order(); !s) return s;
    const VkSemaphore semaphore = semaphore_of(point);
    auto value = vk_struct<VkTimelineSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO);
    value.signalSemaphoreValueCount = 1;
    value.pSignalSemaphoreValues = &point.value;
    auto info = vk_struct<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    info.pNext = &value;
    info.signalSemaphoreCount = 1;
    info.pSignalSemaphores = &semaphore;
    return c_.check(c_.vk.vkQueueSubmit(c_.queue, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit");
}

Status Submissions::wait_event(void* event) { return record_event(event); }

Status Submissions::record_event(void*) { return compute::no_host_sync(c_.capabilities.backend, "CUDA events"); }

Status Submissions::begin_recording(void* commands, const compute::SyncPoint& promise) {
    if (Status s = check_timeline(); !s) return s;
    host_commands_ = static_cast<VkCommandBuffer>(commands);
    promise_ = promise;
    return ok_status();
}

Status Submissions::end_recording() {
    // The host's own commands behind ours see what we wrote.
    const Kinds all{.compute = true, .transfer = true};
    record_barrier(c_, host_commands_, all, all);
    host_commands_ = VK_NULL_HANDLE;
    return ok_status();
}

Status Submissions::check_order() {
    if (recording()) return error(Code::not_ready, "a recording into the host's command buffer is under way");
    auto done = finished({last_recorded_});
    if (!done) return done.status();
    if (*done) return ok_status();
    return error(Code::not_ready, "work recorded into the host's command buffer has not run yet: its promised semaphore is not "
                                  "reached, and what is asked for would overtake it");
}

Result<std::uint64_t> Submissions::value_of(VkSemaphore semaphore) {
    std::uint64_t value = 0;
    const VkResult r = c_.vk.vkGetSemaphoreCounterValueKHR(c_.device, semaphore, &value);
    if (Status s = c_.check(r, "vkGetSemaphoreCounterValueKHR"); !s) return s;
    return value;
}

Result<bool> Submissions::finished(compute::Ticket ticket) {
    if (ticket.value <= finished_) return true;
    const Slot& slot = slots_[slot_of(ticket.value)];
    if (slot.promise.semaphore != 0) {
        auto value = value_of(semaphore_of(slot.promise));
        if (!value) return value.status();
        if (*value >= slot.promise.value) finished_ = ticket.value;
    } else if (c_.timeline) {
        auto value = value_of(timeline_);
        if (!value) return value.status();
        // Drivers may report the largest value once the device is lost.
        if (*value > last_) return c_.check(VK_ERROR_DEVICE_LOST, "vkGetSemaphoreCounterValueKHR");
        finished_ = std::max(finished_, *value);
    } else {
        const VkResult r = c_.vk.vkGetFenceStatus(c_.device, slot.fence);
        if (r == VK_NOT_READY) return false;
        if (Status s = c_.check(r, "vkGetFenceStatus"); !s) return s;
        finished_ = ticket.value;
    }
    return ticket.value <= finished_;
}

Status Submissions::wait(compute::Ticket ticket) {
    auto done = finished(ticket);
    if (!done) return done.status();
    if (*done) return ok_status();
    const Slot& slot = slots_[slot_of(ticket.value)];
    if (slot.promise.semaphore != 0)
        return error(Code::not_ready, "ticket " + std::to_string(ticket.value) +
                                          " was recorded into the host's command buffer, which has not run yet");
    VkResult r = VK_SUCCESS;
    if (c_.timeline) {
        auto info = vk_struct<VkSemaphoreWaitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO);
        info.semaphoreCount = 1;
        info.pSemaphores = &timeline_;
        info.pValues = &ticket.value;
        r = c_.vk.vkWaitSemaphoresKHR(c_.device, &info, UINT64_MAX);
    } else {
        r = c_.vk.vkWaitForFences(c_.device, 1, &slot.fence, VK_TRUE, UINT64_MAX);
    }
    if (Status s = c_.check(r, "waiting for a submission"); !s) return s;
    finished_ = std::max(finished_, ticket.value);
    return ok_status();
}

compute::Program Submissions::program_of(compute::Ticket ticket) const {
    const Slot& slot = slots_[slot_of(ticket.value)];
    return ticket.value != 0 && slot.ticket == ticket.value ? slot.program : compute::Program{};
}

} // namespace wadi::vulkan
