// What is left of memory: of the machine, of control groups of both versions, and of what other worlds were promised.
#include "backends/registry.hpp"
#include "engine/compute/available_memory.hpp"
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <unistd.h>
#include <utility>
#include <vector>

using namespace wadi;

namespace {

constexpr std::uint64_t one_mib = std::uint64_t{1} << 20;

// A machine as its files describe it.
struct FilesOfMachine {
    std::filesystem::path root = std::filesystem::temp_directory_path() / ("wadi-memory-" + std::to_string(getpid()));
    FilesOfMachine() { put("proc/meminfo", "MemTotal: 9000000 kB\nMemFree: 5 kB\nMemAvailable:    1048576 kB\nBuffers: 7 kB\n"); }
    ~FilesOfMachine() { std::filesystem::remove_all(root); }
    void put(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((root / name).parent_path());
        std::ofstream(root / name) << text;
    }
    std::uint64_t available() const { return available_memory(root.string() + "/"); }
};

} // namespace

TEST_CASE("available memory: the machine's, or less where a control group of version 2 has a limit, itself or above") {
    const FilesOfMachine files;
    CHECK(available_memory("/nowhere-at-all/") == 0);
    CHECK(files.available() == 1024 * one_mib);
    files.put("proc/self/cgroup", "0::/a/b\n");
    CHECK(files.available() == 1024 * one_mib); // no such folders: another's name space
    files.put("sys/fs/cgroup/a/b/memory.max", "max\n");
    files.put("sys/fs/cgroup/a/b/memory.current", "1000\n");
    CHECK(files.available() == 1024 * one_mib);
    files.put("sys/fs/cgroup/a/memory.max", std::to_string(500 * one_mib));
    files.put("sys/fs/cgroup/a/memory.current", std::to_string(300 * one_mib));
    CHECK(files.available() == 200 * one_mib);
    files.put("sys/fs/cgroup/a/memory.stat", "anon 5\ninactive_file " + std::to_string(50 * one_mib) + "\n");
    CHECK(files.available() == 250 * one_mib); // file pages can go
    files.put("sys/fs/cgroup/a/b/memory.max", std::to_string(10 * one_mib));
    CHECK(files.available() == 10 * one_mib - 1000);
    files.put("sys/fs/cgroup/a/b/memory.current", std::to_string(11 * one_mib)); // above its limit
    CHECK(files.available() == 0);
}

TEST_CASE("available memory: a control group of version 1, in a container that shows it as the top one") {
    const FilesOfMachine files;
    files.put("proc/self/cgroup", "5:cpu,cpuacct:/x\n4:hugetlb,memory:/docker/0123\n0::/\n");
    files.put("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
    files.put("sys/fs/cgroup/memory/memory.usage_in_bytes", std::to_string(100 * one_mib));
    CHECK(files.available() == 1024 * one_mib);
    files.put("sys/fs/cgroup/memory/memory.limit_in_bytes", std::to_string(128 * one_mib));
    CHECK(files.available() == 28 * one_mib);
    files.put("sys/fs/cgroup/memory/memory.stat", "inactive_file 9\ntotal_inactive_file " + std::to_string(4 * one_mib) + "\n");
    CHECK(files.available() == 32 * one_mib);
}

TEST_CASE("buffers that other devices of the process were promised and nobody touched yet count as taken") {
    const auto available = available_memory();
    if (available == 0) return;
    const auto open = [] {
        auto device = backends::open_device("cpu", -1, {});
        REQUIRE(device);
        return std::move(*device);
    };
    auto first = open(), second = open();
    const auto part = available / 8; // of 7.2 that may be taken
    std::vector<compute::Buffer> made;
    for (int n = 0; n < 5; ++n) {
        auto buffer = first->create_buffer({part, "a part"});
        REQUIRE_MESSAGE(buffer, buffer.status().message);
        made.push_back(*buffer);
    }
    const auto refused = second->create_buffer({4 * part, "too much"});
    REQUIRE(!refused);
    CHECK(refused.status().code == Code::out_of_memory);
    CHECK(refused.status().message.find("this machine can give") != std::string::npos);
    for (const auto buffer : made) first->destroy_buffer(buffer);
    first.reset();
    CHECK(second->create_buffer({4 * part, "now it fits"})); // promised, not touched
}
