// Saves under a power cut: what the library asks of the system while it saves is recorded, and after each of those calls every
// state of the disk is made that a file system may leave then: data that was not synchronised is lost, torn or zeros, names that
// were not synchronised are there or not, in any combination. In each of them the save from before or the new one loads, and the
// new one once the call has returned. Usage: wadi-test-power-cut
#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <sys/types.h>
#include <unistd.h>
#include <vector>
#include <wadi/wadi.h>

namespace {

namespace fs = std::filesystem;

// ---- What the library asks of the system ----

struct Call {
    enum Kind { make, write, sync_file, rename, remove, sync_folder } kind;
    int file = 0;         // numbers count up with every file that is made
    std::string name, to; // whole paths
    std::string bytes;    // written at the end, as saves are
};
const char* const kind_names[] = {"make", "write", "synchronise the file", "rename", "remove", "synchronise the folder"};

std::string watched; // folder whose calls are recorded; empty: none
std::vector<Call> calls;
std::map<int, int> files;           // descriptor -> number of the file
std::map<int, std::string> folders; // descriptor -> path
std::map<std::string, int> made;    // path -> number
std::size_t fail_at = 0;            // this call fails, counted from 1; 0: none
int newest = 0;

bool is_watched(const char* path) { return !watched.empty() && std::string(path).rfind(watched, 0) == 0; }

/// Whether the call is to fail; else it is recorded.
bool fails(Call call) {
    calls.push_back(std::move(call));
    if (calls.size() != fail_at) return false;
    calls.pop_back();
    fail_at = 0;
    errno = EIO;
    return true;
}

template <class Function> Function* real(const char* name) { return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name)); }

int open_real(const char* path, int flags, mode_t mode) { return real<int(const char*, int, ...)>("open")(path, flags, mode); }

int open_watched(const char* path, int flags, mode_t mode) {
    if (!is_watched(path)) return open_real(path, flags, mode);
    if ((flags & O_CREAT) != 0 && fails({Call::make, newest + 1, path, {}, {}})) return -1;
    const int number = open_real(path, flags, mode);
    if (number < 0) {
        if ((flags & O_CREAT) != 0) calls.pop_back();
        return number;
    }
    if ((flags & O_CREAT) != 0) {
        files[number] = made[path] = ++newest;
    } else if (fs::is_directory(path)) {
        folders[number] = path;
    }
    return number;
}

} // namespace

// In place of the C library's, for the shared library too.
extern "C" {
int open(const char* path, int flags, ...) {
    std::va_list more;
    va_start(more, flags);
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
    va_end(more);
    return open_watched(path, flags, mode);
}
int open64(const char* path, int flags, ...) {
    std::va_list more;
    va_start(more, flags);
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
    va_end(more);
    return open_watched(path, flags, mode);
}
ssize_t write(int number, const void* data, size_t size) {
    const auto file = files.find(number);
    // In pieces, as systems may.
    const size_t part = file != files.end() ? std::min<size_t>(size, 1000) : size;
    if (file != files.end() && fails({Call::write, file->second, {}, {}, std::string(static_cast<const char*>(data), part)}))
        return -1;
    return real<ssize_t(int, const void*, size_t)>("write")(number, data, part);
}
int fsync(int number) {
    const auto file = files.find(number);
    const auto folder = folders.find(number);
    if (file != files.end() && fails({Call::sync_file, file->second, {}, {}, {}})) return -1;
    if (folder != folders.end() && fails({Call::sync_folder, 0, folder->second, {}, {}})) return -1;
    return 0; // the disk itself is none of this test's
}
int close(int number) {
    files.erase(number);
    folders.erase(number);
    return real<int(int)>("close")(number);
}
int rename(const char* from, const char* to) {
    if (is_watched(from)) {
        if (fails({Call::rename, made.at(from), from, to, {}})) return -1;
        made[to] = made.at(from);
        made.erase(from);
    }
    return real<int(const char*, const char*)>("rename")(from, to);
}
int remove(const char* path) {
    if (is_watched(path) && fails({Call::remove, 0, path, {}, {}})) return -1;
    return real<int(const char*)>("remove")(path);
}
}

namespace {

int wrong = 0;

bool expect(bool good, const std::string& what) {
    if (!good) {
        ++wrong;
        std::fprintf(stderr, "WRONG: %s (%s)\n", what.c_str(), wadi_get_last_error());
    }
    return good;
}

// ---- What a disk may hold ----

using Disk = std::map<std::string, std::string>; // path -> bytes

/// What there is of a file whose data was synchronised up to `safe` bytes.
std::set<std::string> contents(const std::string& written, std::size_t safe) {
    const std::size_t half = safe + (written.size() - safe) / 2;
    return {written, written.substr(0, safe), written.substr(0, half),
            written.substr(0, safe) + std::string(written.size() - safe, '\0'),
            written.substr(0, half) + std::string(written.size() - half, '\0')};
}

/// Every disk that may be found after the first `count` calls on a disk that held `before`.
std::set<Disk> disks_after(const Disk& before, const std::vector<Call>& asked, std::size_t count) {
    std::map<int, std::string> written;
    std::map<int, std::size_t> safe; // bytes
    std::vector<Call> names;         // changes of names that are not synchronised
    std::map<std::string, int> places;
    std::map<int, std::string> content_of_old;
    int old = 0;
    for (const auto& [path, bytes] : before) {
        written[--old] = bytes;
        safe[old] = bytes.size();
        places[path] = old;
    }
    const auto apply = [](std::map<std::string, int>& to, const Call& call) {
        if (call.kind == Call::make) to[call.name] = call.file;
        if (call.kind == Call::remove) to.erase(call.name);
        if (call.kind == Call::rename) {
            to.erase(call.name);
            to[call.to] = call.file;
        }
    };
    for (std::size_t n = 0; n < count; ++n) {
        const Call& call = asked[n];
        switch (call.kind) {
        case Call::write:
            written[call.file] += call.bytes;
            break;
        case Call::sync_file:
            safe[call.file] = written[call.file].size();
            break;
        case Call::sync_folder: {
            std::vector<Call> left;
            for (const Call& change : names) {
                if (fs::path(change.name).parent_path() == call.name)
                    apply(places, change);
                else
                    left.push_back(change);
            }
            names = left;
            break;
        }
        default:
            written[call.file]; // a new file is empty
            names.push_back(call);
        }
    }
    std::set<Disk> disks;
    for (unsigned kept = 0; kept < 1u << names.size(); ++kept) {
        auto found = places;
        for (std::size_t n = 0; n < names.size(); ++n)
            if ((kept >> n & 1u) != 0) apply(found, names[n]);
        std::vector<Disk> variants{{}};
        for (const auto& [path, file] : found) {
            std::vector<Disk> next;
            for (const auto& bytes : contents(written[file], safe[file]))
                for (Disk disk : variants) {
                    disk[path] = bytes;
                    next.push_back(disk);
                }
            variants = next;
        }
        disks.insert(variants.begin(), variants.end());
    }
    return disks;
}

// ---- A host that saves ----

const char* const LEVEL = R"({ "format_version": 1, "name": "power cut", "grid": { "nx": 12, "ny": 9, "dx": 0.5 }, "dt": 0.02,
    "terrain": [ { "shape": "plane", "height": 0.1, "slope_x": 0.05 } ],
    "water": [ { "shape": "box", "from": [0, 0], "to": [2, 4], "height": 1 } ] })";

wadi_world_id make_world() {
    auto options = wadi_default_device_options();
    options.backend = "cpu";
    options.threads = 1;
    wadi_world_id world{};
    expect(wadi_create_world_from_level_text(LEVEL, nullptr, nullptr, nullptr, &options, &world) == WADI_OK, "create");
    return world;
}

std::uint64_t hash_of(wadi_world_id world) {
    std::uint64_t hash = 0;
    expect(wadi_world_get_hash(world, &hash) == WADI_OK, "hash");
    return hash;
}

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

struct Saving {
    std::string name;  // of the case
    bool replaces;     // there is a save already
    bool through_link; // the path is a link to a file in another folder
};

struct Found {
    int disks = 0, bad = 0;
    std::size_t calls = 0;
};

/// Cuts the power after each call of a save. `forget`: calls of this kind are taken for not made, as if the library left them
/// out.
Found cut(const Saving& saving, int forget) {
    const fs::path root = fs::temp_directory_path() / ("wadi-power-cut-" + std::to_string(getpid()));
    fs::remove_all(root);
    fs::create_directories(root / "saves");
    fs::create_directories(root / "elsewhere");
    const std::string path = (root / "saves" / "game.save").string();
    const std::string real_path = saving.through_link ? (root / "elsewhere" / "file").string() : path;
    if (saving.through_link) fs::create_symlink("../elsewhere/file", path);
    const auto world = make_world();
    const std::uint64_t old_hash = hash_of(world);
    if (saving.replaces) expect(wadi_world_save_file(world, path.c_str()) == WADI_OK, "the first save");
    Disk before;
    if (saving.replaces) before[real_path] = bytes_of(real_path);
    expect(wadi_world_step(world, 3) == WADI_OK, "step");
    const std::uint64_t new_hash = hash_of(world);
    expect(old_hash != new_hash, "two states");

    calls.clear();
    watched = root.string();
    expect(wadi_world_save_file(world, path.c_str()) == WADI_OK, "save");
    watched.clear();
    std::vector<Call> asked = calls;
    if (forget >= 0) std::erase_if(asked, [&](const Call& call) { return call.kind == forget; });

    Found found;
    found.calls = asked.size();
    for (std::size_t count = 0; count <= asked.size(); ++count) {
        for (const Disk& disk : disks_after(before, asked, count)) {
            for (const char* folder : {"saves", "elsewhere"})
                for (const auto& entry : fs::directory_iterator(root / folder))
                    if (!entry.is_symlink()) fs::remove(entry.path());
            for (const auto& [name, bytes] : disk) std::ofstream(name, std::ios::binary) << bytes;
            const auto loaded = wadi_world_load_file(world, path.c_str());
            const bool whole = loaded == WADI_OK;
            const std::uint64_t hash = whole ? hash_of(world) : 0;
            const bool good = count == asked.size() ? whole && hash == new_hash
                              : saving.replaces     ? whole && (hash == old_hash || hash == new_hash)
                                                    : (whole && hash == new_hash) || loaded == WADI_ERROR_NOT_FOUND;
            ++found.disks;
            if (good) {
                // The game goes on: parts that were left are in nobody's way.
                if (forget < 0 && !expect(wadi_world_save_file(world, path.c_str()) == WADI_OK, "the next save")) ++found.bad;
                continue;
            }
            if (found.bad++ == 0 && forget < 0)
                std::fprintf(stderr, "after call %zu, %s: answered %d, %s\n", count,
                             count == 0 ? "none" : kind_names[asked[count - 1].kind], loaded, wadi_get_last_error());
        }
    }
    wadi_destroy_world(world);
    fs::remove_all(root);
    return found;
}

/// Each call of a save is refused by the system in turn: that is told, the old save stays and nothing else is left. Of a folder
/// that cannot be synchronised nothing is told: not all file systems can.
void refused() {
    const fs::path root = fs::temp_directory_path() / ("wadi-refused-" + std::to_string(getpid()));
    const std::string path = (root / "game.save").string();
    std::size_t told = 0;
    const auto world = make_world();
    const std::uint64_t old_hash = hash_of(world);
    for (std::size_t at = 1;; ++at) {
        fs::remove_all(root);
        fs::create_directories(root);
        expect(wadi_world_save_file(world, path.c_str()) == WADI_OK, "the first save");
        const auto later = make_world();
        expect(wadi_world_step(later, 2) == WADI_OK, "step");
        calls.clear();
        watched = root.string();
        fail_at = at;
        const auto result = wadi_world_save_file(later, path.c_str());
        watched.clear();
        const bool reached = fail_at == 0;
        fail_at = 0;
        wadi_destroy_world(later);
        if (!reached) break;
        if (result == WADI_OK) {
            expect(calls.back().kind == Call::rename, "only a folder may stay as it is");
            continue;
        }
        ++told;
        expect(wadi_world_load_file(world, path.c_str()) == WADI_OK && hash_of(world) == old_hash, "the old save is whole");
        expect(std::distance(fs::directory_iterator(root), fs::directory_iterator{}) == 1, "no part of a file is left");
    }
    std::printf("calls that the system refuses: %zu told\n", told);
    expect(told >= 4, "making, writing, synchronising and renaming fail");
    wadi_destroy_world(world);
    fs::remove_all(root);
}

} // namespace

int main() {
    const Saving savings[] = {
        {"a first save", false, false}, {"a save that replaces one", true, false}, {"one through a link", true, true}};
    for (const Saving& saving : savings) {
        const Found found = cut(saving, -1);
        std::printf("%s: %zu calls, %d disks, %d bad\n", saving.name.c_str(), found.calls, found.disks, found.bad);
        expect(found.calls > 5 && found.disks > 20, saving.name + ": calls were seen");
        expect(found.bad == 0, saving.name + ": the power is cut and no whole save is there");
        // Controls: a library that synchronised less would lose saves here.
        for (const int forget : {Call::sync_file, Call::sync_folder}) {
            const Found lost = cut(saving, forget);
            std::printf("  without \"%s\": %d of %d bad\n", kind_names[forget], lost.bad, lost.disks);
            expect(lost.bad > 0, saving.name + ": a control loses nothing");
        }
    }
    refused();
    std::puts(wrong == 0 ? "passed" : "FAILED");
    return wrong == 0 ? 0 : 1;
}
