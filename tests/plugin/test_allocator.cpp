// A host's allocator: what the CPU backend takes from it is counted, refused in turn, and all of it comes back.
#include "tests/plugin/abi_worlds.hpp"
#include <array>
#include <cstring>
#include <doctest/doctest.h>
#include <functional>
#include <map>
#include <mutex>
#include <new>
#include <stdexcept>

using namespace wadi::test;

namespace {

// Called from several threads.
struct HostHeap {
    std::mutex mutex;
    std::map<void*, std::size_t> blocks;
    long asked = 0, refuse_at = 0; // call number refuse_at gets nothing
    bool throws = false;           // in place of NULL
    bool misused = false;
    std::size_t bytes() {
        const std::lock_guard lock(mutex);
        std::size_t sum = 0;
        for (const auto& [memory, size] : blocks) sum += size;
        return sum;
    }
};

void* heap_allocate(void* user, size_t bytes, size_t alignment) {
    auto& heap = *static_cast<HostHeap*>(user);
    const std::lock_guard lock(heap.mutex);
    heap.misused = heap.misused || bytes == 0 || alignment == 0 || (alignment & (alignment - 1)) != 0;
    if (++heap.asked == heap.refuse_at) {
        if (heap.throws) throw std::runtime_error("no memory left");
        return nullptr;
    }
    void* const memory = ::operator new (bytes, std::align_val_t{64});
    std::memset(memory, 0xA5, bytes);
    heap.misused = heap.misused || alignment > 64;
    heap.blocks[memory] = bytes;
    return memory;
}

void heap_free(void* user, void* memory, size_t bytes) {
    auto& heap = *static_cast<HostHeap*>(user);
    const std::lock_guard lock(heap.mutex);
    const auto found = heap.blocks.find(memory);
    if (found == heap.blocks.end() || found->second != bytes) {
        heap.misused = true;
        return;
    }
    heap.blocks.erase(found);
    ::operator delete (memory, std::align_val_t{64});
}

wadi_device_options with_heap(HostHeap* heap) {
    auto options = cpu_device();
    options.threads = 2;
    if (heap != nullptr) {
        options.allocate_memory = heap_allocate;
        options.free_memory = heap_free;
        options.memory_user = heap;
    }
    return options;
}

wadi_result make_pond(HostHeap* heap, wadi_world_id* world) {
    const auto options = with_heap(heap);
    return wadi_create_world_from_level_text(
        R"({ "format_version": 1, "name": "heap", "grid": { "nx": 40, "ny": 30, "dx": 0.5 }, "dt": 0.02,
        "terrain": [ { "shape": "plane", "height": 0.1, "slope_x": 0.05 } ], "water": [ { "shape": "box", "from": [0, 0], "to": [4, 9], "height": 1 } ] })",
        nullptr, nullptr, nullptr, &options, world);
}

// A call and, where it has no memory, the same call again. How often that was so.
struct Insisting {
    int refused = 0;
    bool other = false;                  // an error of another kind, or a second refusal
    bool rolls_back = true, kept = true; // whether a session goes back, and could
    void operator()(const std::function<wadi_result()>& call) {
        auto result = call();
        if (result == WADI_ERROR_OUT_OF_MEMORY) {
            ++refused;
            result = call();
        }
        if (result != WADI_OK) {
            other = true;
            MESSAGE(static_cast<int>(result), ": ", std::string(wadi_get_last_error()));
        }
    }
};

// A call that runs out of memory between its steps has taken those before.
wadi_result step_to(wadi_world_id world, uint64_t target) {
    uint64_t steps = 0;
    const auto known = wadi_world_get_time(world, nullptr, &steps);
    return known == WADI_OK ? wadi_world_step(world, static_cast<uint32_t>(target - steps)) : known;
}

// All that allocates: outputs, copies, kept states, a promotion, saving aside, queries. Returns the state's hash.
uint64_t heap_session(HostHeap* heap, Insisting& insist) {
    wadi_world_id world{};
    insist([&] { return make_pond(heap, &world); });
    const AbiWorld owner(world);
    insist([&] { return wadi_world_set_outputs(world, WADI_OUTPUT_BIT(WADI_OUTPUT_FREE_SURFACE) | WADI_OUTPUT_TILES_BIT); });
    insist([&] { return wadi_world_set_host_outputs(world, WADI_OUTPUT_BIT(WADI_OUTPUT_FOAM)); });
    insist([&] { return wadi_world_set_rollback(world, 3, 2); });
    insist([&] { return step_to(world, 4); });
    auto edit = wadi_default_edit();
    edit.layer = WADI_LAYER_SAND;
    edit.x0 = edit.y0 = 4;
    edit.radius = 3;
    edit.amount = 0.4;
    insist([&] { return wadi_world_edit(world, &edit, 1); });
    insist([&] { return step_to(world, 7); });
    auto frame = wadi_default_frame();
    insist([&] { return wadi_world_update(world, 0, &frame); });
    uint64_t ticket = 0;
    insist([&] { return wadi_world_begin_save(world, &ticket); });
    const std::array<float, 4> xy = {1, 1, 2, 2};
    insist([&] { return wadi_world_query(world, xy.data(), 2, &ticket); });
    uint64_t reached = 0;
    uint32_t kept = 0;
    insist([&] { return wadi_world_get_rollback_steps(world, nullptr, &kept); });
    insist.kept = kept > 0;
    if (insist.kept && insist.rolls_back) insist([&] { return wadi_world_roll_back(world, 4, &reached); });
    insist([&] { return wadi_world_edit(world, &edit, 1); });
    insist([&] { return step_to(world, 12); });
    insist([&] { return wadi_world_trim(world); });
    uint64_t hash = 0;
    insist([&] { return wadi_world_get_hash(world, &hash); });
    if (heap != nullptr) {
        uint32_t items = 0;
        CHECK(wadi_world_get_memory(world, nullptr, &items) == WADI_OK);
        CHECK(heap->bytes() >= device_bytes(world));
        CHECK(heap->bytes() < device_bytes(world) + std::size_t{4096} * heap->blocks.size());
        CHECK(heap->blocks.size() >= items);
    }
    return hash;
}

} // namespace

TEST_CASE("a host's allocator gives all that the world lists, the same bits, and has it back when the world is destroyed") {
    Insisting insist;
    const uint64_t expected = heap_session(nullptr, insist);
    HostHeap heap;
    CHECK(heap_session(&heap, insist) == expected);
    CHECK(insist.refused == 0);
    CHECK_FALSE(insist.other);
    CHECK(heap.asked > 30);
    CHECK(heap.blocks.empty());
    CHECK_FALSE(heap.misused);
}

TEST_CASE(
    "each refusal of a host's allocator is OUT_OF_MEMORY, spoils nothing but kept states, and the same call then succeeds") {
    Insisting unhindered;
    const uint64_t expected = heap_session(nullptr, unhindered);
    HostHeap counted;
    heap_session(&counted, unhindered);
    unhindered.rolls_back = false;
    const uint64_t without_kept_states = heap_session(nullptr, unhindered);
    CHECK(without_kept_states != expected);
    long refused = 0, dropped = 0;
    for (long n = 1; n <= counted.asked; ++n) {
        CAPTURE(n);
        HostHeap heap;
        heap.refuse_at = n;
        heap.throws = n % 2 == 0;
        Insisting insist;
        const uint64_t hash = heap_session(&heap, insist);
        CHECK(hash == (insist.kept ? expected : without_kept_states));
        CHECK_FALSE(insist.other);
        CHECK(heap.blocks.empty());
        CHECK_FALSE(heap.misused);
        dropped += insist.kept ? 0 : 1;
        refused += insist.refused;
    }
    MESSAGE(counted.asked, " blocks asked for, ", refused, " refusals told, ", dropped, " of them dropped kept states");
    CHECK(dropped < counted.asked / 4);
    CHECK(refused == counted.asked);
}

TEST_CASE("an allocator without its other half is refused") {
    HostHeap heap;
    auto options = with_heap(&heap);
    options.free_memory = nullptr;
    wadi_world_id world{};
    auto other = with_heap(nullptr);
    other.free_memory = heap_free;
    const char* const level = R"({ "format_version": 1, "name": "heap", "grid": { "nx": 8, "ny": 8, "dx": 0.5 }, "dt": 0.02 })";
    CHECK(wadi_create_world_from_level_text(level, nullptr, nullptr, nullptr, &other, &world) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("together or not at all"));
    CHECK(wadi_create_world_from_level_text(level, nullptr, nullptr, nullptr, &options, &world) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("together or not at all"));
    CHECK(heap.asked == 0);
}
