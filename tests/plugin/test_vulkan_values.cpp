// Regions written from buffers of a Vulkan host: the bits that the CPU gets from the same values in host memory, in every order.
#include "tests/plugin/vulkan_test_host.hpp"
#include <chrono>
#include <cstring>
#include <thread>

using namespace wadi::test;

namespace {

constexpr wadi_region region{7, 4, 33, 19};
constexpr std::uint32_t pitch = 40, first = 5; // [numbers]

// A buffer of the host's that it can write in place.
struct HostBuffer {
    const VulkanHost& host;
    VkBuffer buffer{};
    VkDeviceMemory memory{};
    float* numbers = nullptr;
    static constexpr std::size_t count = first + std::size_t{pitch} * 19;

    explicit HostBuffer(const VulkanHost& on) : host(on) {
        VkBufferCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        info.size = count * 4;
        info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
        check_vk(vkCreateBuffer(host.vulkan.device, &info, nullptr, &buffer), "vkCreateBuffer");
        VkMemoryRequirements needs{};
        vkGetBufferMemoryRequirements(host.vulkan.device, buffer, &needs);
        VkPhysicalDeviceMemoryProperties properties{};
        vkGetPhysicalDeviceMemoryProperties(host.vulkan.physical_device, &properties);
        constexpr VkMemoryPropertyFlags wanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
        VkMemoryAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        allocate.allocationSize = needs.size;
        while ((needs.memoryTypeBits >> allocate.memoryTypeIndex & 1u) == 0 ||
               (properties.memoryTypes[allocate.memoryTypeIndex].propertyFlags & wanted) != wanted)
            ++allocate.memoryTypeIndex;
        check_vk(vkAllocateMemory(host.vulkan.device, &allocate, nullptr, &memory), "vkAllocateMemory");
        check_vk(vkBindBufferMemory(host.vulkan.device, buffer, memory, 0), "vkBindBufferMemory");
        void* mapped = nullptr;
        check_vk(vkMapMemory(host.vulkan.device, memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
        numbers = static_cast<float*>(mapped);
        std::fill_n(numbers, count, -77.0F);
    }
    HostBuffer(const HostBuffer&) = delete;
    HostBuffer& operator=(const HostBuffer&) = delete;
    ~HostBuffer() {
        vkDestroyBuffer(host.vulkan.device, buffer, nullptr);
        vkFreeMemory(host.vulkan.device, memory, nullptr);
    }
    wadi_device_values values(std::uint32_t row = pitch) const {
        auto given = wadi_default_device_values();
        given.handle_kind = WADI_HANDLE_VULKAN_BUFFER;
        given.handle = reinterpret_cast<std::uintptr_t>(buffer);
        given.offset = first * 4;
        given.row_pitch = std::uint64_t{row} * 4;
        return given;
    }
    /// Depths of 0 ... 1 m, another pattern for each turn; returned as the host writes them.
    std::vector<float> fill(int turn, std::uint32_t row = pitch) const {
        std::vector<float> dense;
        for (int n = 0; n < region.nx * region.ny; ++n) dense.push_back(static_cast<float>((n * 7 + turn * 13) % 41) / 40);
        for (std::size_t j = 0; j < 19; ++j) std::memcpy(numbers + first + j * row, dense.data() + j * 33, 33 * sizeof(float));
        return dense;
    }
};

void write_on_host(const AbiWorld& world, wadi_field field, const std::vector<float>& values) {
    REQUIRE_MESSAGE(wadi_world_write_region(world.id, field, &region, values.data(), values.size()) == WADI_OK,
                    std::string(wadi_get_last_error()));
}

void write_from(const AbiWorld& world, wadi_field field, const wadi_device_values& values) {
    REQUIRE_MESSAGE(wadi_world_write_region_from(world.id, field, &region, &values) == WADI_OK,
                    std::string(wadi_get_last_error()));
}

} // namespace

TEST_CASE("a region is written from a host's buffer, on its queue and in its command buffer") {
    if (!has_vulkan()) return;
    const VulkanHost host;
    const HostBuffer buffer(host);
    const AbiWorld world(make_world("vulkan", &host.vulkan)), twin(make_world("cpu", nullptr));
    int turn = 0;
    for (const auto field : {WADI_FIELD_TOTAL_WATER_DEPTH, WADI_FIELD_SAND_DEPTH, WADI_FIELD_TERRAIN}) {
        for (const std::uint32_t row : {pitch, std::uint32_t{33}}) { // 33: row behind row
            const auto dense = buffer.fill(++turn, row);
            step(world, 2);
            write_from(world, field, buffer.values(row));
            step(world, 2);
            step(twin, 2);
            write_on_host(twin, field, dense);
            step(twin, 2);
            CHECK(hash_of(world) == hash_of(twin)); // and waits, so that the buffer is free again
        }
    }
    const auto dense = buffer.fill(++turn);
    record(host, world.id, 1, [&](VkCommandBuffer commands) {
        CHECK(wadi_world_step(world.id, 1) == WADI_OK);
        write_from(world, WADI_FIELD_SAND_DEPTH, buffer.values());
        // What the host writes into its buffer behind that is not read; nothing else keeps the order.
        vkCmdFillBuffer(commands, buffer.buffer, 0, VK_WHOLE_SIZE, 0);
        CHECK(wadi_world_step(world.id, 2) == WADI_OK);
    });
    step(twin, 1);
    write_on_host(twin, WADI_FIELD_SAND_DEPTH, dense);
    step(twin, 2);
    CHECK(hash_of(world) == hash_of(twin));
    auto stats = wadi_default_world_stats();
    REQUIRE(wadi_world_get_stats(world.id, &stats) == WADI_OK);
    CHECK(stats.sand_drift_quanta == 0);
    CHECK(stats.water_drift_quanta == 0);
    CHECK(stats.sand_in > 0);
}

TEST_CASE("a host's buffer is read behind the host's semaphore") {
    if (!has_vulkan()) return;
    const VulkanHost host;
    const HostBuffer buffer(host);
    const AbiWorld world(make_world("vulkan", &host.vulkan)), twin(make_world("cpu", nullptr));
    step(world, 1);
    step(twin, 1);
    write_on_host(twin, WADI_FIELD_SAND_DEPTH, std::vector<float>(region.nx * region.ny, 0.25F));
    hash_of(world);
    const wadi_vulkan_sync ready{host.semaphore, 1}, done{host.semaphore, 2};
    REQUIRE(wadi_vulkan_wait(world.id, &ready, 1) == WADI_OK);
    write_from(world, WADI_FIELD_SAND_DEPTH, buffer.values());
    REQUIRE(wadi_vulkan_signal(world.id, &done) == WADI_OK);
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    std::fill_n(buffer.numbers, HostBuffer::count, 0.25F); // in time, since nothing has read it yet
    VkSemaphoreSignalInfo go{};
    go.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO;
    go.semaphore = host.semaphore;
    go.value = 1;
    check_vk(vkSignalSemaphore(host.vulkan.device, &go), "vkSignalSemaphore");
    wait_for(&host.vulkan, host.semaphore, 2);
    step(world, 3);
    step(twin, 3);
    CHECK(hash_of(world) == hash_of(twin));
}
