// What a process or its control group cannot give is told.
#include "tests/faults/attack/attack.hpp"
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sys/resource.h>
#include <unistd.h>

namespace attack {
namespace {

/// Makes worlds until one is refused. 0 where that was told as a lack of memory.
int worlds_until_refused(int cells) {
    for (int n = 0; n < 1000; ++n) {
        wadi_world_id world{};
        const auto made = make(cells, world);
        const auto stepped = made == WADI_OK ? wadi_world_step(world, 2) : made;
        if (stepped == WADI_ERROR_OUT_OF_MEMORY) return 0;
        if (!expect(stepped == WADI_OK, "a world too many is told as a lack of memory")) return 1;
    }
    return 2;
}

/// A grid that takes 19/20 of what there is, which is too much: what is said tells the share that counts.
void refuse_a_grid(std::uint64_t bytes) {
    constexpr double drawn = 36; // bytes per cell
    wadi_world_id world{};
    const int cells = static_cast<int>(std::sqrt(0.95 * static_cast<double>(bytes) / drawn));
    expect(make(cells, world) == WADI_ERROR_OUT_OF_MEMORY, "a grid of 19/20 of the memory is refused");
    const std::string said = wadi_get_last_error();
    const auto at = said.find("cells need ");
    unsigned long need = 0, there = 0;
    const bool numbers =
        at != std::string::npos &&
        std::sscanf(said.c_str() + at, "cells need %lu MiB while they are drawn; 9/10 of the %lu MiB", &need, &there) == 2;
    expect(numbers && 10 * (need + 1) > 9 * there, "the text says less than it refuses for: " + said);
}

/// A group of processes that may take so many bytes; its folder, empty where the machine allows none.
std::string memory_group(const std::string& bytes) {
    const std::string name = "wadi-attack-" + std::to_string(getpid());
    for (const auto& [root, limit] : {std::pair<std::string, const char*>{"/sys/fs/cgroup/", "memory.max"},
                                      {"/sys/fs/cgroup/memory/", "memory.limit_in_bytes"}}) {
        std::error_code failed;
        const std::string folder = root + name;
        if (!std::filesystem::exists(root + "cgroup.procs", failed) || !std::filesystem::create_directory(folder, failed))
            continue;
        std::ofstream file(folder + "/" + limit);
        if (file << bytes << std::flush) return folder;
        std::filesystem::remove(folder, failed);
    }
    return {};
}

/// The most that the group ever took [MiB]; below 0 where the system does not say.
double most_used(const std::string& group) {
    for (const char* name : {"/memory.peak", "/memory.max_usage_in_bytes"}) {
        double bytes = 0;
        if (std::ifstream(group + name) >> bytes) return bytes / (1 << 20);
    }
    return -1;
}

} // namespace

int memory() {
    for (const std::uint64_t mebibytes : {4U, 16U, 48U, 100U, 300U}) {
        const auto ran = run_child([&] {
            const rlim_t most = pages(0) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (mebibytes << 20);
            const rlimit limit{most, most};
            setrlimit(RLIMIT_AS, &limit);
            return worlds_until_refused(200);
        });
        expect(ran.code == 0,
               "address space of " + std::to_string(mebibytes) + " MiB more: ended with " + std::to_string(ran.code));
    }
    std::printf("address space for 4 to 300 MiB more: worlds until one is refused\n");
    const auto made = [](int count) {
        return run_child([&] {
            for (int n = 0; n < count; ++n) {
                wadi_world_id world{};
                if (make(8, world) != WADI_OK || wadi_world_step(world, 1) != WADI_OK) return 1;
            }
            return 0;
        });
    };
    const auto few = made(10), many = made(210);
    expect(few.code == 0 && many.code == 0, "210 small worlds");
    const double each = (many.mebibytes - few.mebibytes) / 200;
    std::printf("a world of 8 x 8 cells takes %.2f MiB\n", each);
    expect(each < 1, "a small world takes little"); // and no page of 2 MiB for itself
    // Where the last world that fits ends differs by limit: most of a world lies between the first and the last.
    for (const std::uint64_t mebibytes : {230U, 245U, 260U, 275U, 290U, 305U}) {
        const std::string group = memory_group(std::to_string(mebibytes << 20));
        if (group.empty()) {
            std::printf("a control group: not on this machine\n");
            return wrong;
        }
        const auto ran = run_child([&] {
            std::ofstream(group + "/cgroup.procs") << getpid() << std::flush;
            refuse_a_grid(mebibytes << 20);
            return worlds_until_refused(700) + wrong;
        });
        const std::string name = "a control group of " + std::to_string(mebibytes) + " MiB";
        const double most = most_used(group);
        if (most < 0)
            std::printf("%s: this system does not tell how much was used\n", name.c_str());
        else
            std::printf("%s: at most %.0f MiB used\n", name.c_str(), most);
        expect(ran.code == 0, name + ": ended with " + std::to_string(ran.code));
        expect(most < 0 || most > 100, name + ": worlds were made in it");
        expect(most <= static_cast<double>(mebibytes - 16), name + ": 16 MiB are left");
        rmdir(group.c_str());
    }
    return wrong;
}

} // namespace attack
