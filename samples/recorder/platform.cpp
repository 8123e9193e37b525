#include "platform.hpp"
#include <csignal>
#if defined(_WIN32)
#include <io.h>
#else
#include <unistd.h>
#endif

namespace recorder {
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

void catch_interrupt() { std::signal(SIGINT, on_interrupt); }

bool interrupted() { return interrupt_flag != 0; }

} // namespace recorder
