#include "renderer.hpp"
#include "shader_modules.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <stdexcept>

namespace viewer {
namespace {

constexpr int MOST_SAMPLES = 16;
constexpr uint32_t GROUP = 8; // local size of the passes

// Bindings of shaders/frame.glsl and of the passes.
constexpr std::array<uint32_t, 7> sampled_bindings = {1, 2, 3, 4, 5, 6, 25};
constexpr uint32_t first_storage = 14, storage_count = 11, summit_storage = 26, noise_sampled = 28, noise_storage = 29;
constexpr uint32_t NOISE_SIZE = 64; // texels along each axis of the noise: shaders/noise.glsl
constexpr std::array<uint32_t, 10> source_bindings = {7, 8, 9, 10, 11, 12, 13, 30, 31, 27};

template <std::size_t N> VkPipeline make_pipeline(const Gpu& gpu, VkPipelineLayout layout, const uint32_t (&words)[N]) {
    VkShaderModuleCreateInfo module_info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    module_info.codeSize = sizeof(words);
    module_info.pCode = words;
    VkShaderModule module;
    check(vkCreateShaderModule(gpu.device, &module_info, nullptr, &module), "vkCreateShaderModule");
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult made = vkCreateComputePipelines(gpu.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
    vkDestroyShaderModule(gpu.device, module, nullptr);
    check(made, "vkCreateComputePipelines");
    return pipeline;
}

} // namespace

Milliseconds operator+(const Milliseconds& a, const Milliseconds& b) {
    return {a.grid + b.grid, a.see + b.see, a.shade + b.shade, a.finish + b.finish, a.after + b.after};
}

Renderer::Renderer(const Gpu& gpu, uint32_t width, uint32_t height, VkImageUsageFlags usage) : gpu_(gpu), usage_(usage) {
    VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
    sampler.addressModeU = sampler.addressModeV = sampler.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    sampler.maxLod = VK_LOD_CLAMP_NONE;
    check(vkCreateSampler(gpu_.device, &sampler, nullptr, &sampler_), "vkCreateSampler");
    sampler.addressModeU = sampler.addressModeV = sampler.addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    check(vkCreateSampler(gpu_.device, &sampler, nullptr, &tiling_sampler_), "vkCreateSampler");
    noise_ = Image(gpu_, NOISE_SIZE, NOISE_SIZE, VK_FORMAT_R16G16B16A16_SFLOAT,
                   VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT, NOISE_SIZE);
    make_layouts();
    bake_ = make_pipeline(gpu_, pipeline_layout_, bake_spirv);
    prepare_ = make_pipeline(gpu_, pipeline_layout_, prepare_spirv);
    slopes_pass_ = make_pipeline(gpu_, pipeline_layout_, slopes_spirv);
    reduce_ = make_pipeline(gpu_, pipeline_layout_, reduce_spirv);
    summit_pass_ = make_pipeline(gpu_, pipeline_layout_, summit_spirv);
    light_pass_ = make_pipeline(gpu_, pipeline_layout_, light_spirv);
    see_ = make_pipeline(gpu_, pipeline_layout_, see_spirv);
    shade_ = make_pipeline(gpu_, pipeline_layout_, shade_spirv);
    finish_ = make_pipeline(gpu_, pipeline_layout_, finish_spirv);

    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(gpu_.physical, &properties);
    const VkDeviceSize align = std::max<VkDeviceSize>(properties.limits.minUniformBufferOffsetAlignment, 1);
    params_stride_ = (sizeof(FrameParams) + align - 1) / align * align;
    params_ = Buffer(gpu_, params_stride_ * MOST_SAMPLES, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, true);

    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = gpu_.pool;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(gpu_.device, &allocate, &commands_), "vkAllocateCommandBuffers");
    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(vkCreateFence(gpu_.device, &fence, nullptr, &done_), "vkCreateFence");
    VkQueryPoolCreateInfo queries{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
    queries.queryCount = MARKS;
    check(vkCreateQueryPool(gpu_.device, &queries, nullptr, &marks_), "vkCreateQueryPool");
    resize(width, height);
}

Renderer::~Renderer() {
    vkDeviceWaitIdle(gpu_.device);
    vkDestroyQueryPool(gpu_.device, marks_, nullptr);
    vkDestroyFence(gpu_.device, done_, nullptr);
    vkFreeCommandBuffers(gpu_.device, gpu_.pool, 1, &commands_);
    vkDestroyDescriptorPool(gpu_.device, pool_, nullptr);
    for (VkPipeline pipeline : {bake_, prepare_, slopes_pass_, reduce_, summit_pass_, light_pass_, see_, shade_, finish_})
        vkDestroyPipeline(gpu_.device, pipeline, nullptr);
    vkDestroyPipelineLayout(gpu_.device, pipeline_layout_, nullptr);
    vkDestroyDescriptorSetLayout(gpu_.device, set_layout_, nullptr);
    vkDestroySampler(gpu_.device, tiling_sampler_, nullptr);
    vkDestroySampler(gpu_.device, sampler_, nullptr);
}

void Renderer::make_layouts() {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    const auto add = [&](uint32_t binding, VkDescriptorType type) {
        bindings.push_back({binding, type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    };
    add(0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC);
    for (uint32_t binding : sampled_bindings) add(binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    for (uint32_t binding : source_bindings) add(binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    for (uint32_t n = 0; n < storage_count; ++n) add(first_storage + n, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    add(summit_storage, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    add(noise_sampled, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    add(noise_storage, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    info.bindingCount = static_cast<uint32_t>(bindings.size());
    info.pBindings = bindings.data();
    check(vkCreateDescriptorSetLayout(gpu_.device, &info, nullptr, &set_layout_), "vkCreateDescriptorSetLayout");
    const VkPushConstantRange level{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(uint32_t)};
    VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &set_layout_;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &level;
    check(vkCreatePipelineLayout(gpu_.device, &layout, nullptr, &pipeline_layout_), "vkCreatePipelineLayout");
}

void Renderer::resize(uint32_t width, uint32_t height) {
    wait();
    drawn_ = false;
    seen_ =
        Image(gpu_, width, height, VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    colour_ = Image(gpu_, width, height, VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_USAGE_STORAGE_BIT);
    picture_ = Image(gpu_, width, height, VK_FORMAT_R8G8B8A8_UNORM,
                     VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | usage_);
    if (nx_ > 0) make_descriptor_set();
}

void Renderer::make_grid_images(const Grid& grid) {
    nx_ = grid.nx;
    ny_ = grid.ny;
    const auto across = static_cast<uint32_t>(nx_), down = static_cast<uint32_t>(ny_);
    const VkImageUsageFlags usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    heights_ = Image(gpu_, across, down, VK_FORMAT_R32G32B32A32_SFLOAT, usage);
    slopes_ = Image(gpu_, across, down, VK_FORMAT_R16G16B16A16_SFLOAT, usage);
    matter_ = Image(gpu_, across, down, VK_FORMAT_R16G16B16A16_SFLOAT, usage);
    flow_ = Image(gpu_, across, down, VK_FORMAT_R16G16B16A16_SFLOAT, usage);
    light_ = Image(gpu_, across, down, VK_FORMAT_R16G16B16A16_SFLOAT, usage);
    // Levels are halved without remainder: the base is padded, the coarsest level has a few texels.
    levels_ = 1;
    while ((std::max(across, down) + 1) >> levels_ >= 8) ++levels_;
    const uint32_t block = 1u << levels_;
    base_width_ = (across + block) / block * block;
    base_height_ = (down + block) / block * block;
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(gpu_.physical, &properties);
    const uint32_t most = properties.limits.maxImageDimension2D;
    if (base_width_ > most || base_height_ + base_height_ / 2 > most)
        throw std::runtime_error("grid: " + std::to_string(nx_) + " x " + std::to_string(ny_) +
                                 " cells need pictures larger than the " + std::to_string(most) + " pixels that " + gpu_.name +
                                 " allows");
    pyramid_ = Image(gpu_, base_width_, base_height_ + base_height_ / 2, VK_FORMAT_R32_SFLOAT, usage);
    summit_ = Image(gpu_, 1, 1, VK_FORMAT_R32_SFLOAT, usage);
    make_descriptor_set();
}

void Renderer::make_descriptor_set() {
    vkDestroyDescriptorPool(gpu_.device, pool_, nullptr);
    const std::array<VkDescriptorPoolSize, 4> sizes = {
        VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1},
        VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, static_cast<uint32_t>(sampled_bindings.size()) + 1},
        VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, static_cast<uint32_t>(Sources{}.size())},
        VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, storage_count + 2}};
    VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool.maxSets = 1;
    pool.poolSizeCount = static_cast<uint32_t>(sizes.size());
    pool.pPoolSizes = sizes.data();
    check(vkCreateDescriptorPool(gpu_.device, &pool, nullptr, &pool_), "vkCreateDescriptorPool");
    VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    info.descriptorPool = pool_;
    info.descriptorSetCount = 1;
    info.pSetLayouts = &set_layout_;
    check(vkAllocateDescriptorSets(gpu_.device, &info, &set_), "vkAllocateDescriptorSets");
    const auto write_image = [&](uint32_t binding, VkDescriptorType type, VkImageView view) {
        const VkDescriptorImageInfo image{binding == noise_sampled ? tiling_sampler_ : sampler_, view, VK_IMAGE_LAYOUT_GENERAL};
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
        write.dstSet = set_;
        write.dstBinding = binding;
        write.descriptorCount = 1;
        write.descriptorType = type;
        write.pImageInfo = &image;
        vkUpdateDescriptorSets(gpu_.device, 1, &write, 0, nullptr);
    };
    const std::array<VkImageView, 7> sampled = {heights_.view, slopes_.view,  matter_.view, flow_.view,
                                                light_.view,   pyramid_.view, summit_.view};
    for (std::size_t n = 0; n < sampled.size(); ++n)
        write_image(sampled_bindings[n], VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, sampled[n]);
    const std::array<VkImageView, storage_count> storage = {heights_.view, matter_.view, flow_.view,   slopes_.view,
                                                            pyramid_.view, light_.view,  seen_.view,   seen_.view,
                                                            colour_.view,  colour_.view, picture_.view};
    for (uint32_t n = 0; n < storage_count; ++n) write_image(first_storage + n, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, storage[n]);
    write_image(summit_storage, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, summit_.view);
    write_image(noise_sampled, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, noise_.view);
    write_image(noise_storage, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, noise_.view);
    const VkDescriptorBufferInfo buffer{params_.handle, 0, sizeof(FrameParams)};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set_;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC;
    write.pBufferInfo = &buffer;
    vkUpdateDescriptorSets(gpu_.device, 1, &write, 0, nullptr);
}

void Renderer::bind_sources(const Sources& sources) {
    for (uint32_t n = 0; n < sources.size(); ++n) {
        const VkDescriptorBufferInfo buffer{sources[n].buffer, 0, VK_WHOLE_SIZE};
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
        write.dstSet = set_;
        write.dstBinding = source_bindings[n];
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        write.pBufferInfo = &buffer;
        vkUpdateDescriptorSets(gpu_.device, 1, &write, 0, nullptr);
    }
}

void Renderer::wait() {
    if (!under_way_) return;
    check(vkWaitForFences(gpu_.device, 1, &done_, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    check(vkResetFences(gpu_.device, 1, &done_), "vkResetFences");
    under_way_ = false;
    if (!marked_) return;
    std::array<uint64_t, MARKS> ticks{};
    check(vkGetQueryPoolResults(gpu_.device, marks_, 0, MARKS, sizeof(ticks), ticks.data(), sizeof(uint64_t),
                                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "vkGetQueryPoolResults");
    const auto between = [&](std::size_t n) {
        return static_cast<double>(ticks[n + 1] - ticks[n]) * gpu_.nanoseconds_per_tick * 1e-6;
    };
    times_ = {between(0), between(1), between(2), between(3), between(4)};
}

void Renderer::barrier() const {
    VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    memory.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
    memory.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
    vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1, &memory, 0,
                         nullptr, 0, nullptr);
}

void Renderer::mark(uint32_t n) const {
    if (timed()) vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, marks_, n);
}

void Renderer::dispatch(VkPipeline pipeline, uint32_t across, uint32_t down, uint32_t params, uint32_t level) const {
    const auto offset = static_cast<uint32_t>(params * params_stride_);
    vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_layout_, 0, 1, &set_, 1, &offset);
    vkCmdPushConstants(commands_, pipeline_layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(level), &level);
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdDispatch(commands_, (across + GROUP - 1) / GROUP, (down + GROUP - 1) / GROUP, 1);
    barrier();
}

void Renderer::draw(const Picture& what, const Grid& grid, const Sources& sources, bool foreign_memory,
                    const Submission& submission, const std::function<void(VkCommandBuffer)>& after) {
    wait();
    if (grid.nx != nx_ || grid.ny != ny_) make_grid_images(grid);
    bind_sources(sources);
    const auto samples = static_cast<uint32_t>(std::clamp(what.quality.samples, 1, MOST_SAMPLES));
    const auto drawn_side = [&](uint32_t side) {
        return std::clamp(static_cast<uint32_t>(std::lround(static_cast<float>(side) * what.scale)), 1u, side);
    };
    drawn_width_ = drawn_side(width());
    drawn_height_ = drawn_side(height());
    for (uint32_t n = 0; n < samples; ++n) {
        FrameParams params =
            frame_params(what, grid, static_cast<int>(drawn_width_), static_cast<int>(drawn_height_), static_cast<int>(n));
        params.grid.z = static_cast<int>(levels_);
        params.grid.w = static_cast<int>(base_width_);
        params.image.w = static_cast<int>(base_height_);
        for (std::size_t s = 0; s < sources.size(); ++s) params.source[s] = {sources[s].offset, sources[s].row_pitch, 0, 0};
        std::memcpy(static_cast<char*>(params_.mapped) + n * params_stride_, &params, sizeof(params));
    }

    begin_commands();
    if (timed()) vkCmdResetQueryPool(commands_, marks_, 0, MARKS);
    // The plugin's passes and copies, and the last picture's readers, come first.
    VkMemoryBarrier ahead{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    ahead.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    ahead.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
    std::vector<VkBufferMemoryBarrier> acquired;
    if (foreign_memory) {                                                           // what another API wrote is acquired
        for (const Source& source : std::span(sources).first(sources.size() - 1)) { // the last is the host's
            VkBufferMemoryBarrier acquire{VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER};
            acquire.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
            acquire.srcQueueFamilyIndex = VK_QUEUE_FAMILY_EXTERNAL;
            acquire.dstQueueFamilyIndex = gpu_.family;
            acquire.buffer = source.buffer;
            acquire.size = VK_WHOLE_SIZE;
            acquired.push_back(acquire);
        }
    }
    vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1, &ahead,
                         static_cast<uint32_t>(acquired.size()), acquired.data(), 0, nullptr);
    if (!baked_) dispatch(bake_, NOISE_SIZE, NOISE_SIZE * NOISE_SIZE, 0);
    baked_ = true;
    mark(0);
    const auto across = static_cast<uint32_t>(nx_), down = static_cast<uint32_t>(ny_);
    dispatch(prepare_, across, down, 0);
    dispatch(slopes_pass_, base_width_, base_height_, 0);
    for (uint32_t n = 1; n < levels_; ++n) dispatch(reduce_, base_width_ >> n, base_height_ >> n, 0, n);
    dispatch(summit_pass_, 1, 1, 0);
    dispatch(light_pass_, across, down, 0);
    mark(1);
    for (uint32_t n = 0; n < samples; ++n) {
        dispatch(see_, drawn_width_, drawn_height_, n);
        if (n == 0) mark(2);
        dispatch(shade_, drawn_width_, drawn_height_, n);
    }
    mark(3);
    dispatch(finish_, width(), height(), 0);
    mark(4);
    VkMemoryBarrier drawn{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    drawn.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
    drawn.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &drawn, 0,
                         nullptr, 0, nullptr);
    submit(submission, [&](VkCommandBuffer commands) {
        if (after) after(commands);
        mark(5);
    });
    marked_ = timed();
    drawn_ = true;
}

void Renderer::draw_images(const std::vector<PlacedImage>& images, const Submission& submission,
                           const std::function<void(VkCommandBuffer)>& after) {
    wait();
    begin_commands();
    const VkImageSubresourceRange whole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    const VkClearColorValue dark{{0.06f, 0.07f, 0.08f, 1}};
    vkCmdClearColorImage(commands_, picture_.handle, VK_IMAGE_LAYOUT_GENERAL, &dark, 1, &whole);
    VkMemoryBarrier written{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    written.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    written.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    const auto order = [&] {
        vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &written, 0,
                             nullptr, 0, nullptr);
    };
    order();
    for (const PlacedImage& placed : images) {
        const auto right = std::min(placed.left + placed.width, static_cast<int>(width())),
                   bottom = std::min(placed.top + placed.height, static_cast<int>(height()));
        if (placed.left < 0 || placed.top < 0 || right <= placed.left || bottom <= placed.top) continue;
        VkImageBlit blit{};
        blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        blit.srcOffsets[1] = {static_cast<int32_t>(placed.image->width), static_cast<int32_t>(placed.image->height), 1};
        blit.dstOffsets[0] = {placed.left, placed.top, 0};
        blit.dstOffsets[1] = {right, bottom, 1};
        vkCmdBlitImage(commands_, placed.image->handle, VK_IMAGE_LAYOUT_GENERAL, picture_.handle, VK_IMAGE_LAYOUT_GENERAL, 1,
                       &blit, VK_FILTER_LINEAR);
    }
    order();
    submit(submission, after);
    marked_ = drawn_ = false;
}

void Renderer::begin_commands() {
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands_, &begin), "vkBeginCommandBuffer");
}

void Renderer::submit(const Submission& submission, const std::function<void(VkCommandBuffer)>& after) {
    if (after) after(commands_);
    check(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");

    std::vector<VkSemaphore> waits, signals;
    std::vector<VkPipelineStageFlags> stages;
    std::vector<uint64_t> wait_values, signal_values;
    const auto add_wait = [&](VkSemaphore semaphore, uint64_t value) {
        waits.push_back(semaphore);
        wait_values.push_back(value);
        stages.push_back(VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
    };
    if (submission.wait != VK_NULL_HANDLE) add_wait(submission.wait, 0);
    if (submission.signal != VK_NULL_HANDLE) {
        signals.push_back(submission.signal);
        signal_values.push_back(0);
    }
    if (submission.timeline != VK_NULL_HANDLE) {
        add_wait(submission.timeline, submission.timeline_value);
        signals.push_back(submission.timeline);
        signal_values.push_back(submission.timeline_value + 1);
    }
    VkTimelineSemaphoreSubmitInfo values{VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO};
    values.waitSemaphoreValueCount = static_cast<uint32_t>(wait_values.size());
    values.pWaitSemaphoreValues = wait_values.data();
    values.signalSemaphoreValueCount = static_cast<uint32_t>(signal_values.size());
    values.pSignalSemaphoreValues = signal_values.data();
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO, &values};
    submit.waitSemaphoreCount = static_cast<uint32_t>(waits.size());
    submit.pWaitSemaphores = waits.data();
    submit.pWaitDstStageMask = stages.data();
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands_;
    submit.signalSemaphoreCount = static_cast<uint32_t>(signals.size());
    submit.pSignalSemaphores = signals.data();
    check(vkQueueSubmit(gpu_.queue, 1, &submit, done_), "vkQueueSubmit");
    under_way_ = true;
}

std::vector<uint8_t> Renderer::read_picture() {
    wait();
    const std::size_t bytes = std::size_t{4} * width() * height();
    const Buffer target(gpu_, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, true);
    gpu_.run_once([&](VkCommandBuffer commands) {
        VkBufferImageCopy copy{};
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.imageExtent = {width(), height(), 1};
        vkCmdCopyImageToBuffer(commands, picture_.handle, VK_IMAGE_LAYOUT_GENERAL, target.handle, 1, &copy);
    });
    const auto* pixels = static_cast<const uint8_t*>(target.mapped);
    return {pixels, pixels + bytes};
}

std::optional<glm::vec3> Renderer::place_at(uint32_t x, uint32_t y) {
    wait();
    if (!drawn_ || x >= width() || y >= height()) return std::nullopt;
    const Buffer target(gpu_, sizeof(glm::vec4), VK_BUFFER_USAGE_TRANSFER_DST_BIT, true);
    gpu_.run_once([&](VkCommandBuffer commands) {
        VkBufferImageCopy copy{};
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.imageOffset = {static_cast<int32_t>(x * drawn_width_ / width()), static_cast<int32_t>(y * drawn_height_ / height()),
                            0};
        copy.imageExtent = {1, 1, 1};
        vkCmdCopyImageToBuffer(commands, seen_.handle, VK_IMAGE_LAYOUT_GENERAL, target.handle, 1, &copy);
    });
    glm::vec4 seen;
    std::memcpy(&seen, target.mapped, sizeof(seen));
    if (seen.w < 1.5f || seen.w > 5.5f) return std::nullopt; // KIND_SKY, KIND_PLINTH, KIND_FAR_... in shaders/frame.glsl
    return glm::vec3(seen);
}

} // namespace viewer
