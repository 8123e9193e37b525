#include "backends/vulkan/lender.hpp"
#include "backends/vulkan/memory.hpp"
#include <algorithm>
#include <map>

namespace wadi::vulkan {
namespace {

template <class Handle> std::uint64_t number_of(Handle handle) { return reinterpret_cast<std::uintptr_t>(handle); }

class VulkanLender final : public compute::Lender {
  public:
    explicit VulkanLender(std::unique_ptr<Context> context) : context_(std::move(context)) {
        auto id = vk_struct<VkPhysicalDeviceIDProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES);
        auto properties = vk_struct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
        properties.pNext = &id;
        context_->instance->api().GetPhysicalDeviceProperties2(context_->physical, &properties);
        std::copy(std::begin(id.deviceUUID), std::end(id.deviceUUID), uuid_.begin());
    }

    ~VulkanLender() override {
        for (auto& [handle, memory] : lent_) release(*context_, memory);
    }

    const compute::DeviceUuid& device_uuid() const override { return uuid_; }
    const std::string& device_name() const override { return context_->capabilities.name; }

    Result<compute::LentBuffer> lend_buffer(std::uint64_t bytes, const std::string& label) override {
        Context& c = *context_;
        auto memory = allocate(c, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Place::shared, label);
        if (!memory) return memory.status();
        auto info = vk_struct<VkMemoryGetFdInfoKHR>(VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR);
        info.memory = memory->memory;
        info.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
        compute::LentBuffer lent{number_of(memory->buffer), memory->allocated};
        if (Status s = c.check(c.vk.vkGetMemoryFdKHR(c.device, &info, &lent.descriptor), "vkGetMemoryFdKHR", label); !s) {
            release(c, *memory);
            return s;
        }
        lent_[lent.handle] = std::move(*memory);
        return lent;
    }

    void take_back(const compute::LentBuffer& buffer) override {
        const auto found = lent_.find(buffer.handle);
        if (found == lent_.end()) return;
        release(*context_, found->second);
        lent_.erase(found);
    }

    Result<compute::Descriptor> lend_semaphore(std::uint64_t semaphore) override {
        auto info = vk_struct<VkSemaphoreGetFdInfoKHR>(VK_STRUCTURE_TYPE_SEMAPHORE_GET_FD_INFO_KHR);
        info.semaphore = reinterpret_cast<VkSemaphore>(static_cast<std::uintptr_t>(semaphore));
        info.handleType = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT;
        compute::Descriptor descriptor = -1;
        const VkResult made = context_->vk.vkGetSemaphoreFdKHR(context_->device, &info, &descriptor);
        if (Status s = context_->check(made, "vkGetSemaphoreFdKHR"); !s) return s;
        return descriptor;
    }

  private:
    std::unique_ptr<Context> context_;
    compute::DeviceUuid uuid_{};
    std::map<std::uint64_t, Memory> lent_; // by VkBuffer
};

} // namespace

Result<std::shared_ptr<compute::Lender>> lend(const compute::DeviceOptions& options) {
    auto context = Context::open(0, options);
    if (!context) return context.status();
    const Context& c = **context;
    const auto lacks = [&](const char* what) {
        return error(Code::not_supported,
                     "CUDA beside the host's Vulkan device " + c.capabilities.name + ": the device was created without " + what +
                         "; without it run on a device of your own and read host outputs (wadi_world_set_host_outputs)");
    };
    if (c.vk.vkGetMemoryFdKHR == nullptr) return lacks(VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME);
    if (c.vk.vkGetSemaphoreFdKHR == nullptr) return lacks(VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME);
    if (!c.timeline) return lacks("timeline semaphores (wadi_vulkan_host.timeline_semaphore)");
    return std::shared_ptr<compute::Lender>(std::make_shared<VulkanLender>(std::move(*context)));
}

} // namespace wadi::vulkan
