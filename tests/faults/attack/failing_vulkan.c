/* A Vulkan loader that hands every call on to the real one, but for a call that fails: number failing_vulkan_at of those that may
 * fail, with failing_vulkan_code, and with it each of the next failing_vulkan_more. With VK_SUCCESS for a code it lies: nothing is
 * done, as if the library had not looked at the code. Built and put in the real one's place by attack.sh, which names that in
 * FAILING_VULKAN_REAL. */
#include <dlfcn.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan.h>

atomic_int failing_vulkan_calls, failing_vulkan_at, failing_vulkan_more, failing_vulkan_code;
/* By the kind of call: the number of the last one; 0 where there was none, and behind all kinds. And what each kind is called. */
atomic_int failing_vulkan_last[64];
extern const char* const failing_vulkan_names[64];

static int fails(int kind) {
    const int number = atomic_fetch_add(&failing_vulkan_calls, 1) + 1, at = failing_vulkan_at;
    failing_vulkan_last[kind] = number;
    return at > 0 && number >= at && number <= at + failing_vulkan_more;
}

#define EACH_CALL(CALL)                                                                                                          \
    CALL(CreateInstance, (const VkInstanceCreateInfo* a, const VkAllocationCallbacks* b, VkInstance* c), (a, b, c))              \
    CALL(EnumeratePhysicalDevices, (VkInstance a, uint32_t * b, VkPhysicalDevice * c), (a, b, c))                                \
    CALL(EnumerateDeviceExtensionProperties, (VkPhysicalDevice a, const char* b, uint32_t* c, VkExtensionProperties* d),         \
         (a, b, c, d))                                                                                                           \
    CALL(CreateDevice, (VkPhysicalDevice a, const VkDeviceCreateInfo* b, const VkAllocationCallbacks* c, VkDevice* d),           \
         (a, b, c, d))                                                                                                           \
    CALL(AllocateMemory, (VkDevice a, const VkMemoryAllocateInfo* b, const VkAllocationCallbacks* c, VkDeviceMemory* d),         \
         (a, b, c, d))                                                                                                           \
    CALL(MapMemory, (VkDevice a, VkDeviceMemory b, VkDeviceSize c, VkDeviceSize d, VkMemoryMapFlags e, void** f),                \
         (a, b, c, d, e, f))                                                                                                     \
    CALL(CreateBuffer, (VkDevice a, const VkBufferCreateInfo* b, const VkAllocationCallbacks* c, VkBuffer* d), (a, b, c, d))     \
    CALL(BindBufferMemory, (VkDevice a, VkBuffer b, VkDeviceMemory c, VkDeviceSize d), (a, b, c, d))                             \
    CALL(CreateShaderModule, (VkDevice a, const VkShaderModuleCreateInfo* b, const VkAllocationCallbacks* c, VkShaderModule* d), \
         (a, b, c, d))                                                                                                           \
    CALL(CreatePipelineLayout,                                                                                                   \
         (VkDevice a, const VkPipelineLayoutCreateInfo* b, const VkAllocationCallbacks* c, VkPipelineLayout* d), (a, b, c, d))   \
    CALL(CreateDescriptorSetLayout,                                                                                              \
         (VkDevice a, const VkDescriptorSetLayoutCreateInfo* b, const VkAllocationCallbacks* c, VkDescriptorSetLayout* d),       \
         (a, b, c, d))                                                                                                           \
    CALL(CreateComputePipelines,                                                                                                 \
         (VkDevice a, VkPipelineCache b, uint32_t c, const VkComputePipelineCreateInfo* d, const VkAllocationCallbacks* e,       \
          VkPipeline* f),                                                                                                        \
         (a, b, c, d, e, f))                                                                                                     \
    CALL(CreatePipelineCache,                                                                                                    \
         (VkDevice a, const VkPipelineCacheCreateInfo* b, const VkAllocationCallbacks* c, VkPipelineCache* d), (a, b, c, d))     \
    CALL(CreateDescriptorPool,                                                                                                   \
         (VkDevice a, const VkDescriptorPoolCreateInfo* b, const VkAllocationCallbacks* c, VkDescriptorPool* d), (a, b, c, d))   \
    CALL(AllocateDescriptorSets, (VkDevice a, const VkDescriptorSetAllocateInfo* b, VkDescriptorSet* c), (a, b, c))              \
    CALL(CreateCommandPool, (VkDevice a, const VkCommandPoolCreateInfo* b, const VkAllocationCallbacks* c, VkCommandPool* d),    \
         (a, b, c, d))                                                                                                           \
    CALL(AllocateCommandBuffers, (VkDevice a, const VkCommandBufferAllocateInfo* b, VkCommandBuffer* c), (a, b, c))              \
    CALL(BeginCommandBuffer, (VkCommandBuffer a, const VkCommandBufferBeginInfo* b), (a, b))                                     \
    CALL(EndCommandBuffer, (VkCommandBuffer a), (a))                                                                             \
    CALL(QueueSubmit, (VkQueue a, uint32_t b, const VkSubmitInfo* c, VkFence d), (a, b, c, d))                                   \
    CALL(QueueWaitIdle, (VkQueue a), (a))                                                                                        \
    CALL(CreateFence, (VkDevice a, const VkFenceCreateInfo* b, const VkAllocationCallbacks* c, VkFence* d), (a, b, c, d))        \
    CALL(WaitForFences, (VkDevice a, uint32_t b, const VkFence* c, VkBool32 d, uint64_t e), (a, b, c, d, e))                     \
    CALL(GetFenceStatus, (VkDevice a, VkFence b), (a, b))                                                                        \
    CALL(ResetFences, (VkDevice a, uint32_t b, const VkFence* c), (a, b, c))                                                     \
    CALL(CreateSemaphore, (VkDevice a, const VkSemaphoreCreateInfo* b, const VkAllocationCallbacks* c, VkSemaphore* d),          \
         (a, b, c, d))                                                                                                           \
    CALL(WaitSemaphores, (VkDevice a, const VkSemaphoreWaitInfo* b, uint64_t c), (a, b, c))                                      \
    CALL(WaitSemaphoresKHR, (VkDevice a, const VkSemaphoreWaitInfo* b, uint64_t c), (a, b, c))                                   \
    CALL(GetSemaphoreCounterValue, (VkDevice a, VkSemaphore b, uint64_t * c), (a, b, c))                                         \
    CALL(GetSemaphoreCounterValueKHR, (VkDevice a, VkSemaphore b, uint64_t * c), (a, b, c))                                      \
    CALL(CreateQueryPool, (VkDevice a, const VkQueryPoolCreateInfo* b, const VkAllocationCallbacks* c, VkQueryPool* d),          \
         (a, b, c, d))

#define CALL(name, parameters, arguments) KIND_##name,
enum { EACH_CALL(CALL) KINDS };
#undef CALL
#define CALL(name, parameters, arguments) #name,
const char* const failing_vulkan_names[64] = {EACH_CALL(CALL)};
#undef CALL
_Static_assert(KINDS < sizeof failing_vulkan_last / sizeof *failing_vulkan_last, "a place for each kind, and one behind");

#define CALL(name, parameters, arguments)                                                                                        \
    static PFN_vk##name real_##name;                                                                                             \
    static VKAPI_ATTR VkResult VKAPI_CALL call_##name parameters {                                                               \
        return fails(KIND_##name) ? (VkResult)failing_vulkan_code : real_##name arguments;                                       \
    }
EACH_CALL(CALL)
#undef CALL

/* The call of that name in place of `real`. */
static PFN_vkVoidFunction in_place_of(PFN_vkVoidFunction real, const char* name) {
    if (real == NULL) return NULL;
#define CALL(called, parameters, arguments)                                                                                      \
    if (strcmp(name, "vk" #called) == 0) {                                                                                       \
        real_##called = (PFN_vk##called)real;                                                                                    \
        return (PFN_vkVoidFunction)call_##called;                                                                                \
    }
    EACH_CALL(CALL)
    return real;
}

static PFN_vkGetDeviceProcAddr real_device_entry;
static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_entry(VkDevice device, const char* name) {
    return in_place_of(real_device_entry(device, name), name);
}

__attribute__((visibility("default"))) VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetInstanceProcAddr(VkInstance instance,
                                                                                                      const char* name) {
    static PFN_vkGetInstanceProcAddr real;
    if (real == NULL) {
        void* loader = dlopen(getenv("FAILING_VULKAN_REAL"), RTLD_NOW | RTLD_LOCAL);
        if (loader == NULL) return NULL;
        real = (PFN_vkGetInstanceProcAddr)dlsym(loader, "vkGetInstanceProcAddr");
    }
    if (strcmp(name, "vkGetInstanceProcAddr") == 0) return (PFN_vkVoidFunction)vkGetInstanceProcAddr;
    const PFN_vkVoidFunction found = real(instance, name);
    if (found != NULL && strcmp(name, "vkGetDeviceProcAddr") == 0) {
        real_device_entry = (PFN_vkGetDeviceProcAddr)found;
        return (PFN_vkVoidFunction)device_entry;
    }
    return in_place_of(found, name);
}
