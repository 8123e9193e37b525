// Odd surroundings: locale, signals, no descriptors, no /proc, no HOME, a small stack. Each in a process of its own.
#include "tests/faults/attack/attack.hpp"
#include <clocale>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <locale>
#include <pthread.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

namespace attack {
namespace {

/// 1,5 and 1.234.567.
struct Commas : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

constexpr int not_here = 77; // the machine does not allow the surroundings

int in_comma_locale() {
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"}) std::setlocale(LC_ALL, name);
    std::locale::global(std::locale(std::locale(), new Commas));
    return 0;
}
int under_signals() {
    struct sigaction action {};
    action.sa_handler = [](int) {};
    sigaction(SIGALRM, &action, nullptr); // without SA_RESTART
    const itimerval often{{0, 200}, {0, 200}};
    return setitimer(ITIMER_REAL, &often, nullptr);
}
int without_folder() {
    char name[] = "/tmp/wadi-gone-XXXXXX";
    return mkdtemp(name) != nullptr && chdir(name) == 0 && rmdir(name) == 0 ? 0 : not_here;
}
int without_descriptors() {
    const rlimit none{0, 0};
    return setrlimit(RLIMIT_NOFILE, &none);
}
int without_proc() {
    if (unshare(CLONE_NEWNS) != 0) return not_here;
    if (mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return not_here;
    return mount("none", "/proc", "tmpfs", 0, nullptr) == 0 ? 0 : not_here;
}
int without_home() { return unsetenv("HOME") + unsetenv("XDG_CACHE_HOME") + unsetenv("TMPDIR"); }
int home_that_is_none() { return setenv("HOME", "/proc/none", 1) + setenv("XDG_CACHE_HOME", "/proc/none", 1); }

/// Calls `body` on a thread whose stack is so small.
void on_small_stack(std::size_t bytes, void* (*body)(void*), void* argument) {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_t thread{};
    if (expect(pthread_attr_setstacksize(&attributes, bytes) == 0 && pthread_create(&thread, &attributes, body, argument) == 0,
               "a small stack"))
        pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
}

} // namespace

int environment() {
    // Found in a child: a parent that used Vulkan may not fork children that do.
    int ends[2];
    if (!expect(pipe(ends) == 0, "pipe")) return wrong;
    const auto session_in = [&](int (*surroundings)()) {
        return run_child([&] {
            const int there = surroundings();
            if (there != 0) return there;
            const std::uint64_t hash = session();
            return write(ends[1], &hash, sizeof hash) == sizeof hash ? static_cast<int>(wrong) : 1;
        });
    };
    const auto hash_of = [&] {
        std::uint64_t hash = 0;
        return read(ends[0], &hash, sizeof hash) == sizeof hash ? hash : 0;
    };
    expect(session_in([] { return 0; }).code == 0, "a session in plain surroundings");
    const std::uint64_t expected = hash_of();
    const std::pair<const char*, int (*)()> kinds[] = {{"decimal commas", in_comma_locale},
                                                       {"a signal every 200 us", under_signals},
                                                       {"no working folder", without_folder},
                                                       {"no descriptors", without_descriptors},
                                                       {"no /proc", without_proc},
                                                       {"no HOME", without_home},
                                                       {"a HOME that cannot be", home_that_is_none}};
    for (const auto& [name, surroundings] : kinds) {
        if (backend != "cpu" && surroundings == without_descriptors) continue; // a driver is files
        if (backend == "cuda" && surroundings == without_proc) continue;       // and NVIDIA's looks into /proc
        const auto ran = session_in(surroundings);
        std::printf("%s: %s\n", name, ran.code == 0 ? "same bits" : ran.code == not_here ? "not on this machine" : "FAILED");
        if (ran.code == not_here) continue;
        if (expect(ran.code == 0, std::string(name) + ": ended with " + std::to_string(ran.code)))
            expect(hash_of() == expected, std::string(name) + ": other bits");
    }
    const std::size_t stack = backend == "cpu" ? 65536 : 1 << 20; // a driver compiles on the caller's
    const auto small = run_child([&] {
        std::uint64_t hash = 0;
        on_small_stack(
            stack,
            [](void* to) -> void* {
                *static_cast<std::uint64_t*>(to) = session();
                return nullptr;
            },
            &hash);
        expect(hash == expected, "other bits on a small stack");
        return static_cast<int>(wrong);
    });
    std::printf("a stack of %zu KiB: %s\n", stack >> 10, small.code == 0 ? "same bits" : "FAILED");
    expect(small.code == 0, "a stack of 64 KiB: ended with " + std::to_string(small.code));
    return wrong;
}

} // namespace attack
