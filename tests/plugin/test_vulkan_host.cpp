// Worlds on a host's own Vulkan device: what they refuse, and a promotion in the middle of a recording. What works every frame is
// tested by samples/vulkan_host_minimal.
#include "tests/plugin/vulkan_test_host.hpp"

using namespace wadi::test;

namespace {

wadi_result create(const char* backend, const wadi_vulkan_host* host, wadi_world_id& world) {
    auto options = wadi_default_device_options();
    options.backend = backend;
    options.vulkan_host = host;
    auto arrays = wadi_default_world_arrays();
    arrays.settings_json = settings;
    arrays.nx = NX;
    arrays.ny = NY;
    return wadi_create_world_from_arrays(&arrays, &options, &world);
}

wadi_edit heap_of_sand() {
    auto edit = wadi_default_edit();
    edit.layer = WADI_LAYER_SAND;
    edit.x0 = 5;
    edit.y0 = 2.5;
    edit.amount = 0.5;
    return edit;
}

} // namespace

TEST_CASE("a host's Vulkan device is refused by name where it cannot serve") {
    if (!has_vulkan()) return;
    const VulkanHost host;
    wadi_world_id world{};
    CHECK(create("cpu", &host.vulkan, world) == WADI_ERROR_NOT_SUPPORTED);
    CHECK(error_mentions("the backend is cpu"));
    if (create("cuda", &host.vulkan, world) == WADI_ERROR_NOT_FOUND) {
        CHECK(error_mentions("no backend 'cuda' in this build"));
    } else {
        CHECK(error_mentions("VK_KHR_external_memory_fd"));
        CHECK(error_mentions("wadi_world_set_host_outputs"));
    }
    auto wrong = host.vulkan;
    wrong.struct_size = 7;
    CHECK(create("vulkan", &wrong, world) == WADI_ERROR_BAD_ARGUMENT);
    wrong = host.vulkan;
    wrong.queue = nullptr;
    CHECK(create("vulkan", &wrong, world) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("queue"));
    wrong = host.vulkan;
    wrong.queue_family = 1000;
    CHECK(create("vulkan", &wrong, world) == WADI_ERROR_NOT_SUPPORTED);
    CHECK(error_mentions("queue family 1000"));
    wrong = host.vulkan;
    wrong.sharing_family_count = 1;
    CHECK(create("vulkan", &wrong, world) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("sharing_families"));
}

TEST_CASE("semaphores and recordings refuse null handles, worlds elsewhere and each other") {
    if (!has_vulkan()) return;
    const VulkanHost host;
    const AbiWorld here(make_world("vulkan", &host.vulkan)), elsewhere(make_world("cpu", nullptr));
    const wadi_vulkan_sync point{host.semaphore, 1}, null{VK_NULL_HANDLE, 1};
    CHECK(wadi_vulkan_wait(here.id, nullptr, 1) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_vulkan_wait(here.id, &null, 1) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_vulkan_signal(here.id, &null) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_vulkan_wait(elsewhere.id, &point, 1) == WADI_ERROR_NOT_SUPPORTED);
    CHECK(wadi_vulkan_signal(elsewhere.id, &point) == WADI_ERROR_NOT_SUPPORTED);
    CHECK(wadi_vulkan_begin_recording(here.id, VK_NULL_HANDLE, &point) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_vulkan_end_recording(here.id) == WADI_ERROR_BAD_ARGUMENT);
    int stranger = 0; // nobody looks into it
    const auto commands = reinterpret_cast<VkCommandBuffer>(&stranger);
    CHECK(wadi_vulkan_begin_recording(elsewhere.id, commands, &point) == WADI_ERROR_NOT_SUPPORTED);
    step(here, 3);
    step(elsewhere, 3);
    CHECK(hash_of(here) == hash_of(elsewhere));
}

TEST_CASE("an edit of a new material promotes in the middle of a recording, same bits as on the CPU") {
    if (!has_vulkan()) return;
    const VulkanHost host;
    const AbiWorld recorded(make_world("vulkan", &host.vulkan)), twin(make_world("cpu", nullptr));
    const auto edit = heap_of_sand();
    std::uint64_t value = 0;
    record(host, recorded.id, ++value, [&](VkCommandBuffer) {
        CHECK(wadi_world_step(recorded.id, 2) == WADI_OK);
        CHECK(wadi_world_edit(recorded.id, &edit, 1) == WADI_OK);
        CHECK(wadi_world_step(recorded.id, 1) == WADI_OK);
    });
    record(host, recorded.id, ++value, [&](VkCommandBuffer) { CHECK(wadi_world_step(recorded.id, 4) == WADI_OK); });
    step(twin, 2);
    CHECK(wadi_world_edit(twin.id, &edit, 1) == WADI_OK);
    step(twin, 5);
    CHECK(steps_of(recorded) == steps_of(twin));
    CHECK(hash_of(recorded) == hash_of(twin));
}
