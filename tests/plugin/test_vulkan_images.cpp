// Outputs copied into images of a Vulkan host: the CPU's texels in every format, set, place and order, and what is refused.
#include "tests/plugin/vulkan_test_host.hpp"
#include <chrono>
#include <cstring>
#include <thread>

using namespace wadi::test;

namespace {

constexpr std::uint64_t frame_time = 25'000'000; // [ns]; a step takes 20 ms, so that the interpolated set lies between two
constexpr std::uint32_t every_output = WADI_OUTPUT_BIT(WADI_OUTPUT_COUNT) - 1u;

struct Format {
    VkFormat vulkan;
    std::uint32_t bytes;
};
Format format_of(const wadi_output_view& view) {
    switch (view.format) {
    case WADI_FORMAT_R32_FLOAT:
        return {VK_FORMAT_R32_SFLOAT, 4};
    case WADI_FORMAT_R32G32_FLOAT:
        return {VK_FORMAT_R32G32_SFLOAT, 8};
    case WADI_FORMAT_R32G32B32A32_FLOAT:
        return {VK_FORMAT_R32G32B32A32_SFLOAT, 16};
    default:
        return {VK_FORMAT_R16G16B16A16_SFLOAT, 8};
    }
}

std::uint32_t memory_of(const VulkanHost& host, std::uint32_t allowed, VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(host.vulkan.physical_device, &memory);
    std::uint32_t type = 0;
    while ((allowed >> type & 1u) == 0 || (memory.memoryTypes[type].propertyFlags & wanted) != wanted) ++type;
    return type;
}

VkDeviceMemory allocate(const VulkanHost& host, const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) {
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = needs.size;
    info.memoryTypeIndex = memory_of(host, needs.memoryTypeBits, wanted);
    VkDeviceMemory memory{};
    check_vk(vkAllocateMemory(host.vulkan.device, &info, nullptr, &memory), "vkAllocateMemory");
    return memory;
}

// Runs commands on the host's queue and waits.
template <class Commands> void run(const VulkanHost& host, Commands record_commands) {
    const auto [pool, commands] = begin_commands(host);
    record_commands(commands);
    check_vk(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    check_vk(vkQueueSubmit(host.vulkan.queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    check_vk(vkQueueWaitIdle(host.vulkan.queue), "vkQueueWaitIdle");
    vkDestroyCommandPool(host.vulkan.device, pool, nullptr);
}

// An image, every level and layer of it cleared to 7 and in layout GENERAL, and memory to read one level of one layer.
struct Image {
    const VulkanHost& host;
    const Format format;
    const std::uint32_t width, height, levels, layers;
    VkImage image{};
    VkBuffer buffer{};
    VkDeviceMemory memory{}, buffer_memory{};

    Image(const VulkanHost& on, Format of, std::uint32_t columns, std::uint32_t rows, std::uint32_t mip_levels = 1,
          std::uint32_t array_layers = 1)
        : host(on), format(of), width(columns), height(rows), levels(mip_levels), layers(array_layers) {
        VkImageCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = format.vulkan;
        info.extent = {width, height, 1};
        info.mipLevels = levels;
        info.arrayLayers = layers;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
        check_vk(vkCreateImage(host.vulkan.device, &info, nullptr, &image), "vkCreateImage");
        VkMemoryRequirements needs{};
        vkGetImageMemoryRequirements(host.vulkan.device, image, &needs);
        memory = allocate(host, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
        check_vk(vkBindImageMemory(host.vulkan.device, image, memory, 0), "vkBindImageMemory");
        VkBufferCreateInfo buffer_info{};
        buffer_info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        buffer_info.size = VkDeviceSize{width} * height * format.bytes;
        buffer_info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
        check_vk(vkCreateBuffer(host.vulkan.device, &buffer_info, nullptr, &buffer), "vkCreateBuffer");
        vkGetBufferMemoryRequirements(host.vulkan.device, buffer, &needs);
        buffer_memory = allocate(host, needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
        check_vk(vkBindBufferMemory(host.vulkan.device, buffer, buffer_memory, 0), "vkBindBufferMemory");
        run(host, [&](VkCommandBuffer commands) {
            barrier(commands, 0, levels, 0, layers, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
            VkClearColorValue seven{};
            for (float& channel : seven.float32) channel = 7;
            const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, levels, 0, layers};
            vkCmdClearColorImage(commands, image, VK_IMAGE_LAYOUT_GENERAL, &seven, 1, &all);
        });
    }
    Image(const Image&) = delete;
    Image& operator=(const Image&) = delete;
    ~Image() {
        vkDestroyBuffer(host.vulkan.device, buffer, nullptr);
        vkDestroyImage(host.vulkan.device, image, nullptr);
        vkFreeMemory(host.vulkan.device, buffer_memory, nullptr);
        vkFreeMemory(host.vulkan.device, memory, nullptr);
    }

    void barrier(VkCommandBuffer commands, std::uint32_t level, std::uint32_t level_count, std::uint32_t layer,
                 std::uint32_t layer_count, VkImageLayout from, VkImageLayout to) const {
        VkImageMemoryBarrier change{};
        change.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
        change.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
        change.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
        change.oldLayout = from;
        change.newLayout = to;
        change.srcQueueFamilyIndex = change.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        change.image = image;
        change.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, level, level_count, layer, layer_count};
        constexpr VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
        vkCmdPipelineBarrier(commands, all, all, 0, 0, nullptr, 0, nullptr, 1, &change);
    }

    // Without a barrier ahead of it where the image has the layout that copies want: none is to be needed.
    void read_into_buffer(VkCommandBuffer commands, VkImageLayout layout, std::uint32_t level = 0,
                          std::uint32_t layer = 0) const {
        if (layout != VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL && layout != VK_IMAGE_LAYOUT_GENERAL)
            barrier(commands, level, 1, layer, 1, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        VkBufferImageCopy copy{};
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, layer, 1};
        copy.imageExtent = {width >> level, height >> level, 1};
        vkCmdCopyImageToBuffer(commands, image, layout == VK_IMAGE_LAYOUT_GENERAL ? layout : VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               buffer, 1, &copy);
        VkMemoryBarrier seen{};
        seen.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        seen.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        seen.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &seen, 0, nullptr, 0,
                             nullptr);
    }
    /// What read_into_buffer() brought, row by row.
    std::vector<unsigned char> bytes(std::uint32_t level = 0) const {
        void* mapped = nullptr;
        check_vk(vkMapMemory(host.vulkan.device, buffer_memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
        const auto* from = static_cast<const unsigned char*>(mapped);
        std::vector<unsigned char> texels(from, from + std::size_t{width >> level} * (height >> level) * format.bytes);
        vkUnmapMemory(host.vulkan.device, buffer_memory);
        return texels;
    }
    std::vector<unsigned char> read(VkImageLayout layout, std::uint32_t level = 0, std::uint32_t layer = 0) const {
        run(host, [&](VkCommandBuffer commands) { read_into_buffer(commands, layout, level, layer); });
        return bytes(level);
    }

    wadi_vulkan_image given() const {
        auto to = wadi_default_vulkan_image();
        to.image = image;
        to.format = format.vulkan;
        to.width = width;
        to.height = height;
        to.new_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        return to;
    }
};

wadi_output_view view_of(const AbiWorld& world, wadi_output output, wadi_output_set set = WADI_OUTPUT_CURRENT) {
    auto view = wadi_default_output_view();
    REQUIRE_MESSAGE(wadi_world_get_view(world.id, output, set, &view) == WADI_OK, std::string(wadi_get_last_error()));
    return view;
}

// The cells of an output of a world on the CPU, row by row.
std::vector<unsigned char> cells_of(const AbiWorld& twin, wadi_output output, wadi_output_set set = WADI_OUTPUT_CURRENT,
                                    wadi_region cells = {0, 0, NX, NY}) {
    hash_of(twin); // waits
    const auto view = view_of(twin, output, set);
    const std::size_t bytes = format_of(view).bytes;
    std::vector<unsigned char> values;
    for (int j = cells.j0; j < cells.j0 + cells.ny; ++j) {
        const auto* row = reinterpret_cast<const unsigned char*>(static_cast<std::uintptr_t>(view.handle)) + view.offset +
                          static_cast<std::uint64_t>(j) * view.row_pitch + static_cast<std::size_t>(cells.i0) * bytes;
        values.insert(values.end(), row, row + static_cast<std::size_t>(cells.nx) * bytes);
    }
    return values;
}

void expect_copied(const AbiWorld& world, wadi_output output, const wadi_vulkan_image& to,
                   wadi_output_set set = WADI_OUTPUT_CURRENT) {
    REQUIRE_MESSAGE(wadi_vulkan_copy_output(world.id, output, set, &to) == WADI_OK, std::string(wadi_get_last_error()));
}

// Sand, water and wet sand, all outputs, no time dropped.
AbiWorld world_with_outputs(const char* backend, const wadi_vulkan_host* host, std::uint32_t mask = every_output) {
    AbiWorld world(make_world(backend, host));
    auto pace = wadi_default_update_settings();
    pace.max_steps_in_flight = 0;
    pace.interpolate_outputs = 1;
    REQUIRE(wadi_world_set_update_settings(world.id, &pace) == WADI_OK);
    REQUIRE(wadi_world_set_outputs(world.id, mask) == WADI_OK);
    auto heap = wadi_default_edit();
    heap.layer = WADI_LAYER_SAND;
    heap.x0 = 5;
    heap.y0 = 2.5;
    heap.amount = 0.5;
    REQUIRE(wadi_world_edit(world.id, &heap, 1) == WADI_OK);
    return world;
}

wadi_frame update(const AbiWorld& world, std::uint64_t nanoseconds = frame_time) {
    auto frame = wadi_default_frame();
    REQUIRE_MESSAGE(wadi_world_update(world.id, nanoseconds, &frame) == WADI_OK, std::string(wadi_get_last_error()));
    return frame;
}

} // namespace

TEST_CASE("every output of every set fills an image with the CPU's texels") {
    if (!has_vulkan()) return;
    const VulkanHost host;
    const AbiWorld world = world_with_outputs("vulkan", &host.vulkan), twin = world_with_outputs("cpu", nullptr);
    for (int frame = 0; frame < 6; ++frame) {
        for (const AbiWorld* each : {&world, &twin}) {
            update(*each);
            hash_of(*each); // waits: an update does not interpolate while the device is behind
        }
    }
    int different_sets = 0;
    for (int n = 0; n < WADI_OUTPUT_COUNT; ++n) {
        const auto output = static_cast<wadi_output>(n);
        const auto view = view_of(world, output);
        for (const auto set : {WADI_OUTPUT_PREVIOUS, WADI_OUTPUT_CURRENT, WADI_OUTPUT_INTERPOLATED}) {
            if (set == WADI_OUTPUT_INTERPOLATED && view.format != WADI_FORMAT_R32_FLOAT) continue;
            CAPTURE(n);
            CAPTURE(static_cast<int>(set));
            const Image image(host, format_of(view), NX, NY);
            auto to = image.given();
            if (set == WADI_OUTPUT_CURRENT) to.new_layout = wadi_default_vulkan_image().new_layout;
            expect_copied(world, output, to, set);
            const auto texels = image.read(to.new_layout);
            CHECK(texels == cells_of(twin, output, set));
            if (set != WADI_OUTPUT_CURRENT) different_sets += texels != cells_of(twin, output) ? 1 : 0;
        }
    }
    CHECK(different_sets > WADI_OUTPUT_COUNT); // the sets are not all one, so that one in place of another is seen
    CHECK(hash_of(world) == hash_of(twin));
}

TEST_CASE("a rectangle of cells goes into one level of one layer and nothing else changes") {
    if (!has_vulkan()) return;
    const VulkanHost host;
    const AbiWorld world = world_with_outputs("vulkan", &host.vulkan), twin = world_with_outputs("cpu", nullptr);
    update(world);
    update(twin);
    const Image image(host, {VK_FORMAT_R32G32B32A32_SFLOAT, 16}, 128, 64, 2, 3);
    auto to = image.given();
    to.mip_level = 1;
    to.array_layer = 2;
    to.old_layout = VK_IMAGE_LAYOUT_GENERAL;
    to.x = 44; // to the last column
    to.y = 11;
    to.cells = {5, 3, 20, 10};
    expect_copied(world, WADI_OUTPUT_PACKED, to);
    const auto part = cells_of(twin, WADI_OUTPUT_PACKED, WADI_OUTPUT_CURRENT, to.cells);
    const std::vector<float> cleared(std::size_t{64} * 32 * 4, 7.0F);
    std::vector<unsigned char> expected(cleared.size() * 4);
    std::memcpy(expected.data(), cleared.data(), expected.size());
    for (std::size_t row = 0; row < 10; ++row)
        std::memcpy(expected.data() + ((11 + row) * 64 + 44) * 16, part.data() + row * 20 * 16, std::size_t{20} * 16);
    CHECK(image.read(to.new_layout, 1, 2) == expected);
    std::memcpy(expected.data(), cleared.data(), expected.size());
    CHECK(image.read(VK_IMAGE_LAYOUT_GENERAL, 1, 1) == expected);
    CHECK(image.read(VK_IMAGE_LAYOUT_GENERAL, 0, 2).size() == expected.size() * 4);
    CHECK(std::memcmp(image.bytes().data(), expected.data(), expected.size()) == 0);
}

TEST_CASE("in a recording the copy stands between the host's own commands, outside one it does not overtake it") {
    if (!has_vulkan()) return;
    const VulkanHost host;
    const AbiWorld world = world_with_outputs("vulkan", &host.vulkan), twin = world_with_outputs("cpu", nullptr);
    update(world);
    update(twin);
    const auto before = cells_of(twin, WADI_OUTPUT_FREE_SURFACE);
    update(twin);
    const Image image(host, {VK_FORMAT_R32_SFLOAT, 4}, NX, NY);
    auto to = image.given();
    record(
        host, world.id, 1,
        [&](VkCommandBuffer commands) {
            update(world);
            expect_copied(world, WADI_OUTPUT_FREE_SURFACE, to);
            image.read_into_buffer(commands, to.new_layout);
        },
        [&] {
            CHECK(wadi_vulkan_copy_output(world.id, WADI_OUTPUT_FREE_SURFACE, WADI_OUTPUT_CURRENT, &to) == WADI_NOT_READY);
            CHECK(error_mentions("would overtake it"));
        });
    CHECK(image.bytes() == cells_of(twin, WADI_OUTPUT_FREE_SURFACE));
    CHECK(image.bytes() != before);
}

TEST_CASE("copies wait for the host's semaphore and are ahead of the world's") {
    if (!has_vulkan()) return;
    const VulkanHost host;
    const AbiWorld world = world_with_outputs("vulkan", &host.vulkan), twin = world_with_outputs("cpu", nullptr);
    update(world);
    update(twin);
    hash_of(world);
    const Image image(host, {VK_FORMAT_R32G32_SFLOAT, 8}, NX, NY);
    const auto to = image.given();
    const wadi_vulkan_sync first{host.semaphore, 1}, second{host.semaphore, 2};
    REQUIRE(wadi_vulkan_wait(world.id, &first, 1) == WADI_OK);
    expect_copied(world, WADI_OUTPUT_FLOW, to);
    REQUIRE(wadi_vulkan_signal(world.id, &second) == WADI_OK);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::uint64_t value = 0;
    check_vk(vkGetSemaphoreCounterValue(host.vulkan.device, host.semaphore, &value), "vkGetSemaphoreCounterValue");
    CHECK(value == 0);
    VkSemaphoreSignalInfo go{};
    go.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO;
    go.semaphore = host.semaphore;
    go.value = 1;
    check_vk(vkSignalSemaphore(host.vulkan.device, &go), "vkSignalSemaphore");
    wait_for(&host.vulkan, host.semaphore, 2);
    CHECK(image.read(to.new_layout) == cells_of(twin, WADI_OUTPUT_FLOW));
}

TEST_CASE("copies without number leave updates their steps") {
    if (!has_vulkan()) return;
    const VulkanHost host;
    const AbiWorld world = world_with_outputs("vulkan", &host.vulkan, WADI_OUTPUT_BIT(WADI_OUTPUT_WATER_DEPTH));
    const auto pace = wadi_default_update_settings(); // which drops time where the device is behind
    REQUIRE(wadi_world_set_update_settings(world.id, &pace) == WADI_OK);
    update(world);
    const Image image(host, {VK_FORMAT_R32_SFLOAT, 4}, NX, NY);
    const auto to = image.given();
    for (int n = 0; n < 100; ++n) expect_copied(world, WADI_OUTPUT_WATER_DEPTH, to);
    hash_of(world); // waits
    CHECK(update(world).steps == 1);
}

TEST_CASE("copies into images that do not fit are refused by field, and worlds elsewhere have none") {
    if (!has_vulkan()) return;
    const VulkanHost host;
    constexpr auto asked = WADI_OUTPUT_FLOW;
    const AbiWorld world = world_with_outputs("vulkan", &host.vulkan, WADI_OUTPUT_BIT(asked));
    const AbiWorld twin = world_with_outputs("cpu", nullptr, WADI_OUTPUT_BIT(asked));
    const AbiWorld alone = world_with_outputs("vulkan", nullptr, WADI_OUTPUT_BIT(asked));
    const Image image(host, {VK_FORMAT_R32G32_SFLOAT, 8}, NX, NY);
    const auto good = image.given();
    const auto refused = [&](const wadi_vulkan_image& to, const char* named, wadi_output output = WADI_OUTPUT_FLOW,
                             wadi_output_set set = WADI_OUTPUT_CURRENT) {
        CAPTURE(named);
        CHECK(wadi_vulkan_copy_output(world.id, output, set, &to) == WADI_ERROR_BAD_ARGUMENT);
        CHECK_MESSAGE(error_mentions(named), std::string(wadi_get_last_error()));
        CHECK(error_mentions("wadi_vulkan_copy_output: "));
    };
    const auto changed = [&](auto change) {
        auto to = good;
        change(to);
        return to;
    };
    CHECK(wadi_vulkan_copy_output(world.id, asked, WADI_OUTPUT_CURRENT, &good) == WADI_NOT_READY); // nothing published
    for (const AbiWorld* each : {&world, &twin, &alone}) update(*each);
    refused(changed([](auto& to) { to.struct_size = 8; }), "image.struct_size is 8");
    refused(changed([](auto& to) { to.image = VK_NULL_HANDLE; }), "image.image is null");
    refused(changed([](auto& to) { to.format = VK_FORMAT_R32_SFLOAT; }),
            "image.format is 100; allowed: VK_FORMAT_R32G32_SFLOAT (103)");
    refused(changed([](auto& to) { to.old_layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL; }),
            "image.old_layout is 3; allowed: VK_IMAGE_LAYOUT_UNDEFINED (0), VK_IMAGE_LAYOUT_GENERAL (1)");
    refused(changed([](auto& to) { to.new_layout = VK_IMAGE_LAYOUT_UNDEFINED; }),
            "image.new_layout is 0; allowed: VK_IMAGE_LAYOUT_GENERAL (1)");
    refused(changed([](auto& to) { to.width = NX - 1; }), "image.x: 64 cells from texel 0 on do not fit into 63 texels");
    refused(changed([](auto& to) { to.height = 0; }), "image.y: 32 cells from texel 0 on do not fit into 0 texels");
    refused(changed([](auto& to) { to.mip_level = 1; }), "do not fit into 32 texels of mip level 1");
    refused(changed([](auto& to) { to.mip_level = 4'000'000'000u; }), "do not fit into 1 texels of mip level 4000000000");
    refused(changed([](auto& to) { to.x = 4'294'967'295u; }), "image.x: 64 cells from texel 4294967295 on");
    refused(changed([](auto& to) { to.cells = {60, 0, 5, 1}; }), "region of 5 x 1 cells at (60, 0)");
    refused(changed([](auto& to) { to.cells = {0, 0, 5, 0}; }), "region of 5 x 0 cells");
    refused(good, "was not asked for", WADI_OUTPUT_FOAM);
    refused(good, "output: 99", static_cast<wadi_output>(99));
    refused(good, "set: 7", asked, static_cast<wadi_output_set>(7));
    CHECK(wadi_vulkan_copy_output(world.id, asked, WADI_OUTPUT_CURRENT, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_vulkan_copy_output(world.id, asked, WADI_OUTPUT_PREVIOUS, &good) == WADI_NOT_READY);
    for (const AbiWorld* each : {&twin, &alone}) {
        CHECK(wadi_vulkan_copy_output(each->id, asked, WADI_OUTPUT_CURRENT, &good) == WADI_ERROR_NOT_SUPPORTED);
        CHECK(error_mentions("knows no images of a host"));
    }
    const wadi_vulkan_sync point{host.semaphore, 1};
    CHECK(wadi_vulkan_signal(alone.id, &point) == WADI_ERROR_NOT_SUPPORTED); // a semaphore of another device
    expect_copied(world, asked, good);
    CHECK(image.read(good.new_layout) == cells_of(twin, asked));
}
