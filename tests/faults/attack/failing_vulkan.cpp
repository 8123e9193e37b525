// Each Vulkan call of a session fails in turn, by the loader of failing_vulkan.c: told in words, and nobody crashes or waits for
// ever.
#include "tests/faults/attack/attack.hpp"
#include <algorithm>
#include <cstdio>
#include <dlfcn.h>
#include <span>
#include <unistd.h>
#include <vector>

namespace attack {
namespace {

constexpr int most_kinds = 64; // of calls, in failing_vulkan.c

/// Of the loader that fails; null without it.
void* of_loader(const char* name) {
    static void* loader = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_GLOBAL);
    return loader != nullptr ? dlsym(loader, name) : nullptr;
}
std::atomic<int>* numbers(const char* name) {
    static std::atomic<int> none[most_kinds];
    auto* found = static_cast<std::atomic<int>*>(of_loader(name));
    return found != nullptr ? found : none;
}
std::atomic<int>& number(const char* name) { return *numbers(name); }

struct Answers {
    int failed = 0;
    std::uint64_t hash = 0;
};

/// What a host does with a world on Vulkan, each call whatever those before it answered.
Answers use() {
    Answers answers;
    const auto note = [&](wadi_result result, const char* call) {
        if (result == WADI_OK || result == WADI_NOT_READY) return true;
        ++answers.failed;
        const bool known = result == WADI_ERROR_OUT_OF_MEMORY || result == WADI_ERROR_DEVICE_LOST ||
                           result == WADI_ERROR_NOT_FOUND || result == WADI_ERROR_NOT_SUPPORTED;
        expect(known, std::string(call) + " answered " + std::to_string(result));
        expect(wadi_get_last_error()[0] != '\0', std::string(call) + ": a failure without a word");
        return false;
    };
    wadi_world_id world{};
    if (!note(make(24, world), "create")) return answers;
    const auto edit = brush(WADI_LAYER_SAND);
    note(wadi_world_set_outputs(world, 1), "set_outputs");
    note(wadi_world_step(world, 2), "step");
    note(wadi_world_edit(world, &edit, 1), "edit");
    note(wadi_world_step(world, 2), "a step with an edit");
    auto frame = wadi_default_frame();
    note(wadi_world_update(world, 20'000'000, &frame), "update");
    const float point[2] = {3, 3};
    std::uint64_t ticket = 0;
    note(wadi_world_query(world, point, 1, &ticket), "query");
    size_t bytes = 0;
    std::vector<unsigned char> snapshot;
    if (note(wadi_world_save(world, nullptr, &bytes), "save: size")) {
        snapshot.resize(bytes);
        if (note(wadi_world_save(world, snapshot.data(), &bytes), "save"))
            note(wadi_world_load(world, snapshot.data(), bytes), "load");
    }
    note(wadi_world_get_hash(world, &answers.hash), "get_hash");
    expect(wadi_destroy_world(world) == WADI_OK, "destroy");
    return answers;
}

constexpr unsigned child_seconds = 60; // of a child: what waits for ever is ended, and told

/// The control: a code that nobody looks at is a call that says that it did what it did not. Of each of these kinds the last such
/// call of a session must be seen, by a crash, by a wait without end or by other bits.
void lies(std::span<const std::uint64_t> last, std::uint64_t hash, bool all) {
    const auto* called = static_cast<const char* const*>(of_loader("failing_vulkan_names"));
    if (!expect(called != nullptr, "the loader that fails has names")) return;
    static constexpr const char* quick[] = {"CreateDevice", "CreateBuffer", "CreateComputePipelines"};
    static constexpr const char* slow[] = {"CreateInstance",
                                           "EnumeratePhysicalDevices",
                                           "AllocateMemory",
                                           "MapMemory",
                                           "CreatePipelineLayout",
                                           "CreateDescriptorPool",
                                           "CreateDescriptorSetLayout",
                                           "AllocateDescriptorSets",
                                           "CreateCommandPool",
                                           "AllocateCommandBuffers",
                                           "CreateSemaphore",
                                           "QueueSubmit"};
    std::vector<std::string> kinds(std::begin(quick), std::end(quick));
    if (all) kinds.insert(kinds.end(), std::begin(slow), std::end(slow));
    int seen = 0;
    for (int kind = 0; kind < most_kinds; ++kind) {
        const std::string name = called[kind] != nullptr ? called[kind] : "";
        if (std::find(kinds.begin(), kinds.end(), name) == kinds.end()) continue;
        const int at = static_cast<int>(last[static_cast<std::size_t>(kind)]);
        if (!expect(at > 0, name + " is called")) continue;
        const auto ran = run_child([&] {
            alarm(name == "QueueSubmit" ? 10 : child_seconds);
            number("failing_vulkan_code") = 0;
            number("failing_vulkan_at") = at;
            const auto answers = use();
            return answers.failed > 0 || answers.hash != hash || wrong > 0 ? 1 : 0;
        });
        seen += expect(ran.code != 0, name + " did nothing, and nothing shows it") ? 1 : 0;
    }
    std::printf("Vulkan calls that only said they did: %d of %zu seen\n", seen, kinds.size());
}

} // namespace

int failing_vulkan(int count) {
    backend = "vulkan";
    int calls[2] = {-1, -1};
    if (pipe(calls) != 0) return 1;
    std::uint64_t expected[2 + most_kinds] = {};
    const auto usual = run_child([&] {
        const auto answers = use();
        std::uint64_t said[2 + most_kinds] = {static_cast<std::uint64_t>(number("failing_vulkan_calls").load()), answers.hash};
        for (int kind = 0; kind < most_kinds; ++kind)
            said[2 + kind] = static_cast<std::uint64_t>(numbers("failing_vulkan_last")[kind].load());
        return write(calls[1], said, sizeof said) == sizeof said && answers.failed == 0 && wrong == 0 ? 0 : 1;
    });
    if (!expect(usual.code == 0 && read(calls[0], expected, sizeof expected) == sizeof expected, "a session where nothing fails"))
        return wrong;
    const int all = static_cast<int>(expected[0]);
    expect(all > 100, "the loader that fails is in place");
    // The last call of each kind, those of running worlds first, and as many places between the first call and the last.
    std::vector<int> places;
    for (const std::uint64_t last : std::span(expected).subspan(2))
        if (last > 0) places.push_back(static_cast<int>(last));
    std::sort(places.rbegin(), places.rend());
    places.resize(std::min(places.size(), static_cast<std::size_t>(count - count / 2)));
    const int kinds = static_cast<int>(places.size()); // one call alone fails there: later ones would tell in its place
    const int spread = count - kinds;
    for (int n = 0; n < spread; ++n)
        places.push_back(1 + static_cast<int>(static_cast<long>(all - 1) * n / std::max(1, spread - 1)));
    constexpr int codes[] = {-1, -2}; // memory of the host, of the device. A loss told of a device that works on would be none
    int told = 0;
    for (int n = 0; n < count; ++n) {
        const int at = places[static_cast<std::size_t>(n)], code = codes[n / 2 % 2], more = n < kinds || n % 2 == 0 ? 0 : 1 << 20;
        const auto ran = run_child([&] {
            alarm(child_seconds);
            number("failing_vulkan_code") = code;
            number("failing_vulkan_more") = more;
            number("failing_vulkan_at") = at;
            const auto answers = use();
            expect(answers.failed > 0 || answers.hash == expected[1], "nothing was told, and the bits are others");
            return wrong > 0 ? 1 : answers.failed > 0 ? 3 : 0;
        });
        told += ran.code == 3 ? 1 : 0;
        expect(ran.code == 0 || ran.code == 3, "call " + std::to_string(at) + " of " + std::to_string(all) +
                                                   (more > 0 ? " and all later ones" : "") + " with " + std::to_string(code) +
                                                   ": ended with " + std::to_string(ran.code));
    }
    std::printf("Vulkan calls that fail: %d of %d in turn, %d told\n", count, all, told);
    expect(told > count / 3, "many are told");
    lies(std::span(expected).subspan(2), expected[1], count > most_kinds);
    return wrong;
}

} // namespace attack
