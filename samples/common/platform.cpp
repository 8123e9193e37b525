#include "platform.hpp"
#include <algorithm>
#include <csignal>
#include <cstdlib>
#if defined(_WIN32)
#include <io.h>
#include <process.h>
#include <windows.h>
#else
#include <dlfcn.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
extern char** environ; // POSIX has it in no header
#endif

namespace common {
namespace {

volatile std::sig_atomic_t interrupt_flag = 0;

void on_interrupt(int) {
    interrupt_flag = 1;
    std::signal(SIGINT, SIG_DFL);
}

} // namespace

bool error_stream_is_terminal() {
#if defined(_WIN32)
    return _isatty(2) != 0;
#else
    return isatty(STDERR_FILENO) != 0;
#endif
}

std::filesystem::path executable_path() {
    std::error_code error;
    return std::filesystem::read_symlink("/proc/self/exe", error); // Linux; empty elsewhere
}

std::filesystem::path find_program(const std::string& name) {
#if defined(_WIN32)
    const char separator = ';';
    const std::string file_name = name + ".exe";
#else
    const char separator = ':';
    const std::string file_name = name;
#endif
    const char* const variable = std::getenv("PATH");
    const std::string folders = variable != nullptr ? variable : "";
    for (std::size_t start = 0; start < folders.size();) {
        const std::size_t end = std::min(folders.find(separator, start), folders.size());
        const std::filesystem::path file = std::filesystem::path(folders.substr(start, end - start)) / file_name;
        std::error_code error;
#if defined(_WIN32)
        if (std::filesystem::is_regular_file(file, error)) return file;
#else
        if (std::filesystem::is_regular_file(file, error) && access(file.c_str(), X_OK) == 0) return file;
#endif
        start = end + 1;
    }
    return {};
}

int run_program(const std::vector<std::string>& arguments) {
    std::vector<std::string> kept = arguments; // the calls want pointers to characters that may be written to
    std::vector<char*> pointers;
    for (std::string& argument : kept) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
#if defined(_WIN32)
    return static_cast<int>(_spawnvp(_P_WAIT, pointers[0], pointers.data()));
#else
    pid_t child = 0;
    if (posix_spawnp(&child, pointers[0], nullptr, nullptr, pointers.data(), environ) != 0) return -1;
    int status = 0;
    if (waitpid(child, &status, 0) != child) return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
#endif
}

bool SharedLibrary::open(const std::vector<const char*>& names) {
    for (const char* const name : names) {
#if defined(_WIN32)
        handle_ = LoadLibraryA(name);
#else
        handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
#endif
        if (handle_ != nullptr) return true;
    }
    return false;
}

void (*SharedLibrary::address(const char* name) const)() {
#if defined(_WIN32)
    return reinterpret_cast<void (*)()>(GetProcAddress(static_cast<HMODULE>(handle_), name));
#else
    return reinterpret_cast<void (*)()>(dlsym(handle_, name));
#endif
}

void catch_interrupt() { std::signal(SIGINT, on_interrupt); }

bool interrupted() { return interrupt_flag != 0; }

} // namespace common
