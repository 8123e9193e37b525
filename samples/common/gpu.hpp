// A Vulkan device as an engine has one, for hosts that draw: a queue that draws and computes, buffers, images, pipelines.
#pragma once
#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>
#include <vulkan/vulkan.h>

namespace common {

struct Missing : std::runtime_error { // this machine lacks what the program needs
    using std::runtime_error::runtime_error;
};

inline void check(VkResult result, const char* call) {
    if (result == VK_ERROR_DEVICE_LOST)
        throw std::runtime_error(std::string(call) + ": the device is lost; make device and world anew");
    if (result < VK_SUCCESS) throw std::runtime_error(std::string(call) + " failed: VkResult " + std::to_string(result));
}

class Undo { // destroys what was made, the newest first
  public:
    ~Undo() { run(); }
    void add(std::function<void()> step) { steps_.push_back(std::move(step)); }
    void run() {
        for (; !steps_.empty(); steps_.pop_back()) steps_.back()();
    }

  private:
    std::vector<std::function<void()>> steps_;
};

struct Buffer {
    VkBuffer handle = VK_NULL_HANDLE;
    void* mapped = nullptr; // where the host writes and reads
};
struct Image {
    VkImage handle = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
};

struct BufferSet {
    VkDescriptorSet set = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
};
struct Commands {
    VkCommandBuffer buffer = VK_NULL_HANDLE;
    VkFence free = VK_NULL_HANDLE;
};
inline constexpr VkFormat COLOUR = VK_FORMAT_R8G8B8A8_UNORM, DEPTH = VK_FORMAT_D32_SFLOAT; // of pictures

/// The plainest barrier: all that follows waits for all before. For a few images a frame.
inline void change_layout(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect, VkImageLayout from,
                          VkImageLayout to) {
    VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                 nullptr,
                                 VK_ACCESS_MEMORY_WRITE_BIT,
                                 VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
                                 from,
                                 to};
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {aspect, 0, 1, 0, 1};
    const VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    vkCmdPipelineBarrier(commands, all, all, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

class Gpu {
  public:
    Gpu(const std::vector<const char*>& instance_extensions, bool presents) {
        const VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "Wadi", 1, "", 1, VK_API_VERSION_1_3};
        VkInstanceCreateInfo instance_info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, nullptr, 0, &application};
        instance_info.enabledExtensionCount = static_cast<uint32_t>(instance_extensions.size());
        instance_info.ppEnabledExtensionNames = instance_extensions.data();
        const VkResult made = vkCreateInstance(&instance_info, nullptr, &instance);
        if (made == VK_ERROR_INCOMPATIBLE_DRIVER) throw Missing("no Vulkan driver; mesa-vulkan-drivers brings one in software");
        check(made, "vkCreateInstance");
        undo_.add([this] { vkDestroyInstance(instance, nullptr); });
        choose();
        const float priority = 1;
        const VkDeviceQueueCreateInfo queue_info{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, family, 1, &priority};
        VkPhysicalDeviceVulkan13Features newest{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
        newest.dynamicRendering = VK_TRUE;
        VkPhysicalDeviceVulkan12Features newer{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &newest};
        newer.timelineSemaphore = VK_TRUE; // the plugin would wait for the host by one
        VkPhysicalDeviceFeatures features{};
        features.shaderStorageBufferArrayDynamicIndexing = VK_TRUE; // outputs[which]
        const char* const swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
        VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &newer, 0, 1, &queue_info};
        info.enabledExtensionCount = presents ? 1 : 0;
        info.ppEnabledExtensionNames = &swapchain;
        info.pEnabledFeatures = &features;
        check(vkCreateDevice(physical, &info, nullptr, &device), "vkCreateDevice");
        undo_.add([this] { vkDestroyDevice(device, nullptr); });
        vkGetDeviceQueue(device, family, 0, &queue);
    }
    Gpu(const Gpu&) = delete;
    Gpu& operator=(const Gpu&) = delete;

    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    uint32_t family = 0;
    VkQueue queue = VK_NULL_HANDLE;
    std::string name;

    Buffer make_buffer(VkDeviceSize bytes, VkBufferUsageFlags usage, Undo& undo) const {
        Buffer made;
        const VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, nullptr, 0, bytes, usage};
        check(vkCreateBuffer(device, &info, nullptr, &made.handle), "vkCreateBuffer");
        undo.add([=, this] { vkDestroyBuffer(device, made.handle, nullptr); });
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(device, made.handle, &needs);
        const VkDeviceMemory memory =
            allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT, undo);
        check(vkBindBufferMemory(device, made.handle, memory, 0), "vkBindBufferMemory");
        check(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &made.mapped), "vkMapMemory");
        return made;
    }
    Image make_image(VkExtent2D size, VkFormat format, VkImageUsageFlags usage, VkSampleCountFlagBits samples, Undo& undo) const {
        Image made;
        VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, nullptr, 0, VK_IMAGE_TYPE_2D, format,
                               {size.width, size.height, 1}};
        info.mipLevels = info.arrayLayers = 1;
        info.samples = samples;
        info.usage = usage;
        check(vkCreateImage(device, &info, nullptr, &made.handle), "vkCreateImage");
        undo.add([=, this] { vkDestroyImage(device, made.handle, nullptr); });
        VkMemoryRequirements needs;
        vkGetImageMemoryRequirements(device, made.handle, &needs);
        check(vkBindImageMemory(device, made.handle, allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, undo), 0),
              "vkBindImageMemory");
        VkImageViewCreateInfo view{
            VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, nullptr, 0, made.handle, VK_IMAGE_VIEW_TYPE_2D, format};
        const bool depth = (usage & VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT) != 0;
        view.subresourceRange = {depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        check(vkCreateImageView(device, &view, nullptr, &made.view), "vkCreateImageView");
        undo.add([=, this] { vkDestroyImageView(device, made.view, nullptr); });
        return made;
    }

    /// One set of buffers that all stages of a picture read, `counts[n]` of them at binding n; the first is uniform, the others
    /// storage.
    BufferSet make_buffer_set(std::span<const uint32_t> counts, Undo& undo) const {
        BufferSet made;
        std::vector<VkDescriptorSetLayoutBinding> bindings;
        std::vector<VkDescriptorPoolSize> sizes;
        for (uint32_t n = 0; n < counts.size(); ++n) {
            const VkDescriptorType type = n == 0 ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
            bindings.push_back({n, type, counts[n], VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, nullptr});
            sizes.push_back({type, counts[n]});
        }
        const auto count = static_cast<uint32_t>(bindings.size());
        const VkDescriptorSetLayoutCreateInfo set_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, nullptr, 0, count,
                                                       bindings.data()};
        VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
        check(vkCreateDescriptorSetLayout(device, &set_info, nullptr, &set_layout), "vkCreateDescriptorSetLayout");
        undo.add([=, this] { vkDestroyDescriptorSetLayout(device, set_layout, nullptr); });
        const VkDescriptorPoolCreateInfo pool_info{
            VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, 0, 1, count, sizes.data()};
        VkDescriptorPool pool = VK_NULL_HANDLE;
        check(vkCreateDescriptorPool(device, &pool_info, nullptr, &pool), "vkCreateDescriptorPool");
        undo.add([=, this] { vkDestroyDescriptorPool(device, pool, nullptr); });
        const VkDescriptorSetAllocateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool, 1, &set_layout};
        check(vkAllocateDescriptorSets(device, &set, &made.set), "vkAllocateDescriptorSets");
        const VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, nullptr, 0, 1, &set_layout};
        check(vkCreatePipelineLayout(device, &layout, nullptr, &made.layout), "vkCreatePipelineLayout");
        undo.add([=, this] { vkDestroyPipelineLayout(device, made.layout, nullptr); });
        return made;
    }
    /// Makes a set read these, in the order of its bindings, none of which may be in use. Storage buffers may be of anybody.
    void point(const BufferSet& set, std::span<const uint32_t> counts, std::span<const VkBuffer> buffers) const {
        std::vector<VkDescriptorBufferInfo> infos;
        for (const VkBuffer buffer : buffers) infos.push_back({buffer, 0, VK_WHOLE_SIZE});
        uint32_t first = 0;
        for (uint32_t n = 0; n < counts.size(); first += counts[n++]) {
            VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, set.set, n, 0, counts[n]};
            write.descriptorType = n == 0 ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
            write.pBufferInfo = &infos[first];
            vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
        }
    }
    /// Of two files of SPIR-V: triangles into COLOUR and DEPTH with four samples a pixel. constants: of the shaders, by id.
    /// blends: by the colour's alpha. closed: back faces are left out, and depth is written; depth is greater the nearer.
    VkPipeline make_pipeline(const BufferSet& buffers, const std::filesystem::path& vertex, const std::filesystem::path& fragment,
                             std::array<uint32_t, 2> constants, bool blends, bool closed, Undo& undo) const {
        const VkSpecializationMapEntry entries[2] = {{0, 0, 4}, {1, 4, 4}};
        const VkSpecializationInfo special{2, entries, sizeof constants, constants.data()};
        Undo modules;
        VkPipelineShaderStageCreateInfo stages[2];
        for (int n = 0; n < 2; ++n) {
            const std::vector<char> code = spirv(n == 0 ? vertex : fragment);
            const VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0, code.size(),
                                                reinterpret_cast<const uint32_t*>(code.data())};
            VkShaderModule module = VK_NULL_HANDLE;
            check(vkCreateShaderModule(device, &info, nullptr, &module), "vkCreateShaderModule");
            modules.add([=, this] { vkDestroyShaderModule(device, module, nullptr); });
            const VkShaderStageFlagBits stage = n == 0 ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
            stages[n] = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, stage, module, "main", &special};
        }
        const VkPipelineVertexInputStateCreateInfo no_input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
        VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
        assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
        viewport.viewportCount = viewport.scissorCount = 1;
        VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
        raster.cullMode = closed ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
        raster.lineWidth = 1;
        VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
        samples.rasterizationSamples = VK_SAMPLE_COUNT_4_BIT;
        VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
        depth.depthTestEnable = VK_TRUE;
        depth.depthWriteEnable = closed;
        depth.depthCompareOp = VK_COMPARE_OP_GREATER_OR_EQUAL;
        VkPipelineColorBlendAttachmentState blend{blends, VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA};
        blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
        blend.colorWriteMask = 0xf;
        VkPipelineColorBlendStateCreateInfo blending{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
        blending.attachmentCount = 1;
        blending.pAttachments = &blend;
        const VkDynamicState changing[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
        const VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO, nullptr, 0, 2,
                                                       changing};
        const VkPipelineRenderingCreateInfo targets{
            VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO, nullptr, 0, 1, &COLOUR, DEPTH};
        const VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                                &targets,
                                                0,
                                                2,
                                                stages,
                                                &no_input,
                                                &assembly,
                                                nullptr,
                                                &viewport,
                                                &raster,
                                                &samples,
                                                &depth,
                                                &blending,
                                                &dynamic,
                                                buffers.layout};
        VkPipeline made = VK_NULL_HANDLE;
        check(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &made), "vkCreateGraphicsPipelines");
        undo.add([=, this] { vkDestroyPipeline(device, made, nullptr); });
        return made;
    }
    /// A command buffer, and a fence that is signalled while it is free.
    Commands make_commands(Undo& undo) const {
        Commands made;
        const VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                                                VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT, family};
        VkCommandPool pool = VK_NULL_HANDLE;
        check(vkCreateCommandPool(device, &pool_info, nullptr, &pool), "vkCreateCommandPool");
        undo.add([=, this] { vkDestroyCommandPool(device, pool, nullptr); });
        const VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool,
                                               VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
        check(vkAllocateCommandBuffers(device, &info, &made.buffer), "vkAllocateCommandBuffers");
        const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, VK_FENCE_CREATE_SIGNALED_BIT};
        check(vkCreateFence(device, &fence, nullptr, &made.free), "vkCreateFence");
        undo.add([=, this] { vkDestroyFence(device, made.free, nullptr); });
        return made;
    }
    /// Waits until the device has done them.
    void wait(const Commands& commands) const {
        check(vkWaitForFences(device, 1, &commands.free, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    }
    /// They may be recorded anew.
    void begin(const Commands& commands) const {
        const VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                            VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
        check(vkBeginCommandBuffer(commands.buffer, &info), "vkBeginCommandBuffer");
    }
    /// Their transfers wait for a semaphore, and they signal one, where these are not null.
    void submit(const Commands& commands, VkSemaphore wait, VkSemaphore signal) const {
        check(vkEndCommandBuffer(commands.buffer), "vkEndCommandBuffer");
        check(vkResetFences(device, 1, &commands.free), "vkResetFences");
        const VkPipelineStageFlags at = VK_PIPELINE_STAGE_TRANSFER_BIT;
        const uint32_t waits = wait != VK_NULL_HANDLE ? 1 : 0, signals = signal != VK_NULL_HANDLE ? 1 : 0;
        const VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO, nullptr, waits, &wait, &at, 1, &commands.buffer, signals, &signal};
        check(vkQueueSubmit(queue, 1, &info, commands.free), "vkQueueSubmit");
    }
    /// Waits. Pixels of an image in layout TRANSFER_SRC_OPTIMAL: three bytes each, the first row on top.
    std::vector<uint8_t> read(const Commands& commands, const Image& image, VkExtent2D size) const {
        wait(commands);
        Undo undo;
        const std::size_t bytes = std::size_t{4} * size.width * size.height;
        const Buffer copy = make_buffer(bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, undo);
        begin(commands);
        const VkBufferImageCopy all{0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {}, {size.width, size.height, 1}};
        vkCmdCopyImageToBuffer(commands.buffer, image.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, copy.handle, 1, &all);
        submit(commands, VK_NULL_HANDLE, VK_NULL_HANDLE);
        wait(commands);
        std::vector<uint8_t> pixels;
        const auto* const from = static_cast<const uint8_t*>(copy.mapped);
        for (std::size_t n = 0; n < bytes; ++n) {
            if (n % 4 != 3) pixels.push_back(from[n]);
        }
        return pixels;
    }

  private:
    Undo undo_;
    void choose() { // of devices that draw and compute: not a software device, if there is another
        VkPhysicalDevice devices[16];
        uint32_t count = 16;
        check(vkEnumeratePhysicalDevices(instance, &count, devices), "vkEnumeratePhysicalDevices");
        for (uint32_t n = 0; n < count; ++n) {
            VkPhysicalDeviceProperties has;
            vkGetPhysicalDeviceProperties(devices[n], &has);
            VkQueueFamilyProperties families[16];
            uint32_t family_count = 16;
            vkGetPhysicalDeviceQueueFamilyProperties(devices[n], &family_count, families);
            const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
            uint32_t f = 0;
            while (f < family_count && (families[f].queueFlags & both) != both) ++f;
            if (f == family_count || has.apiVersion < VK_API_VERSION_1_3) continue;
            if (physical != VK_NULL_HANDLE && has.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU) continue;
            physical = devices[n];
            family = f;
            name = has.deviceName;
            if (has.deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU) return;
        }
        if (physical == VK_NULL_HANDLE)
            throw Missing("no device with Vulkan 1.3 that draws; mesa-vulkan-drivers brings one in software");
    }
    static std::vector<char> spirv(const std::filesystem::path& file) {
        std::ifstream from(file, std::ios::binary);
        std::vector<char> code((std::istreambuf_iterator<char>(from)), std::istreambuf_iterator<char>());
        if (code.size() < 20 || code.size() % 4 != 0) throw std::runtime_error(file.string() + " is not there, or no SPIR-V");
        return code;
    }
    VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted, Undo& undo) const {
        VkPhysicalDeviceMemoryProperties has;
        vkGetPhysicalDeviceMemoryProperties(physical, &has);
        uint32_t type = 0; // one that fits is promised for each use here
        while ((needs.memoryTypeBits >> type & 1u) == 0 || (has.memoryTypes[type].propertyFlags & wanted) != wanted) ++type;
        const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size, type};
        VkDeviceMemory made = VK_NULL_HANDLE;
        check(vkAllocateMemory(device, &info, nullptr, &made), "vkAllocateMemory");
        undo.add([=, this] { vkFreeMemory(device, made, nullptr); });
        return made;
    }
};

/// A picture to draw: colour, and depth that begins infinitely far away (0), with four samples a pixel.
class Target {
  public:
    explicit Target(const Gpu& gpu) : gpu_(gpu) {}

    Image picture; // after end() in layout TRANSFER_SRC_OPTIMAL
    VkExtent2D size{};

    /// Clears. The images are made anew where the size is another than before: the last picture must be done.
    void begin(VkCommandBuffer commands, VkExtent2D wanted, VkClearColorValue background) {
        if (wanted.width != size.width || wanted.height != size.height) resize(wanted);
        const VkImageLayout drawn = VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL;
        change_layout(commands, samples_.handle, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED, drawn);
        change_layout(commands, picture.handle, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED, drawn);
        change_layout(commands, depth_.handle, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED, drawn);
        VkRenderingAttachmentInfo colour{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                         nullptr,
                                         samples_.view,
                                         drawn,
                                         VK_RESOLVE_MODE_AVERAGE_BIT,
                                         picture.view,
                                         drawn,
                                         VK_ATTACHMENT_LOAD_OP_CLEAR};
        colour.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
        colour.clearValue.color = background;
        VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO, nullptr, depth_.view, drawn};
        depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        depth.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
        const VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO, nullptr, 0, {{0, 0}, size}, 1, 0, 1, &colour, &depth};
        vkCmdBeginRendering(commands, &rendering);
        const VkViewport viewport{0, 0, static_cast<float>(size.width), static_cast<float>(size.height), 0, 1};
        vkCmdSetViewport(commands, 0, 1, &viewport);
        vkCmdSetScissor(commands, 0, 1, &rendering.renderArea);
    }
    void end(VkCommandBuffer commands) const {
        vkCmdEndRendering(commands);
        change_layout(commands, picture.handle, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL,
                      VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    }

  private:
    const Gpu& gpu_;
    Undo undo_;
    Image samples_, depth_;

    void resize(VkExtent2D wanted) {
        undo_.run();
        size = wanted;
        const VkImageUsageFlags colour = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, depth = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
        picture = gpu_.make_image(size, COLOUR, colour | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_SAMPLE_COUNT_1_BIT, undo_);
        samples_ = gpu_.make_image(size, COLOUR, colour, VK_SAMPLE_COUNT_4_BIT, undo_);
        depth_ = gpu_.make_image(size, DEPTH, depth, VK_SAMPLE_COUNT_4_BIT, undo_);
    }
};

} // namespace common
