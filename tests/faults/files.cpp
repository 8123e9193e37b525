// wadi-test-files: files that do harm. Snapshots that are no files, too large or saved twice at once; maps that do not fit into
// memory. Usage: wadi-test-files snapshots | rights | savers | memory.
#include "tests/unit/map_files.hpp"
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>
#include <wadi/wadi.h>

namespace {

using map_files::Folder;

int wrong = 0;

void expect(bool good, const std::string& what) {
    if (good) return;
    ++wrong;
    std::fprintf(stderr, "WRONG: %s (%s)\n", what.c_str(), wadi_get_last_error());
}

wadi_device_options cpu() {
    auto options = wadi_default_device_options();
    options.backend = "cpu";
    options.threads = 1;
    return options;
}

wadi_world_id make_world(const std::string& more = "\"duration\": 1") {
    const std::string level = R"({ "format_version": 1, "name": "files", "grid": { "nx": 64, "ny": 64, "dx": 0.5 }, "dt": 0.02,
        "water": [ { "shape": "plane", "height": 1 } ], )" +
                              more + " }";
    const auto options = cpu();
    wadi_world_id world{};
    expect(wadi_create_world_from_level_text(level.c_str(), nullptr, nullptr, nullptr, &options, &world) == WADI_OK, "create");
    return world;
}

std::size_t files_in(const Folder& folder) {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++count;
    return count;
}

/// What a load refuses leaves the world as it was, soon and without much memory.
int snapshots() {
    const Folder folder;
    const auto world = make_world();
    const std::string good = folder.file("good");
    expect(wadi_world_save_file(world, good.c_str()) == WADI_OK, "save");
    std::uint64_t before = 0, after = 0;
    expect(wadi_world_get_hash(world, &before) == WADI_OK, "hash");
    const auto refused = [&](const std::string& path, wadi_result how, const char* part) {
        const auto result = wadi_world_load_file(world, path.c_str());
        expect(result == how, path + ": load answered " + std::to_string(result));
        expect(std::string(wadi_get_last_error()).find(part) != std::string::npos, path + ": the message says " + part);
        expect(wadi_world_get_hash(world, &after) == WADI_OK && after == before, path + ": the world is as it was");
    };
    const std::string huge = folder.write("huge", std::string("WADISNAP"));
    std::filesystem::resize_file(huge, std::uintmax_t{1} << 40); // holes
    refused(huge, WADI_ERROR_BAD_FILE, "bytes");
    const std::string pipe = folder.file("pipe");
    expect(mkfifo(pipe.c_str(), 0600) == 0, "mkfifo");
    refused(pipe, WADI_ERROR_BAD_FILE, "not a regular file");
    refused("/dev/zero", WADI_ERROR_BAD_FILE, "not a regular file");
    refused(folder.path(), WADI_ERROR_BAD_FILE, "not a regular file");
    const std::size_t files = files_in(folder);
    for (const std::string& path : {pipe, folder.path()}) {
        expect(wadi_world_save_file(world, path.c_str()) == WADI_ERROR_BAD_FILE, path + ": saving is refused");
        expect(!std::filesystem::is_regular_file(path), path + " is what it was");
    }
    expect(files_in(folder) == files, "nothing is left behind");
    expect(wadi_world_load_file(world, good.c_str()) == WADI_OK, "a good snapshot loads");
    // One with more effects than the world has, and so more fields, is read.
    const auto other = make_world(R"("sand": [ { "shape": "plane", "height": 1 } ])");
    expect(wadi_world_save_file(other, good.c_str()) == WADI_OK, "save of a larger world");
    expect(wadi_world_load_file(world, good.c_str()) == WADI_OK, "a larger snapshot of the same level loads");
    wadi_destroy_world(other);
    expect(wadi_world_step(world, 1) == WADI_OK, "step");
    wadi_destroy_world(world);
    return wrong;
}

/// A save keeps what the file that it replaces was: its permissions, and that a link leads to it; any name that the disk takes.
int rights() {
    const Folder folder;
    const auto world = make_world();
    const auto mode_of = [](const std::string& path) {
        struct stat about {};
        return stat(path.c_str(), &about) == 0 ? about.st_mode & 07777 : 0U;
    };
    const auto saves = [&](const std::string& path) {
        expect(wadi_world_save_file(world, path.c_str()) == WADI_OK, path + ": save");
        expect(wadi_world_load_file(world, path.c_str()) == WADI_OK, path + ": load");
    };
    const std::string secret = folder.write("secret", std::string("old"));
    expect(chmod(secret.c_str(), 0600) == 0, "chmod");
    saves(secret);
    expect(mode_of(secret) == 0600, "a private file stays private");
    const std::string link = folder.file("link"), dangling = folder.file("dangling"), new_file = folder.file("new");
    std::filesystem::create_symlink("secret", link);
    std::filesystem::create_symlink("new", dangling);
    saves(link);
    expect(std::filesystem::is_symlink(link), "a link stays a link");
    expect(mode_of(secret) == 0600, "and what it leads to is private");
    saves(dangling);
    expect(std::filesystem::is_symlink(dangling) && std::filesystem::is_regular_file(new_file),
           "a link to what is not there yet");
    for (const std::size_t length : {200U, 230U, 231U, 255U}) saves(folder.file(std::string(length, 'n')));
    expect(files_in(folder) == 4 + 4, "no other file is left");
    wadi_destroy_world(world);
    return wrong;
}

/// Two worlds save to one path, a third loads it: whole snapshots alone, and no other file is left.
int savers() {
    const Folder folder;
    const std::string path = folder.file("shared");
    const auto first = make_world();
    expect(wadi_world_save_file(first, path.c_str()) == WADI_OK, "save");
    std::atomic<bool> done{false};
    std::atomic<int> saves{0}, failed{0};
    std::vector<std::thread> threads;
    for (int n = 0; n < 2; ++n) {
        threads.emplace_back([&] {
            const auto world = make_world();
            for (; !done; ++saves)
                if (wadi_world_step(world, 1) != WADI_OK || wadi_world_save_file(world, path.c_str()) != WADI_OK) ++failed;
            wadi_destroy_world(world);
        });
    }
    int loaded = 0;
    for (; loaded < 200 || saves < 200; ++loaded)
        if (wadi_world_load_file(first, path.c_str()) != WADI_OK) ++failed;
    done = true;
    for (auto& thread : threads) thread.join();
    std::printf("%d saves to one path by two worlds, %d loads, %d failed\n", saves.load(), loaded, failed.load());
    expect(failed == 0, "each save and each load succeeds");
    expect(files_in(folder) == 1, "one file is left");
    wadi_destroy_world(first);
    return wrong;
}

/// What `call` returns in a child that may take `bytes` more of memory; -1 if it was ended by a signal.
int in_child(rlim_t bytes, const std::function<int()>& call) {
    const pid_t child = fork();
    if (child == 0) {
        std::ifstream status("/proc/self/statm");
        rlim_t pages = 0;
        status >> pages;
        const rlim_t most = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + bytes;
        const rlimit limit{most, most};
        setrlimit(RLIMIT_AS, &limit);
        _exit(call());
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// A map of 32 MiB when decoded, in a process that has 12 MiB left: told.
int memory() {
    const Folder folder;
    folder.write("honest.png", map_files::png_of_zeros(4096, 2048, 16, 4));
    const std::string level = folder.write("level.json", std::string(R"({ "format_version": 1, "name": "files", "dt": 0.02,
        "grid": { "nx": 16, "ny": 16, "dx": 0.5 }, "terrain": [ { "file": "honest.png", "max": 1 } ] })"));
    const auto create = [&] {
        const auto options = cpu();
        wadi_world_id world{};
        return static_cast<int>(wadi_create_world_from_level(level.c_str(), nullptr, &options, &world));
    };
    const int answer = in_child(12u << 20, create);
    expect(answer == WADI_ERROR_OUT_OF_MEMORY, "little memory: the answer is " + std::to_string(answer));
    expect(in_child(1u << 30, create) == WADI_OK, "with memory the level loads");
    return wrong;
}

} // namespace

int main(int argc, char** argv) {
    alarm(300); // a load that waits for ever fails
    const std::string what = argc > 1 ? argv[1] : "";
    if (what != "snapshots" && what != "rights" && what != "savers" && what != "memory") {
        std::fprintf(stderr, "wadi-test-files snapshots | rights | savers | memory\n");
        return 2;
    }
    const int failures = what == "snapshots" ? snapshots() : what == "rights" ? rights() : what == "savers" ? savers() : memory();
    std::puts(failures == 0 ? "passed" : "FAILED");
    return failures == 0 ? 0 : 1;
}
