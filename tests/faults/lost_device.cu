// A CUDA device that is really lost: a kernel of the host writes where nothing is, and CUDA refuses all further work in this
// process. The world says so, what was saved before goes on elsewhere, everything can be destroyed. A program of its own, since
// nothing on the device works after it. Exit code 77: no GPU.
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>
#include <wadi/wadi.h>

namespace {

const char* const LEVEL = R"({ "format_version": 1, "name": "lost", "grid": { "nx": 40, "ny": 36, "dx": 0.25 }, "dt": 0.01,
    "terrain": [ { "shape": "plane", "height": 0.1, "slope_x": 0.05 } ], "sand": [ { "shape": "box", "from": [4, 2], "to": [8, 6], "height": 1 } ],
    "water": [ { "shape": "box", "from": [0, 0], "to": [3, 9], "height": 1 } ] })";

int wrong = 0;

void expect(bool good, const std::string& what) {
    if (good) return;
    ++wrong;
    std::fprintf(stderr, "WRONG: %s (%s)\n", what.c_str(), wadi_get_last_error());
}

wadi_result make_world(const char* backend, wadi_world_id* world) {
    auto options = wadi_default_device_options();
    options.backend = backend;
    return wadi_create_world_from_level_text(LEVEL, nullptr, nullptr, nullptr, &options, world);
}

std::uint64_t hash_of(wadi_world_id world) {
    std::uint64_t hash = 0;
    expect(wadi_world_get_hash(world, &hash) == WADI_OK, "a hash");
    return hash;
}

__global__ void write_at(int* address) { *address = 1; }

/// Both runtimes, this program's and the library's, use the device's one primary context.
void lose_device() {
    write_at<<<1, 1>>>(reinterpret_cast<int*>(64)); // aligned, and never mapped
    const cudaError_t result = cudaDeviceSynchronize();
    expect(result == cudaErrorIllegalAddress, std::string("the kernel's fault: ") + cudaGetErrorName(result));
}

/// Every call that needs the device.
void expect_lost(wadi_world_id world, std::uint64_t save_ticket, std::uint64_t query_ticket,
                 const std::vector<unsigned char>& snapshot) {
    const auto lost = [](wadi_result result, const char* call) {
        expect(result == WADI_ERROR_DEVICE_LOST, std::string(call) + " answered " + std::to_string(result));
    };
    std::vector<unsigned char> bytes(snapshot.size());
    std::size_t size = bytes.size();
    std::uint64_t number = 0;
    wadi_query_result answer;
    float cells[40 * 36];
    const float xy[2] = {1, 1};
    auto frame = wadi_default_frame();
    auto stats = wadi_default_world_stats();
    lost(wadi_world_step(world, 1), "step");
    lost(wadi_world_get_error(world), "get_error");
    expect(std::string(wadi_get_last_error()).find("cudaErrorIllegalAddress") != std::string::npos, "the error's name");
    lost(wadi_world_update(world, 20'000'000, &frame), "update");
    lost(wadi_world_end_save(world, save_ticket, bytes.data(), &size), "end_save");
    lost(wadi_world_get_query(world, query_ticket, &answer, 1, nullptr, nullptr), "get_query");
    lost(wadi_world_query(world, xy, 1, &number), "query");
    lost(wadi_world_begin_save(world, &number), "begin_save");
    size = bytes.size();
    lost(wadi_world_save(world, bytes.data(), &size), "save");
    lost(wadi_world_load(world, snapshot.data(), snapshot.size()), "load");
    lost(wadi_world_roll_back(world, 18, nullptr), "roll_back");
    lost(wadi_world_set_rollback(world, 1, 1), "set_rollback");
    lost(wadi_world_get_hash(world, &number), "get_hash");
    lost(wadi_world_get_stats(world, &stats), "get_stats");
    lost(wadi_world_read_field(world, WADI_FIELD_TOTAL_WATER_DEPTH, cells, 40 * 36), "read_field");
}

} // namespace

int main() {
    wadi_world_id world{}, other{};
    const auto made = make_world("cuda", &world);
    if (made == WADI_ERROR_NOT_FOUND) {
        std::printf("skipped: %s\n", wadi_get_last_error());
        return 77;
    }
    expect(made == WADI_OK, "a world on CUDA");
    if (wrong > 0) return 1;
    expect(wadi_world_set_rollback(world, 4, 1) == WADI_OK, "set_rollback");
    expect(wadi_world_step(world, 20) == WADI_OK, "steps");
    const std::uint64_t hash = hash_of(world);
    std::size_t size = 0;
    expect(wadi_world_save(world, nullptr, &size) == WADI_OK, "the snapshot's size");
    std::vector<unsigned char> snapshot(size);
    expect(wadi_world_save(world, snapshot.data(), &size) == WADI_OK, "a snapshot");
    std::uint64_t save_ticket = 0, query_ticket = 0;
    const float xy[2] = {1, 1};
    expect(wadi_world_begin_save(world, &save_ticket) == WADI_OK, "begin_save");
    expect(wadi_world_query(world, xy, 1, &query_ticket) == WADI_OK, "query");

    lose_device();
    expect_lost(world, save_ticket, query_ticket, snapshot);
    expect(make_world("cuda", &other) != WADI_OK, "no second world on a lost device");

    expect(make_world("cpu", &other) == WADI_OK, "a world on the CPU");
    expect(wadi_world_load(other, snapshot.data(), snapshot.size()) == WADI_OK, "the snapshot survives");
    expect(hash_of(other) == hash, "the snapshot's hash");
    expect(wadi_world_step(other, 20) == WADI_OK, "the CPU goes on");
    expect(wadi_destroy_world(world) == WADI_OK, "destroying the lost world");
    expect(wadi_destroy_world(other) == WADI_OK, "destroying the other");
    std::puts(wrong == 0 ? "passed" : "FAILED");
    return wrong == 0 ? 0 : 1;
}
