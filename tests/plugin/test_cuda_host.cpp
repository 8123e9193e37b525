// CUDA events and memory of a host: worlds elsewhere refuse events; on a GPU the world waits for the host's stream and the host's
// for the world, and regions are written from device memory.
#include "tests/plugin/abi_worlds.hpp"
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <doctest/doctest.h>
#include <thread>
#include <wadi/wadi_cuda.h>
#if defined(__linux__)
#include <dlfcn.h>
#endif

using namespace wadi::test;

TEST_CASE("only worlds in CUDA take a host's events") {
    int stranger = 0; // nobody looks into it
    wadi_world_id gone{};
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        const AbiWorld world = pond(backend, 16, 12, 0.5, 1);
        for (const auto call : {wadi_cuda_wait, wadi_cuda_signal}) {
            CHECK(call(world.id, nullptr) == WADI_ERROR_BAD_ARGUMENT);
            CHECK(error_mentions("the event is null"));
            if (backend == "cuda") continue;
            CHECK(call(world.id, &stranger) == WADI_ERROR_NOT_SUPPORTED);
            CHECK(error_mentions("a world of the backend " + backend + " knows no CUDA events of a host"));
        }
        step(world, 2);
        gone = world.id;
    }
    CHECK(wadi_cuda_wait(gone, &stranger) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_cuda_signal(gone, &stranger) == WADI_ERROR_BAD_ARGUMENT);
}

#if defined(__linux__)
namespace {

// The few calls of the driver that this host makes, so that it compiles and runs where CUDA is not installed.
struct Driver {
    using Handle = void*;
    void* library = dlopen("libcuda.so.1", RTLD_NOW | RTLD_LOCAL);
    int (*init)(unsigned) = find<int(unsigned)>("cuInit");
    int (*device_get)(int*, int) = find<int(int*, int)>("cuDeviceGet");
    int (*device_name)(char*, int, int) = find<int(char*, int, int)>("cuDeviceGetName");
    int (*retain)(Handle*, int) = find<int(Handle*, int)>("cuDevicePrimaryCtxRetain");
    int (*release)(int) = find<int(int)>("cuDevicePrimaryCtxRelease_v2");
    int (*push)(Handle) = find<int(Handle)>("cuCtxPushCurrent_v2");
    int (*pop)(Handle*) = find<int(Handle*)>("cuCtxPopCurrent_v2");
    int (*stream_create)(Handle*, unsigned) = find<int(Handle*, unsigned)>("cuStreamCreate");
    int (*stream_destroy)(Handle) = find<int(Handle)>("cuStreamDestroy_v2");
    int (*stream_wait)(Handle, Handle, unsigned) = find<int(Handle, Handle, unsigned)>("cuStreamWaitEvent");
    int (*synchronize)(Handle) = find<int(Handle)>("cuStreamSynchronize");
    int (*host_function)(Handle, void (*)(void*), void*) = find<int(Handle, void (*)(void*), void*)>("cuLaunchHostFunc");
    int (*event_create)(Handle*, unsigned) = find<int(Handle*, unsigned)>("cuEventCreate");
    int (*event_destroy)(Handle) = find<int(Handle)>("cuEventDestroy_v2");
    int (*event_record)(Handle, Handle) = find<int(Handle, Handle)>("cuEventRecord");
    int (*event_query)(Handle) = find<int(Handle)>("cuEventQuery");
    int (*event_wait)(Handle) = find<int(Handle)>("cuEventSynchronize");
    int (*allocate_host)(void**, std::size_t, unsigned) = find<int(void**, std::size_t, unsigned)>("cuMemHostAlloc");
    int (*free_host)(void*) = find<int(void*)>("cuMemFreeHost");
    int (*allocate)(std::uint64_t*, std::size_t) = find<int(std::uint64_t*, std::size_t)>("cuMemAlloc_v2");
    int (*free)(std::uint64_t) = find<int(std::uint64_t)>("cuMemFree_v2");
    int (*copy_in)(std::uint64_t, const void*, std::size_t,
                   Handle) = find<int(std::uint64_t, const void*, std::size_t, Handle)>("cuMemcpyHtoDAsync_v2");
    int (*copy_out)(void*, std::uint64_t, std::size_t,
                    Handle) = find<int(void*, std::uint64_t, std::size_t, Handle)>("cuMemcpyDtoHAsync_v2");

    template <class Call> Call* find(const char* name) const {
        void* address = library != nullptr ? dlsym(library, name) : nullptr;
        Call* call = nullptr;
        std::memcpy(&call, &address, sizeof call);
        return call;
    }
};

constexpr int not_ready = 600; // CUDA_ERROR_NOT_READY
constexpr unsigned non_blocking = 1, no_timing = 2;

// What the host's stream waits at until the test opens it, at most half a minute.
struct Gate {
    std::atomic<bool> open{false};
    ~Gate() { open = true; }
    static void wait(void* gate) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (!static_cast<Gate*>(gate)->open && std::chrono::steady_clock::now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
};

// A host's CUDA: its context, a stream that works, one that reads, two events.
struct CudaHost {
    Driver driver;
    int device = 0;
    void *context = nullptr, *worker = nullptr, *reader = nullptr, *done = nullptr, *written = nullptr;
    Gate gate;

    CudaHost() {
        REQUIRE(driver.init(0) == 0);
        REQUIRE(driver.device_get(&device, 0) == 0);
        REQUIRE(driver.retain(&context, device) == 0);
        REQUIRE(driver.push(context) == 0);
        REQUIRE(driver.stream_create(&worker, non_blocking) == 0);
        REQUIRE(driver.stream_create(&reader, non_blocking) == 0);
        REQUIRE(driver.event_create(&done, no_timing) == 0);
        REQUIRE(driver.event_create(&written, no_timing) == 0);
    }
    CudaHost(const CudaHost&) = delete;
    CudaHost& operator=(const CudaHost&) = delete;
    ~CudaHost() {
        gate.open = true;
        for (void* stream : {worker, reader}) {
            driver.synchronize(stream);
            driver.stream_destroy(stream);
        }
        for (void* event : {done, written}) driver.event_destroy(event);
        driver.pop(&context);
        driver.release(device);
    }
    /// Whether the world is on this host's device.
    bool runs(const AbiWorld& world) const {
        char name[256] = "";
        auto info = wadi_default_world_info();
        REQUIRE(driver.device_name(name, sizeof name, device) == 0);
        REQUIRE(wadi_world_get_info(world.id, &info) == WADI_OK);
        if (std::string(info.device_name).starts_with(name)) return true; // which says the driver besides
        MESSAGE("SKIPPED: CUDA's device 0 is " << name << ", the world runs on " << info.device_name);
        return false;
    }
    /// Work on the host's stream that ends when the gate opens; `done` is behind it.
    void begin_work() {
        gate.open = false;
        REQUIRE(driver.host_function(worker, Gate::wait, &gate) == 0);
        REQUIRE(driver.event_record(done, worker) == 0);
    }
};

wadi_output_view view_of(const AbiWorld& world) {
    auto view = wadi_default_output_view();
    REQUIRE(wadi_world_get_view(world.id, WADI_OUTPUT_WATER_DEPTH, WADI_OUTPUT_CURRENT, &view) == WADI_OK);
    return view;
}

void update(const AbiWorld& world) {
    auto frame = wadi_default_frame();
    REQUIRE(wadi_world_update(world.id, 15'100'000, &frame) == WADI_OK);
    REQUIRE(frame.steps == 1);
}

bool has_cuda() {
    const auto backends = abi_backends();
    if (std::find(backends.begin(), backends.end(), "cuda") != backends.end()) return true;
    MESSAGE("SKIPPED: no CUDA device here");
    return false;
}

} // namespace

TEST_CASE("a region is written from a CUDA host's memory, behind the host's event") {
    if (!has_cuda()) return;
    constexpr int n = 48;
    constexpr std::size_t pitch = 40, first = 3; // [numbers]
    const wadi_region region{9, 5, 31, 27};
    const AbiWorld world = mixed_world("cuda", n), twin = mixed_world("cpu", n);
    CudaHost host;
    if (!host.runs(world)) return;
    std::vector<float> memory(first + pitch * 27, -77.0F), dense;
    for (int k = 0; k < region.nx * region.ny; ++k) dense.push_back(static_cast<float>(k * 7 % 41) / 40);
    for (std::size_t j = 0; j < 27; ++j)
        std::memcpy(memory.data() + first + j * pitch, dense.data() + j * 31, 31 * sizeof(float));
    auto values = wadi_default_device_values();
    values.handle_kind = WADI_HANDLE_CUDA_POINTER;
    values.offset = first * 4;
    values.row_pitch = pitch * 4;
    REQUIRE(host.driver.allocate(&values.handle, memory.size() * 4) == 0);
    REQUIRE(host.driver.copy_in(values.handle, memory.data(), memory.size() * 4, host.reader) == 0);
    REQUIRE(host.driver.synchronize(host.reader) == 0);
    step(world, 1);
    step(twin, 1);
    for (const bool gated : {false, true}) { // not at first, when the driver loads and allocates, which may wait for streams
        for (const auto field : {WADI_FIELD_TOTAL_WATER_DEPTH, WADI_FIELD_SAND_DEPTH, WADI_FIELD_TERRAIN}) {
            host.begin_work();
            if (!gated) host.gate.open = true;
            REQUIRE(wadi_cuda_wait(world.id, host.done) == WADI_OK);
            REQUIRE_MESSAGE(wadi_world_write_region_from(world.id, field, &region, &values) == WADI_OK,
                            std::string(wadi_get_last_error()));
            REQUIRE(wadi_cuda_signal(world.id, host.written) == WADI_OK);
            if (gated) CHECK(host.driver.event_query(host.written) == not_ready);
            host.gate.open = true;
            CHECK(host.driver.event_wait(host.written) == 0);
            REQUIRE(wadi_world_write_region(twin.id, field, &region, dense.data(), dense.size()) == WADI_OK);
            step(world, 2);
            step(twin, 2);
            CHECK(hash_of(world) == hash_of(twin));
        }
    }
    CHECK(host.driver.free(values.handle) == 0);
}

TEST_CASE("a world waits for a host's CUDA stream and the host's stream for the world") {
    if (!has_cuda()) return;
    constexpr int n = 48;
    const AbiWorld world = mixed_world("cuda", n), twin = mixed_world("cpu", n);
    CudaHost host;
    if (!host.runs(world)) return;
    for (const AbiWorld* each : {&world, &twin}) {
        REQUIRE(wadi_world_set_outputs(each->id, WADI_OUTPUT_BIT(WADI_OUTPUT_WATER_DEPTH)) == WADI_OK);
        update(*each);
        hash_of(*each); // waits
    }

    // Without wadi_cuda_wait the world is done while the host's stream still works.
    host.begin_work();
    update(world);
    REQUIRE(wadi_cuda_signal(world.id, host.written) == WADI_OK);
    CHECK(host.driver.event_wait(host.written) == 0);
    CHECK(host.driver.event_query(host.done) == not_ready);
    CHECK(view_of(world).finished == 1);
    host.gate.open = true;
    CHECK(host.driver.synchronize(host.worker) == 0);

    host.begin_work();
    REQUIRE(wadi_cuda_wait(world.id, host.done) == WADI_OK);
    update(world);
    REQUIRE(wadi_cuda_signal(world.id, host.written) == WADI_OK);
    const auto view = view_of(world);
    REQUIRE(view.handle_kind == WADI_HANDLE_CUDA_POINTER);
    constexpr std::size_t row = std::size_t{n} * 4;
    void* rows = nullptr;
    REQUIRE(host.driver.allocate_host(&rows, row * n, 0) == 0);
    std::memset(rows, 0xA5, row * n);
    REQUIRE(host.driver.stream_wait(host.reader, host.written, 0) == 0);
    for (std::size_t j = 0; j < n; ++j)
        REQUIRE(host.driver.copy_out(static_cast<char*>(rows) + j * row, view.handle + view.offset + j * view.row_pitch, row,
                                     host.reader) == 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    CHECK(host.driver.event_query(host.written) == not_ready);
    CHECK(view_of(world).finished == 0);
    host.gate.open = true;
    CHECK(host.driver.synchronize(host.reader) == 0);

    update(twin);
    update(twin);
    CHECK(hash_of(world) == hash_of(twin));
    const auto expected = view_of(twin);
    bool same = true;
    for (std::size_t j = 0; j < n; ++j)
        same &= std::memcmp(static_cast<char*>(rows) + j * row,
                            reinterpret_cast<const char*>(static_cast<std::uintptr_t>(expected.handle)) + expected.offset +
                                j * expected.row_pitch,
                            row) == 0;
    CHECK(same);
    host.driver.free_host(rows);
}
#endif
